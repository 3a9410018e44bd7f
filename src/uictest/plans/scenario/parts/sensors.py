"""The sensors of the rig and of the train."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Final, Literal

from uictest.plans.scenario.yaml import Inconsistency, Part, Quantity, Section
from uictest.plans.scenario.yaml.quantity_field import (
    default,
    field,
    of_kind,
    optional,
    quantity,
    schema_field,
)

ErrorShare = Annotated[Quantity, of_kind("share", "-50 % .. 50 %")]
NoiseShare = Annotated[Quantity, of_kind("share", "0 % .. 50 %")]


class SpeedSensor(Section):
    """A toothed wheel on the axle; speed from the time between teeth."""

    teeth: Quantity = quantity("Teeth of the wheel.", "count", "1 .. 1000")
    timer_resolution: Quantity = quantity(
        "Resolution of the timer between teeth.", "time", "1e-6 ms .. 10 ms"
    )
    minimum_speed: Quantity = quantity(
        "Wheel speed below which the sensor reads zero.", "speed", "0.01 km/h .. 50 km/h"
    )
    noise: NoiseShare = field("Standard deviation of the noise as a share of the reading.")
    gain_error: ErrorShare = field("Error in proportion to the reading.", default=default("0 %", "share"))
    method: Literal["momentary", "whole-teeth"] = field(
        "momentary: the speed at the instant of reading; whole-teeth: that of the last whole"
        " teeth, which is older the slower the wheel turns.",
        default="momentary",
    )
    eccentricity: Quantity = quantity(
        "Error once per turn: largest deviation as a share of the reading.",
        "share",
        "0 % .. 50 %",
        default="0 %",
    )
    missing_teeth: Quantity = quantity(
        "Teeth missing in one gap of the wheel; only with method whole-teeth.",
        "count",
        "0 .. 100",
        default="0",
    )


class PressureSensor(Section):
    """A pressure sensor of a tank or of the reservoir."""

    range: Quantity = quantity("Highest gauge pressure it reads.", "pressure", "0.1 bar .. 100 bar")
    gain_error: ErrorShare = field("Error in proportion to the reading.")
    offset: Quantity = quantity("Reading at zero gauge pressure.", "pressure", "-1 bar .. 1 bar")
    noise: Quantity = quantity("Standard deviation of the noise.", "pressure", "1e-6 bar .. 1 bar")
    resolution: Quantity = quantity("Smallest step of the reading.", "pressure", "1e-6 bar .. 1 bar")


class Loadcell(Section):
    """One of the loadcells between pad and disc."""

    range: Quantity = quantity("Highest force it reads.", "force", "0.1 kN .. 1000 kN")
    gain_error: ErrorShare = field("Error in proportion to the reading.")
    offset: Quantity = quantity("Reading without force.", "force", "-10 kN .. 10 kN")
    noise: Quantity = quantity("Standard deviation of the noise.", "force", "0.001 N .. 10 kN")
    resolution: Quantity = quantity("Smallest step of the reading.", "force", "0.001 N .. 10 kN")


class TrainSpeedSource(Section):
    """A speed of the train from outside the wheelsets: radar, satellites, the train's computer."""

    period: Quantity = quantity(
        "Time from one value to the next, rounded to whole controller cycles.",
        "time",
        "1 ms .. 5 s",
        default="100 ms",
    )
    delay: Quantity = quantity(
        "Age of a value when the controller first gets it, rounded likewise; at most three periods.",
        "time",
        "0 s .. 15 s",
        default="100 ms",
    )
    noise: Quantity = quantity(
        "Standard deviation of the noise of a value.", "speed", "0 km/h .. 20 km/h", default="0.2 km/h"
    )
    gain_error: ErrorShare = field("Error in proportion to the speed.", default=default("0 %", "share"))

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a delay for which too many values would be on their way."""
        if self.delay > _MOST_PERIODS * self.period:
            yield Inconsistency(
                ("delay",),
                f"{self.delay.text} is more than {_MOST_PERIODS} periods of {self.period.text}",
                f"at most {_MOST_PERIODS} values can be on their way: shorten the delay",
            )


_MOST_PERIODS: Final = 3


class Accelerometer(Section):
    """An accelerometer on the car body along the track, read in every controller cycle.

    On a gradient it shows the share of gravity, too; that of the body's pitch is not modelled.
    """

    noise: Quantity = quantity(
        "Standard deviation of the noise.", "acceleration", "0 m/s2 .. 5 m/s2", default="0.05 m/s2"
    )
    offset: Quantity = quantity(
        "Reading without acceleration.", "acceleration", "-1 m/s2 .. 1 m/s2", default="0 m/s2"
    )


class Sensors(Part):
    """The sensors of the rig."""

    folder: ClassVar[str] = "sensors"

    schema_id: Literal["uictest/sensors/1"] = schema_field("uictest/sensors/1")
    speed: SpeedSensor = field("Speed sensor of a wheelset.")
    pressure: PressureSensor = field("Pressure sensors.")
    loadcell: Loadcell = field("Loadcells between pad and disc.")
    train_speed: TrainSpeedSource | None = optional(
        "A second source of the train's speed, for controllers of contract version 2."
    )
    acceleration: Accelerometer | None = optional("An accelerometer, for controllers of contract version 2.")

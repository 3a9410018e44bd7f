"""The sensors: what the controller and the records see of the rig."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Part, Quantity, Section, default, of_kind

ErrorShare = Annotated[Quantity, of_kind("share", at_least="-50 %", at_most="50 %")]
NoiseShare = Annotated[Quantity, of_kind("share", at_least="0 %", at_most="50 %")]


class SpeedSensor(Section):
    """A toothed wheel on the axle; speed from the time between teeth."""

    teeth: Annotated[Quantity, of_kind("count", at_least="1", at_most="1000")] = Field(
        description="Teeth of the wheel."
    )
    timer_resolution: Annotated[Quantity, of_kind("time", at_least="1e-6 ms", at_most="10 ms")] = Field(
        description="Resolution of the timer between teeth."
    )
    minimum_speed: Annotated[Quantity, of_kind("speed", at_least="0.01 km/h", at_most="50 km/h")] = Field(
        description="Wheel speed below which the sensor reads zero."
    )
    noise: NoiseShare = Field(description="Standard deviation of the noise as a share of the reading.")
    gain_error: ErrorShare = Field(
        default=default("0 %", "share"), description="Error in proportion to the reading."
    )
    method: Literal["momentary", "whole-teeth"] = Field(
        default="momentary",
        description="momentary: the speed at the instant of reading; whole-teeth: that of the last whole"
        " teeth, which is older the slower the wheel turns.",
    )
    eccentricity: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="50 %")] = Field(
        default=default("0 %", "share"),
        description="Error once per turn: largest deviation as a share of the reading.",
    )
    missing_teeth: Annotated[Quantity, of_kind("count", at_least="0", at_most="100")] = Field(
        default=default("0", "count"),
        description="Teeth missing in one gap of the wheel; only with method whole-teeth.",
    )


class PressureSensor(Section):
    """A pressure sensor of a tank or of the reservoir."""

    range: Annotated[Quantity, of_kind("pressure", at_least="0.1 bar", at_most="100 bar")] = Field(
        description="Highest gauge pressure it reads."
    )
    gain_error: ErrorShare = Field(description="Error in proportion to the reading.")
    offset: Annotated[Quantity, of_kind("pressure", at_least="-1 bar", at_most="1 bar")] = Field(
        description="Reading at zero gauge pressure."
    )
    noise: Annotated[Quantity, of_kind("pressure", at_least="1e-6 bar", at_most="1 bar")] = Field(
        description="Standard deviation of the noise."
    )
    resolution: Annotated[Quantity, of_kind("pressure", at_least="1e-6 bar", at_most="1 bar")] = Field(
        description="Smallest step of the reading."
    )


class Loadcell(Section):
    """One of the loadcells between pad and disc."""

    range: Annotated[Quantity, of_kind("force", at_least="0.1 kN", at_most="1000 kN")] = Field(
        description="Highest force it reads."
    )
    gain_error: ErrorShare = Field(description="Error in proportion to the reading.")
    offset: Annotated[Quantity, of_kind("force", at_least="-10 kN", at_most="10 kN")] = Field(
        description="Reading without force."
    )
    noise: Annotated[Quantity, of_kind("force", at_least="0.001 N", at_most="10 kN")] = Field(
        description="Standard deviation of the noise."
    )
    resolution: Annotated[Quantity, of_kind("force", at_least="0.001 N", at_most="10 kN")] = Field(
        description="Smallest step of the reading."
    )


class Sensors(Part):
    """The sensors of the rig."""

    folder: ClassVar[str] = "sensors"

    schema_id: Literal["uictest/sensors/1"] = Field(
        default="uictest/sensors/1", alias="schema", description="What the file holds: uictest/sensors/1."
    )
    speed: SpeedSensor = Field(description="Speed sensor of a wheelset.")
    pressure: PressureSensor = Field(description="Pressure sensors.")
    loadcell: Loadcell = Field(description="Loadcells between pad and disc.")

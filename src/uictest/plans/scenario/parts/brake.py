"""The brake of a car and the commands it gets; its pads, dynamic brake and track brake."""

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag

from uictest.core.physics import MOST_COMMANDS, MOST_PAD_POINTS, quotient_scale
from uictest.plans.scenario.parts.equipment import BrakeSystem
from uictest.plans.scenario.parts.rail import out_of_order
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Key,
    Model,
    Part,
    PartReference,
    Quantity,
    Section,
    default,
    field,
    of_kind,
    optional,
    quantity,
    quoted,
    refused,
    schema_field,
    suggestion,
)

_Share = Annotated[Quantity, of_kind("share", "1 % .. 100 %")]


class CommandStep(Model):
    """A command from one instant on, until the next one."""

    at: Quantity = quantity("Time since the first command.", "time", "0 s .. 3600 s")
    value: Quantity = quantity("Share of the full service command; 0 % releases.", "share", "0 % .. 100 %")
    position: str | None = optional("Brake position of this command; brake.position if left out.")


def _steps_are_dated(value: Sequence[object]) -> Sequence[object]:
    """Refuse commands without an instant as a whole: either a course or several cases was meant."""
    if any(isinstance(each, str | int | float) for each in value):
        hint = (
            "a course is [{at: 0 s, value: 60 %}, ...]; several values go under matrix: {brake.command: ...}"
        )
        raise refused("commands of a course say from when on they hold", hint)
    return value


_Steps = Annotated[
    tuple[CommandStep, ...], Field(min_length=1, max_length=MOST_COMMANDS), BeforeValidator(_steps_are_dated)
]
Command = Annotated[
    Annotated[_Share, Tag("share")] | Annotated[_Steps, Tag("course")],
    Discriminator(lambda value: "course" if isinstance(value, list | tuple) else "share"),
]
"""One command for the whole stop, or its steps in order of time."""


class Pipe(Model):
    """A pipe along the train."""

    pipe: Quantity = quantity(
        "Speed at which a command travels along the pipe; 250 m/s is usual.", "speed", "50 m/s .. 340 m/s"
    )


Transmission = Annotated[
    Annotated[Literal["wire"], Tag("word")] | Annotated[Pipe, Tag("pipe")],
    Discriminator(lambda value: "pipe" if isinstance(value, dict | Pipe) else "word"),
]
"""How the brake command comes to the cars: along a wire without delay, or along a pipe."""
Factor = Annotated[Quantity, of_kind("number", "0.1 .. 5")]
FrictionSpeed = Annotated[Quantity, of_kind("speed", "0 km/h .. 1000 km/h")]
PadForce = Annotated[Quantity, of_kind("force", "0 kN .. 500 kN")]
SpeedOffset = Annotated[Quantity, of_kind("speed", "1 km/h .. 1000 km/h")]
ForceOffset = Annotated[Quantity, of_kind("force", "0.1 kN .. 1000 kN")]
DiscTemperature = Annotated[Quantity, of_kind("temperature", "-60 degC .. 1200 degC")]
_POINTS = "Points in order, with straight lines between; the ends go on unchanged."


class PadLaw(Section):
    """A factor on pad friction over one quantity: that of its table times that of its quotient."""

    @property
    def table(self) -> tuple[tuple[float, float], ...]:
        """Values of the quantity, SI, and factors."""
        return ((0.0, 1.0),)

    @property
    def quotient(self) -> tuple[float, float, float]:
        """The value at which (x + a)/(x + b) is scaled to 1, then a and b, SI."""
        return 0.0, 1.0, 1.0

    @property
    def largest_factor(self) -> float:
        """Largest factor anywhere: of the table, and of the quotient, which is monotonic, at either end."""
        reference, numerator, denominator = self.quotient
        scale = quotient_scale(reference, numerator, denominator)
        return max(factor for _, factor in self.table) * scale * max(numerator / denominator, 1.0)


class PadTable(PadLaw):
    """A table of points: one quantity, named by `quantity`, and a factor each."""

    quantity: ClassVar[str]

    points: tuple[Any, ...]

    @property
    def table(self) -> tuple[tuple[float, float], ...]:
        """Values of the quantity, SI, and factors."""
        return tuple((float(getattr(point, self.quantity)), float(point.factor)) for point in self.points)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield points out of order."""
        yield from out_of_order([getattr(point, self.quantity) for point in self.points], self.quantity)


class PadSpeedPoint(Model):
    """The factor on pad friction at one speed."""

    speed: FrictionSpeed = field("Speed of the disc at the mean radius of the pads.")
    factor: Factor = field("Factor on `pad_friction` there.")


class PadSpeedTable(PadTable):
    """Pad friction over speed: a table."""

    quantity: ClassVar[str] = "speed"

    points: tuple[PadSpeedPoint, ...] = field(_POINTS, min_length=1, max_length=MOST_PAD_POINTS)


class PadForcePoint(Model):
    """The factor on pad friction under one clamping force."""

    force: PadForce = field("Clamping force of one pad.")
    factor: Factor = field("Factor on `pad_friction` there.")


class PadForceTable(PadTable):
    """Pad friction over clamping force: a table."""

    quantity: ClassVar[str] = "force"

    points: tuple[PadForcePoint, ...] = field(_POINTS, min_length=1, max_length=MOST_PAD_POINTS)


class PadTemperaturePoint(Model):
    """The factor on pad friction at one temperature."""

    temperature: DiscTemperature = field("Temperature of the friction surface of the disc.")
    factor: Factor = field("Factor on `pad_friction` there.")


class PadTemperatureTable(PadTable):
    """Pad friction over the temperature of the disc: a table."""

    quantity: ClassVar[str] = "temperature"

    points: tuple[PadTemperaturePoint, ...] = field(_POINTS, min_length=1, max_length=MOST_PAD_POINTS)


class PadQuotient(PadLaw):
    """A quotient of straight lines, (x + numerator)/(x + denominator), scaled to 1 at the reference."""

    numerator: Quantity
    denominator: Quantity
    reference: Quantity

    @property
    def quotient(self) -> tuple[float, float, float]:
        """Reference, numerator and denominator, SI."""
        return float(self.reference), float(self.numerator), float(self.denominator)


class PadSpeedQuotient(PadQuotient):
    """Pad friction over the speed of the disc at the mean radius, as a quotient of straight lines."""

    numerator: SpeedOffset = field("Speed added in the numerator.")
    denominator: SpeedOffset = field("Speed added in the denominator.")
    reference: FrictionSpeed = field("Speed at which the factor is 1.")


class PadForceQuotient(PadQuotient):
    """Pad friction over the clamping force of one pad, as a quotient of straight lines."""

    numerator: ForceOffset = field("Force added in the numerator.")
    denominator: ForceOffset = field("Force added in the denominator.")
    reference: PadForce = field("Force under which the factor is 1.")


def _law_form(value: object) -> str:
    if isinstance(value, dict):
        lines = value.keys() & {"numerator", "denominator", "reference"}
        return "quotient" if lines and "points" not in value else "table"
    return "quotient" if isinstance(value, PadQuotient) else "table"


SpeedLaw = Annotated[
    Annotated[PadSpeedTable, Tag("table")] | Annotated[PadSpeedQuotient, Tag("quotient")],
    Discriminator(_law_form),
]
ForceLaw = Annotated[
    Annotated[PadForceTable, Tag("table")] | Annotated[PadForceQuotient, Tag("quotient")],
    Discriminator(_law_form),
]


class Pad(Part):
    """How the friction of a pad departs from the brake system's `disc.pad_friction`: a product of factors."""

    folder: ClassVar[str] = "pads"

    schema_id: Literal["uictest/pad/1"] = schema_field("uictest/pad/1")
    speed: SpeedLaw | None = optional(
        "Factor over the speed of the disc at the mean radius: points, or numerator, denominator"
        " and reference of (v + numerator)/(v + denominator); 1 if left out."
    )
    force: ForceLaw | None = optional(
        "Factor over the clamping force of one pad: points, or numerator, denominator and"
        " reference of (F + numerator)/(F + denominator); 1 if left out."
    )
    temperature: PadTemperatureTable | None = optional(
        "Factor over the temperature of the friction surface: points; 1 if left out."
    )

    @property
    def varies(self) -> bool:
        """Whether the friction depends on anything."""
        return not (self.speed is None and self.force is None and self.temperature is None)

    @property
    def largest_factor(self) -> float:
        """Upper bound of the product of all factors."""
        laws = (self.speed, self.force, self.temperature)
        return math.prod(law.largest_factor for law in laws if law is not None)


_Speed = Annotated[Quantity, of_kind("speed", "0 km/h .. 100 km/h")]
_Number = Annotated[int, Field(ge=1, le=4, strict=True)]


class DynamicBrake(Model):
    """A brake of motors that work as generators, blended with the friction brake."""

    force: Quantity = quantity(
        "Largest force of the car at the rims, shared alike by its motored wheelsets.",
        "force",
        "0.1 kN .. 1000 kN",
    )
    power: Quantity = quantity("Largest power of the car.", "power", "1 kW .. 20 MW")
    wheelsets: tuple[_Number, ...] = field(
        "The motored wheelsets, by their number from the leading end.", default=(1, 2, 3, 4), min_length=1
    )
    fade_out: tuple[_Speed, _Speed] = field(
        "Speed below which it fades out, and at which it gives nothing any more.",
        default=(default("10 km/h", "speed"), default("5 km/h", "speed")),
    )
    response_time: Quantity = quantity(
        "Time constant with which a motor follows what is asked of it.",
        "time",
        "10 ms .. 10 s",
        default="0.3 s",
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield speeds in the wrong order and wheelsets named twice."""
        begin, end = self.fade_out
        if begin <= end:
            yield Inconsistency(
                ("fade_out", 1),
                f"{end.text} is not below {begin.text}",
                "write the speed below which it fades out, then where it is gone: [10 km/h, 5 km/h]",
            )
        for index, number in enumerate(self.wheelsets):
            if number in self.wheelsets[:index]:
                yield Inconsistency(("wheelsets", index), f"wheelset {number} is named twice")


EMERGENCY = "emergency"
"""The brake position in which a track brake acts if nothing else is said."""
_Offset = Annotated[Quantity, of_kind("speed", "0.1 km/h .. 1000 km/h")]


class TrackBrake(Model):
    """A brake of magnets that rub on the rail; they drag the bogies and load no wheel."""

    attraction: Quantity = quantity(
        "Force with which the rail attracts one magnet.", "force", "1 kN .. 500 kN"
    )
    magnets: Annotated[int, Field(ge=2, le=16, strict=True)] = field(
        "Magnets of the car: half of them on each bogie.", default=4
    )
    when: Literal["emergency", "always", "requested"] = field(
        "When it acts while the brake is applied: in the brake position `emergency`, in every position, or"
        " while the controller asks for it.",
        default=EMERGENCY,
    )
    off_below: Annotated[Quantity, of_kind("speed", "> 0 km/h .. 300 km/h")] | None = optional(
        "Train speed at and below which it is off; it acts to standstill if left out."
    )
    delay: Quantity = quantity(
        "Time from the command or the request until the magnets are down and their current rises.",
        "time",
        "0 s .. 20 s",
        default="1 s",
    )
    rise_time: Quantity = quantity(
        "Time in which the attraction rises to all and falls to nothing.",
        "time",
        "1 ms .. 10 s",
        default="0.2 s",
    )
    friction: Quantity = quantity(
        "Friction coefficient of magnets and rail at high speed.", "number", "0.001 .. 1", default="0.095"
    )
    friction_speeds: tuple[_Offset, _Offset] = field(
        "a and b of the friction coefficient at the speed v, `friction` (v + a)/(v + b); alike: constant.",
        default=(default("9.26 km/h", "speed"), default("4.63 km/h", "speed")),
    )
    cleaning: Quantity = quantity(
        "Share of its work that cleans the rail as sliding does, where the rail can be cleaned.",
        "share",
        "0 % .. 100 %",
        default="0 %",
    )

    @property
    def largest_force(self) -> float:
        """Largest force of all magnets at any speed, N."""
        numerator, denominator = self.friction_speeds
        return self.magnets * self.attraction * self.friction * (numerator / denominator)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield magnets that two bogies cannot share, and friction that rises with speed."""
        if self.magnets % 2 == 1:
            yield Inconsistency(
                ("magnets",),
                f"{self.magnets} magnets do not split over two bogies",
                f"write the magnets of the whole car: {self.magnets - 1} or {self.magnets + 1}",
            )
        numerator, denominator = self.friction_speeds
        if numerator < denominator:
            yield Inconsistency(
                ("friction_speeds", 1),
                f"{denominator.text} is above {numerator.text}: friction would rise with speed",
                "write the larger speed first: [9.26 km/h, 4.63 km/h]",
            )


def never_requested(scenario: Any) -> Iterator[Inconsistency]:
    """Yield a track brake that waits for the request of a controller that makes none."""
    track = scenario.brake.track
    if track is not None and track.when == "requested" and scenario.controller.program is None:
        yield Inconsistency(
            ("brake", "track", "when"),
            "no controller that is built in asks for the track brake",
            "write `when: always`, or name a controller from outside of contract version 2",
        )


class Brake(Model):
    """The brake of the car and the command it gets."""

    system: Annotated[BrakeSystem, PartReference(BrakeSystem, "ep-disc")] = field(
        "The brake system: a library name, a relative path or an inline mapping."
    )
    command: Command = field(
        "Share of the full service command; or a list of commands, each from a time on.",
        default=default("100 %", "share"),
    )
    position: str = field("Brake position; one of the positions of the brake system.", default="R")
    supply: Literal["on", "off"] = field(
        "Whether the compressor feeds the reservoir; off: the stop has the air that is in it.", default="on"
    )
    pad: Annotated[Pad, PartReference(Pad, "constant")] = field(
        "How pad friction varies: a library name, a relative path or an inline mapping."
    )
    dynamic: DynamicBrake | None = optional(
        "The dynamic brake, blended with the friction brake; none if left out."
    )
    track: TrackBrake | None = optional("The magnetic track brake of the car; none if left out.")
    transmission: Transmission | None = optional(
        "How the command comes to the cars of a train: along a wire, or as in {pipe: 250 m/s}; a wire if left"
        " out."
    )
    disc_temperature: Literal["constant", "modelled"] | None = optional(
        "Whether the discs warm up; if left out, they do where the pad's friction depends on it."
    )
    initial_disc_temperature: DiscTemperature | None = optional(
        "Temperature of the discs at the brake command; that of the air if left out."
    )

    @property
    def first_command(self) -> Quantity:
        """Share of the full service command at the beginning."""
        return self.command[0].value if isinstance(self.command, tuple) else self.command

    @property
    def commands(self) -> tuple[tuple[float, float, str], ...]:
        """All commands: time since the first, s, share of full service, position."""
        if not isinstance(self.command, tuple):
            return ((0.0, self.command, self.position),)
        return tuple((each.at, each.value, each.position or self.position) for each in self.command)

    @property
    def command_text(self) -> str:
        """All commands as written, `60 %, 100 % from 4 s (emergency)`."""
        if not isinstance(self.command, tuple):
            return self.command.text
        rest = (
            f"{each.value.text} from {each.at.text}{f' ({each.position})' if each.position else ''}"
            for each in self.command[1:]
        )
        return ", ".join([self.command[0].value.text, *rest])

    @property
    def commanded_pressure(self) -> float:
        """Pressure of the brake line of a full car once the first application is developed, gauge, Pa."""
        _, share, position = self.commands[0]
        return share * self.system.positions[position].maximum_pressure

    @property
    def highest_commanded_pressure(self) -> float:
        """The highest pressure that any command asks for of a full car, gauge, Pa."""
        positions = self.system.positions
        return max(share * positions[position].maximum_pressure for _, share, position in self.commands)

    @property
    def highest_full_pressure(self) -> float:
        """The highest pressure of a full service command in any position that is used, gauge, Pa."""
        return max(self.system.positions[position].maximum_pressure for _, _, position in self.commands)

    @property
    def models_disc_temperature(self) -> bool:
        """Whether the temperature of the discs is modelled."""
        if self.disc_temperature is None:
            return self.pad.temperature is not None
        return self.disc_temperature == "modelled"

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield positions that the system does not have, and commands out of order."""
        if self.position not in self.system.positions:
            yield self._unknown_position(("position",), self.position)
        if isinstance(self.command, tuple):
            yield from self._course_problems(self.command)
        if self.track is not None and self.track.when == EMERGENCY not in self.system.positions:
            yield Inconsistency(
                ("track",),
                f"this brake has no position {quoted(EMERGENCY)}, in which alone the track brake acts",
                "write when: always, or when: requested",
            )
        if self.models_disc_temperature and self.system.disc.thermal is None:
            yield Inconsistency(
                ("pad",) if self.disc_temperature is None else ("disc_temperature",),
                "brake.system.disc.thermal is missing: what the discs warm up by is not known",
                "add system.disc.thermal, or write disc_temperature: constant",
            )

    def _course_problems(self, steps: tuple[CommandStep, ...]) -> Iterator[Inconsistency]:
        first = steps[0]
        if first.at > 0.0 or first.value == 0.0:
            what = "at" if first.at > 0.0 else "value"
            yield Inconsistency(
                ("command", 0, what),
                "times count from the first command, which applies the brake",
                "begin with {at: 0 s, value: 60 %} or another share",
            )
        for problem in out_of_order([each.at for each in steps], "at"):
            yield problem._replace(key=("command", *problem.key[1:]))
        for index, step in enumerate(steps):
            if step.position is not None and step.position not in self.system.positions:
                yield self._unknown_position(("command", index, "position"), step.position)

    def _unknown_position(self, key: Key, name: str) -> Inconsistency:
        hint = suggestion(name, self.system.positions)
        return Inconsistency(key, f"unknown brake position {quoted(name)}", hint)

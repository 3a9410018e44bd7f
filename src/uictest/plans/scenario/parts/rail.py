"""The rail: adhesion law (Polach 2005), friction along the track, over time and over speed, and sand.

No publication gives the numbers of sand. Law, share that is kept and largest rate are those of the study
`sand`, which fits the law to two stops of RSSB T1107 and selects the other two numbers; all else is chosen.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, ClassVar, Final, Literal

from pydantic import Discriminator, Field, Tag

from uictest.core.physics import MOST_SAND_POINTS, quotient_factor, quotient_scale
from uictest.plans.scenario.parts.rail_cleaning import (
    FRICTION_DECAY,
    FRICTION_RATIO,
    REDUCTION_ADHESION,
    REDUCTION_SLIP,
    Cleaning,
    Decay,
    Friction,
    Share,
    reductions_out_of_order,
)
from uictest.plans.scenario.yaml import (
    DEFAULT_SOURCE,
    Inconsistency,
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
    schema_field,
)

SemiAxis = Annotated[Quantity, of_kind("length", "0.1 mm .. 50 mm")]


class Contact(Section):
    """The contact ellipse of one wheel at its reference load; it grows with load (Hertz)."""

    semi_axis_longitudinal: SemiAxis = field("Semi-axis a along the track.")
    semi_axis_lateral: SemiAxis = field("Semi-axis b across the track.")
    shear_modulus: Quantity = quantity("Shear modulus G of wheel and rail.", "pressure", "1e9 Pa .. 1e12 Pa")
    kalker_coefficient: Quantity = quantity(
        "Kalker's longitudinal creepage coefficient c11.", "number", "0.1 .. 20"
    )
    reference_wheel_load: Quantity = quantity(
        "Wheel load at which the semi-axes hold.", "force", "0.1 kN .. 500 kN"
    )

    @property
    def creep_stiffness(self) -> float:
        """Tangential stiffness (1/4) G pi a b c11 of the contact at the reference load, N."""
        area = math.pi * self.semi_axis_longitudinal * self.semi_axis_lateral
        return 0.25 * self.shear_modulus * area * self.kalker_coefficient


class Variation(Section):
    """How friction varies at random along the track: log-normal, with a correlation of exp(-distance / l).

    The seed of a stop and the place on the track decide it, and nothing else.
    """

    deviations: ClassVar[float] = 6.0
    """Standard deviations of the logarithm of friction beyond which no rail is expected to be; chosen."""

    spread: Quantity = quantity(
        "Standard deviation of the friction of one rail as a share of its mean.", "share", "0 % .. 100 %"
    )
    correlation_length: Quantity = quantity(
        "l: distance over which the correlation along the track falls to 1/e.", "length", "1 m .. 10 km"
    )
    left_right_correlation: Quantity = quantity(
        "Correlation of the left and the right rail; a wheelset meets the mean of both.", "number", "0 .. 1"
    )

    @property
    def log_spread(self) -> float:
        """Standard deviation of the logarithm of the friction that a wheelset meets."""
        of_both = self.spread**2 * 0.5 * (1.0 + self.left_right_correlation)
        return math.sqrt(math.log1p(of_both))

    @property
    def highest_factor(self) -> float:
        """The highest factor on friction that is expected anywhere."""
        return math.exp(self.deviations * self.log_spread)


class FrictionOverSpeed(Section):
    """How friction falls with the speed of the train: (v + numerator)/(v + denominator), 1 at the reference.

    The curve of Curtius and Kniffler, 7.5/(V + 44) + 0.161 with V in km/h, has this form, with 90.58 km/h in
    the numerator and 44 km/h in the denominator.
    """

    largest_factor: ClassVar[float] = 10.0
    """Friction at standstill over that at the reference, at most; chosen."""

    numerator: Quantity = quantity("Speed added in the numerator.", "speed", "1 km/h .. 1000 km/h")
    denominator: Quantity = quantity(
        "Speed added in the denominator; not above that in the numerator.", "speed", "1 km/h .. 1000 km/h"
    )
    reference: Quantity = quantity(
        "Train speed at which friction is as stated.", "speed", "0 km/h .. 600 km/h", default="0 km/h"
    )

    @property
    def scale(self) -> float:
        """Scale that makes the factor 1 at the reference."""
        return quotient_scale(float(self.reference), float(self.numerator), float(self.denominator))

    @property
    def highest_factor(self) -> float:
        """Factor at standstill, where friction is highest."""
        return quotient_factor(0.0, float(self.numerator), float(self.denominator), self.scale)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a friction that rises with speed."""
        yield from super().inconsistencies()
        if self.highest_factor > self.largest_factor:
            yield Inconsistency(
                ("denominator",),
                f"friction at standstill would be {self.highest_factor:.3g} times that at the reference",
                f"at most {self.largest_factor:g} times is accepted",
            )
        if self.numerator < self.denominator:
            yield Inconsistency(
                ("numerator",),
                f"{self.numerator.text} is below {self.denominator.text}: friction would rise with speed",
                "write the larger speed in the numerator",
            )


class RailCondition(Part):
    """A condition of the rail surface."""

    folder: ClassVar[str] = "rails"

    schema_id: Literal["uictest/rail/1"] = schema_field("uictest/rail/1")
    friction: Friction = field("Initial friction coefficient mu0, at zero slip speed.")
    friction_ratio: Share = field(FRICTION_RATIO)
    friction_decay: Decay = field(FRICTION_DECAY)
    reduction_adhesion: Share = field(REDUCTION_ADHESION)
    reduction_slip: Share = field(REDUCTION_SLIP)
    contact: Contact = field("The contact of one wheel.")
    cleaning: Cleaning | None = optional("How sliding cleans the rail; it does not if left out.")
    variation: Variation | None = optional("How friction varies at random; it does not if left out.")
    friction_over_speed: FrictionOverSpeed | None = optional(
        "How friction falls with the train's speed; it does not if left out."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield reduction factors in the wrong order."""
        yield from super().inconsistencies()
        yield from reductions_out_of_order(self)


MOST_POINTS = 64


class FrictionPoint(Model):
    """The friction coefficient at one place of the track."""

    position: Quantity = quantity(
        "Distance from where the brake command is given to the first wheelset, along the track.",
        "length",
        "-100 km .. 100 km",
    )
    friction: Friction = field("Initial friction coefficient mu0 there.")


class FrictionProfile(Model):
    """The friction coefficient along the track."""

    points: tuple[FrictionPoint, ...] = field(
        "Points in order of position; the ends go on unchanged.", min_length=1, max_length=MOST_POINTS
    )
    interpolation: Literal["linear", "steps"] = field(
        "Straight lines between points, or each value up to the next point.", default="linear"
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield points out of order."""
        yield from out_of_order([point.position for point in self.points], "position")


class FactorPoint(Model):
    """The factor on friction at one time."""

    time: Quantity = quantity("Time since the brake command.", "time", "0 s .. 3600 s")
    factor: Quantity = quantity("Factor on friction then.", "number", "0.001 .. 10")


class FactorProfile(Model):
    """A factor on the friction coefficient over time."""

    points: tuple[FactorPoint, ...] = field(
        "Points in order of time, with straight lines between; the ends go on unchanged.",
        min_length=1,
        max_length=MOST_POINTS,
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield points out of order."""
        yield from out_of_order([point.time for point in self.points], "time")


def out_of_order(values: Sequence[Quantity], name: str) -> Iterator[Inconsistency]:
    """Yield the points of a profile whose ``name`` does not exceed that of the point before."""
    for index, (before, after) in enumerate(pairwise(values), start=1):
        if after <= before:
            yield Inconsistency(
                ("points", index, name),
                f"{after.text} does not come after {before.text}",
                f"{name} must increase from point to point",
            )


class SandPoint(Model):
    """What one density of sand does."""

    density: Quantity = quantity("Sand on one rail.", "line density", "0 g/m .. 1000 g/m")
    share: Quantity = quantity("Share of the way to the friction with enough sand.", "number", "0 .. 1")


def _ranged(text: str, low: str, high: str) -> Quantity:
    value, lowest, highest = (default(each, "number") for each in (text, low, high))
    return Quantity(float(value), value.text, value.unit, DEFAULT_SOURCE, (lowest, highest))


_TABLE: Final = (
    *((0, 0), (1, 0.112), (2, 0.211), (3, 0.299), (4, 0.378), (6, 0.509), (8, 0.613), (12, 0.759)),
    *((16, 0.850), (24, 0.942), (40, 0.991), (60, 1)),
)
"""1 - exp(-d / 8.43 g/m), fitted by the study `sand`: slope 0.0332 m/g from 0.02 to 0.30."""


class Sand(Model):
    """What sand does on the rail, and how much of it a wheelset leaves."""

    friction: Annotated[Quantity, of_kind("number", "0.001 .. 1")] = field(
        "Initial friction coefficient of a rail with enough sand; a better rail keeps its own.",
        default=_ranged("0.30", "0.24", "0.36"),
    )
    kept: Annotated[Quantity, of_kind("number", "0 .. 1")] = field(
        "Share of the sand before a wheelset that it leaves behind.", default=_ranged("0.8", "0.6", "0.95")
    )
    points: tuple[SandPoint, ...] = field(
        "What densities do, in their order, with straight lines between; the ends go on unchanged.",
        default=tuple(
            SandPoint(density=default(f"{density} g/m", "line density"), share=default(f"{share}", "number"))
            for density, share in _TABLE
        ),
        min_length=2,
        max_length=MOST_SAND_POINTS,
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield densities out of order, and an effect without sand."""
        if self.points[0].density > 0.0 or self.points[0].share > 0.0:
            yield Inconsistency(
                ("points", 0), "the table does not begin without sand", "write {density: 0 g/m, share: 0}"
            )
        yield from out_of_order([point.density for point in self.points], "density")


class Sander(Model):
    """A sander with its nozzle ahead of a wheelset; its rates are those of one rail."""

    share_of_wheelbase: ClassVar[float] = 0.8
    """Largest distance of a nozzle ahead of its wheelset, well short of the wheelset before; chosen."""
    usual_rate: ClassVar[Quantity] = default("6 kg/min", "sand rate")
    """Largest rate of a variable sander that states none; chosen, with a range of 4 to 8 kg/min."""

    wheelset: Annotated[int, Field(ge=1, le=4, strict=True)] = field(
        "Wheelset ahead of which its nozzle stands, 1 to 4 from the leading end."
    )
    density: Annotated[Quantity, of_kind("line density", "> 0 g/m .. 100 g/m")] | None = optional(
        "Density at which a variable sander aims; a sander without one lays its rate at every speed."
    )
    rate: Annotated[Quantity, of_kind("sand rate", "> 0 kg/min .. 60 kg/min")] | None = optional(
        "Rate, of a variable sander its largest one: 6 kg/min if left out."
    )
    when: Literal["always", "sliding", "requested"] = field(
        "What demands sand: the brake command, the WSP that acts, or a controller of contract version 2.",
        default="sliding",
    )
    distance: Quantity = quantity(
        "Distance of the nozzle ahead of its wheelset.", "length", "0.1 m .. 1.5 m", default="0.3 m"
    )
    delay: Quantity = quantity(
        "Time from the demand to sand on the rail, and from its end to the last of it.",
        "time",
        "0 s .. 10 s",
        default="0.5 s",
    )
    off_below: Quantity = quantity(
        "Train speed below which no sand is demanded.", "speed", "0 km/h .. 100 km/h", default="10 km/h"
    )
    sliding_time: Quantity = quantity(
        "Time for which the WSP must hold or vent wheelsets of the car without a break before they count as"
        " sliding.",
        "time",
        "0 s .. 10 s",
        default="0.2 s",
    )
    run_on: Quantity = quantity(
        "Time without a hold or vent after which they no longer do.", "time", "0 s .. 60 s", default="3 s"
    )

    @property
    def largest_rate(self) -> float:
        """The largest rate, kg/s."""
        return float(self.usual_rate if self.rate is None else self.rate)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a sander that does not say what it lays."""
        if self.density is None and self.rate is None:
            yield Inconsistency((), "the sander lays nothing", "add `density: 7.5 g/m` or `rate: 2 kg/min`")


def _friction_form(value: object) -> str:
    points = isinstance(value, tuple) and any(isinstance(point, dict) for point in value)
    marked = isinstance(value, dict) and "value" in value
    is_profile = isinstance(value, dict | FrictionProfile) and not marked
    return "profile" if points or is_profile else "number"


FrictionAlongTrack = Annotated[
    Annotated[Friction, Tag("number")] | Annotated[FrictionProfile, Tag("profile")],
    Discriminator(_friction_form),
]


class Rail(Model):
    """The rail under the car."""

    condition: Annotated[RailCondition, PartReference(RailCondition, "dry")] = field(
        "Rail condition: dry, wet, a relative path or an inline mapping."
    )
    friction: FrictionAlongTrack | None = optional(
        "Initial friction coefficient, or points along the track; the condition's if left out."
    )
    friction_over_time: FactorProfile | None = optional(
        "Factor on the friction coefficient over time; 1 throughout if left out."
    )
    cleaning: Cleaning | None = optional("How sliding cleans the rail; as the condition says if left out.")
    variation: Variation | None = optional(
        "How friction varies at random along the track; as the condition says if left out."
    )
    friction_over_speed: FrictionOverSpeed | None = optional(
        "How friction falls with the train's speed; as the condition says if left out."
    )
    sand: Sand = field("What sand does on the rail; nothing without sanders.", default=Sand())
    gradient: Quantity = quantity(
        "Gradient of the track, positive uphill.",
        "gradient",
        "-60 permille .. 60 permille",
        default="0 permille",
    )

    @property
    def _frictions(self) -> list[Quantity]:
        if isinstance(self.friction, FrictionProfile):
            return [at.friction for at in self.friction.points]
        return [self.condition.friction if self.friction is None else self.friction]

    @property
    def highest_friction(self) -> float:
        """The highest friction coefficient anywhere, at any time."""
        over_time = () if self.friction_over_time is None else self.friction_over_time.points
        over_speed = self.friction_over_speed_in_force
        at_standstill = 1.0 if over_speed is None else over_speed.highest_factor
        return max((at.factor for at in over_time), default=1.0) * max(self._frictions) * at_standstill

    @property
    def friction_as_found(self) -> str:
        """The friction coefficient before anything slides: `0.09`, `0.05 .. 0.15 along the track`."""
        lowest, highest = min(self._frictions), max(self._frictions)
        along_track = isinstance(self.friction, FrictionProfile)
        text = f"{lowest:.3g} .. {highest:.3g} along the track" if along_track else f"{lowest:.3g}"
        return text if self.variation_in_force is None else f"{text}, varying at random"

    @property
    def cleaning_in_force(self) -> Cleaning | None:
        """Cleaning of the rail by sliding; None without it."""
        return self.condition.cleaning if self.cleaning is None else self.cleaning

    @property
    def friction_over_speed_in_force(self) -> FrictionOverSpeed | None:
        """How friction falls with speed; None where it does not."""
        over_speed = self.friction_over_speed
        return self.condition.friction_over_speed if over_speed is None else over_speed

    @property
    def variation_in_force(self) -> Variation | None:
        """Random variation of friction; None without it."""
        variation = self.condition.variation if self.variation is None else self.variation
        return None if variation is None or variation.spread == 0.0 else variation

    @property
    def highest_friction_after_cleaning(self) -> float:
        """The highest friction coefficient that a wheelset can meet."""
        cleaning, variation = self.cleaning_in_force, self.variation_in_force
        found = self.highest_friction * (1.0 if variation is None else variation.highest_factor)
        return found if cleaning is None else max(found, cleaning.recovered_friction)

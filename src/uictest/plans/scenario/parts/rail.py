"""The rail: the adhesion law (Polach 2005), friction along the track and over time."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from pydantic import create_model

from uictest.core.rail_laws import DEFAULT, LAWS, RailLaw
from uictest.plans.scenario.yaml import Inconsistency, Model, Part, Quantity, Section, quoted
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, optional, quantity, schema_field

Friction = Annotated[Quantity, of_kind("number", "0.001 .. 1")]
Share = Annotated[Quantity, of_kind("number", "0.001 .. 1")]
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


_RATIO: Final = "A: friction at infinite slip speed over mu0."
_DECAY: Final = "B: how fast friction falls with slip speed."
_ADHESION: Final = "kA: reduction of the creep slope in the area of adhesion."
_SLIP: Final = "kS: reduction of the creep slope in the area of slip."
Decay = Annotated[Quantity, of_kind("inverse speed", "0 s/m .. 100 s/m")]


class CreepCurve(Section):
    """The shape of a creep curve (Polach 2005); its friction coefficient stands elsewhere."""

    friction_ratio: Share = field(_RATIO)
    friction_decay: Decay = field(_DECAY)
    reduction_adhesion: Share = field(_ADHESION)
    reduction_slip: Share = field(_SLIP)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield reduction factors in the wrong order."""
        yield from super().inconsistencies()
        yield from _reductions_out_of_order(self)


Energy = Annotated[Quantity, of_kind("energy per length", "1 J/m .. 1e9 J/m")]
_CONTACTS: Final = 2.0
"""Of a wheelset."""


class _Cleaning(Section):
    """How sliding cleans the rail, for itself and for the wheelsets that follow."""

    energy: Energy = field("Wc: contact loss of a wheelset per metre of track that cleans 63 % of the rail.")
    recovered_friction: Friction = field(
        "Initial friction coefficient of a clean rail; where the rail is better, its friction stays."
    )
    reach: Quantity = quantity(
        "Length of track over which the cleaned share follows the contact loss.", "length", "1 mm .. 100 m"
    )
    carry_over: Quantity = quantity(
        "Part of what a wheelset has cleaned that the next one finds at the same place.", "number", "0 .. 1"
    )
    clean_curve: CreepCurve | None = optional(
        "Shape of the creep curve of a clean rail, to which that of the condition goes over; the condition's"
        " own if left out."
    )
    loss: Literal["wheelset", "contact"] = field(
        "Whose loss the energy is compared with: that of both contacts of a wheelset, or of one.",
        default="wheelset",
    )
    spent: Energy | None = optional(
        "Contact loss per metre that all wheelsets of earlier stops together have spent on the rail; none if"
        " left out."
    )

    @property
    def response(self) -> float:
        """Cleaned share per contact loss of a wheelset and metre, where little is cleaned, m/J."""
        return 1.0 / self.energy if self.loss == "wheelset" else 1.0 / _CONTACTS / self.energy

    @property
    def spent_share(self) -> float:
        """Share of the rail that earlier stops have cleaned."""
        if self.spent is None:
            return 0.0
        return self.law.settled_share(float(self.spent), float(self.response), self.law_numbers)

    @property
    def law(self) -> RailLaw:
        """The law that is named, else the default one."""
        return LAWS[next(iter(self._named), DEFAULT)]

    @property
    def law_numbers(self) -> tuple[float, ...]:
        """The law's own numbers, as its equations take them."""
        own = getattr(self, self.law.name, None)
        return tuple(number.convert(getattr(own, name)) for name, number in self.law.numbers.items())

    def clean_part(self, share: float) -> float:
        """How far friction and creep curve have gone to those of a clean rail, where a share is clean."""
        return self.law.clean_part(share, self.law_numbers)

    @property
    def _named(self) -> list[str]:
        return [name for name in LAWS if getattr(self, name, None) is not None]

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a second law."""
        yield from super().inconsistencies()
        for name in self._named[1:]:
            message = f"two laws are named: {quoted(self._named[0])} and {quoted(name)}"
            yield Inconsistency((name,), message, "keep one of them")


def _section_of(law: RailLaw) -> type[Section]:
    """Return the model of a law's own numbers."""
    fields: dict[str, Any] = {
        name: (Quantity, quantity(number.description, number.kind, f"{number.at_least} .. {number.at_most}"))
        for name, number in law.numbers.items()
    }
    section: type[Section] = create_model(
        f"{law.name.capitalize()}Law",
        __base__=Section,
        __doc__=law.description,
        __module__=__name__,
        **fields,
    )
    return section


_LAW_SECTIONS: Final = {name: _section_of(law) for name, law in LAWS.items() if name != DEFAULT}
# Pickle finds a class by its name in its module; sweeps send scenarios to other processes.
globals().update({section.__name__: section for section in _LAW_SECTIONS.values()})

if TYPE_CHECKING:
    Cleaning = _Cleaning
else:
    Cleaning = create_model(
        "Cleaning",
        __base__=_Cleaning,
        __doc__=_Cleaning.__doc__,
        __module__=__name__,
        **{
            name: (section | None, optional(f"{LAWS[name].description} A law in place of the usual one."))
            for name, section in _LAW_SECTIONS.items()
        },
    )


_DEVIATIONS: Final = 6.0
"""Standard deviations of the logarithm of friction beyond which no rail is expected to be; chosen."""


class Variation(Section):
    """How friction varies at random along the track: log-normal, with a correlation of exp(-distance / l).

    The seed of a stop and the place on the track decide it, and nothing else.
    """

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
        return math.exp(_DEVIATIONS * self.log_spread)


class RailCondition(Part):
    """A condition of the rail surface."""

    folder: ClassVar[str] = "rails"

    schema_id: Literal["uictest/rail/1"] = schema_field("uictest/rail/1")
    friction: Friction = field("Initial friction coefficient mu0, at zero slip speed.")
    friction_ratio: Share = field(_RATIO)
    friction_decay: Decay = field(_DECAY)
    reduction_adhesion: Share = field(_ADHESION)
    reduction_slip: Share = field(_SLIP)
    contact: Contact = field("The contact of one wheel.")
    cleaning: Cleaning | None = optional("How sliding cleans the rail; it does not if left out.")
    variation: Variation | None = optional("How friction varies at random; it does not if left out.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield reduction factors in the wrong order."""
        yield from super().inconsistencies()
        yield from _reductions_out_of_order(self)


def _reductions_out_of_order(curve: CreepCurve | RailCondition) -> Iterator[Inconsistency]:
    if curve.reduction_slip > curve.reduction_adhesion:
        yield Inconsistency(
            ("reduction_slip",),
            f"kS = {curve.reduction_slip.text} exceeds kA = {curve.reduction_adhesion.text}",
            "the law needs reduction_slip <= reduction_adhesion <= 1",
        )


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

"""How sliding cleans the rail: the creep curve of a clean one, and the laws by which it gets clean."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import create_model

from uictest.core.rail_laws import DEFAULT, LAWS, RailLaw
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Quantity,
    Section,
    field,
    of_kind,
    optional,
    quantity,
    quoted,
)

Friction = Annotated[Quantity, of_kind("number", "0.001 .. 1")]
Share = Annotated[Quantity, of_kind("number", "0.001 .. 1")]
FRICTION_RATIO: Final = "A: friction at infinite slip speed over mu0."
FRICTION_DECAY: Final = "B: how fast friction falls with slip speed."
REDUCTION_ADHESION: Final = "kA: reduction of the creep slope in the area of adhesion."
REDUCTION_SLIP: Final = "kS: reduction of the creep slope in the area of slip."
Decay = Annotated[Quantity, of_kind("inverse speed", "0 s/m .. 100 s/m")]


class CreepCurve(Section):
    """The shape of a creep curve (Polach 2005); its friction coefficient stands elsewhere."""

    friction_ratio: Share = field(FRICTION_RATIO)
    friction_decay: Decay = field(FRICTION_DECAY)
    reduction_adhesion: Share = field(REDUCTION_ADHESION)
    reduction_slip: Share = field(REDUCTION_SLIP)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield reduction factors in the wrong order."""
        yield from super().inconsistencies()
        yield from reductions_out_of_order(self)


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
    fields: dict[str, Any] = {
        name: (Quantity, quantity(number.description, number.kind, f"{number.at_least} .. {number.at_most}"))
        for name, number in law.numbers.items()
    }
    return create_model(
        f"{law.name.capitalize()}Law",
        __base__=Section,
        __doc__=law.description,
        __module__=__name__,
        **fields,
    )


_LAW_SECTIONS: Final = {name: _section_of(law) for name, law in LAWS.items() if name != DEFAULT}


def __getattr__(name: str) -> type[Section]:
    """Return the section of a law by its name, where pickle looks for it: sweeps send scenarios around."""
    for section in _LAW_SECTIONS.values():
        if section.__name__ == name:
            return section
    raise AttributeError(name)


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


def reductions_out_of_order(curve: Any) -> Iterator[Inconsistency]:
    """Yield kS above kA, for a curve that has both."""
    if curve.reduction_slip > curve.reduction_adhesion:
        yield Inconsistency(
            ("reduction_slip",),
            f"kS = {curve.reduction_slip.text} exceeds kA = {curve.reduction_adhesion.text}",
            "the law needs reduction_slip <= reduction_adhesion <= 1",
        )

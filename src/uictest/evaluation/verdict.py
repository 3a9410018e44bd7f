"""What judging one criterion says, and how firmly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from uictest.evaluation.json_form import json_form

Status = Literal["pass", "fail", "not_applicable", "inconclusive"]
"""What a criterion says of a stop.

not_applicable: the criterion says nothing about such a stop. inconclusive: data to judge it are missing.
"""

Layer = Literal["validity", "requirement"]
"""validity: the stop counts as a test. requirement: the vehicle or its WSP is good enough."""


@dataclass(frozen=True, slots=True)
class VerdictInterval:
    """A part of a definition's range over which the verdict stays the same; both ends belong to it."""

    first: float
    last: float
    verdict: Status

    def __str__(self) -> str:
        """Return the stretch for a reader, as in "pass 2 .. 3.41"."""
        ends = f"{self.first:.4g}" if self.first == self.last else f"{self.first:.4g} .. {self.last:.4g}"
        return f"{self.verdict.replace('_', ' ')} {ends}"


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """How a verdict moves while one definition runs through its stated range, all others held.

    `lower`, `upper` and the ends of the stretches are in `unit`. Stretches come in rising order. A definition
    that moves in classes (the low-speed cut-off) leaves gaps between stretches: there is nothing between.
    """

    definition: str
    unit: str
    lower: float
    upper: float
    stretches: tuple[VerdictInterval, ...]

    @property
    def flips(self) -> bool:
        """Whether the verdict is not the same all over the range."""
        return len({stretch.verdict for stretch in self.stretches}) > 1

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form; `flips` stands beside the stretches for those who only ask that."""
        form: dict[str, Any] = json_form(asdict(self))
        return {**form, "flips": self.flips}

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Sensitivity:
        """Return the sensitivity whose `to_dict` is `content`."""
        own = {key: value for key, value in content.items() if key != "flips"}
        return cls(
            **{**own, "stretches": tuple(VerdictInterval(**stretch) for stretch in content["stretches"])}
        )

    def __str__(self) -> str:
        """Return a line for a reader: "low_speed_cutoff 10 .. 60 km/h: pass 10 .. 40, fail 50 .. 60"."""
        scope = f"{self.definition} {self.lower:.4g} .. {self.upper:.4g} {self.unit}"
        if not self.flips:
            return f"{scope}: {self.stretches[0].verdict.replace('_', ' ')} throughout"
        return f"{scope}: {', '.join(map(str, self.stretches))}"


@dataclass(frozen=True, slots=True)
class AppliedDefinition:
    """A definition as a number: what a verdict, or the measure behind it, was taken to mean.

    `value`, `lowest` and `highest` are in `unit`, an SI unit; without a range the last two are None.
    `mark` says how far the number can be trusted, as that of :class:`~uictest.evaluation.Parameter` does.
    """

    name: str
    value: float
    unit: str
    mark: str
    lowest: float | None = None
    highest: float | None = None


@dataclass(frozen=True, slots=True)
class Verdict:
    """One criterion's verdict on one stop.

    `value`, `lower`, `upper` and `margin` are in `unit`; None where a bound is not set or there is no value.
    `margin` is the distance to the nearest bound, positive on the good side. For a criterion over wheelsets
    `value` is the one of the wheelset that decides. `definition` maps each definition used to its text,
    `measure` and `definitions` hold the name of the measure and the definitions that are numbers.
    """

    id: str
    layer: Layer
    value: float | None
    unit: str
    lower: float | None
    upper: float | None
    margin: float | None
    verdict: Status
    reason: str
    definition: dict[str, str] = field(default_factory=dict)
    sensitivity: tuple[Sensitivity, ...] = ()
    measure: str = ""
    definitions: tuple[AppliedDefinition, ...] = ()

    @property
    def firm(self) -> bool:
        """Whether the verdict stays the same over the stated range of every definition."""
        return not any(sensitivity.flips for sensitivity in self.sensitivity)

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form: the fields under their names, NaN and infinity as None."""
        form: dict[str, Any] = json_form(asdict(self))
        return {**form, "sensitivity": [sensitivity.to_dict() for sensitivity in self.sensitivity]}

    def defined(self, name: str) -> float | None:
        """Return the SI value of a definition, None where the verdict has none of this name."""
        return next((each.value for each in self.definitions if each.name == name), None)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Verdict:
        """Return the verdict whose `to_dict` is `content`."""
        parts = {
            "sensitivity": tuple(map(Sensitivity.from_dict, content["sensitivity"])),
            "definitions": tuple(AppliedDefinition(**each) for each in content.get("definitions", ())),
        }
        return cls(**{**content, **parts})

"""The result of one case: outcome, verdicts and figures, in the units a brake engineer reads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from uictest.evaluation.json_form import json_form, or_nan
from uictest.evaluation.parameters import EffectivePart
from uictest.evaluation.verdict import Verdict

Outcome = Literal["pass", "fail", "invalid", "inconclusive", "error", "skipped"]
Expectation = Literal["pass", "fail", "invalid"]
_UNITS = {"m": "m", "s": "s", "mps2": "m/s2", "g": "g", "bar": "bar", "nl": "NL", "n": "N"}
"""How the name of a figure ends -> its unit."""


def unit_of(figure: str) -> str:
    """Return the unit that the name of a figure says, `1` for a pure number.

    The number of a wheelset may follow the name: `locked_time_s_3`.
    """
    words = figure.split("_")
    return _UNITS.get(words[-2] if words[-1].isdigit() else words[-1], "1")


@dataclass(frozen=True, slots=True)
class CaseMeasures:
    """The figures of one stop, units in the names (nl: litres at 20 degC and 1 bar). NaN: not reached."""

    braking_distance_m: float
    braking_time_s: float
    mean_deceleration_mps2: float
    initial_adhesion_g: float
    minimum_deceleration_mps2: float
    maximum_deceleration_mps2: float
    reservoir_minimum_bar: float
    air_consumed_nl: float
    energy_residual: float
    air_residual: float

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form, NaN as None."""
        form: dict[str, Any] = json_form(asdict(self))
        return form

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> CaseMeasures:
        """Return the figures whose `to_dict` is `content`."""
        return cls(**{name: or_nan(value) for name, value in content.items()})


@dataclass(frozen=True, slots=True)
class CaseWheelsetMeasures:
    """The figures of one wheelset in one stop; `maximum_slide` is a share (1 = locked).

    `valve_actuations` is a whole number, NaN where a record does not hold the valve's commands.
    """

    maximum_slide: float
    locked_time_s: float
    valve_actuations: float
    maximum_clamping_force_n: float
    air_vented_nl: float

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form, NaN as None."""
        form: dict[str, Any] = json_form(asdict(self))
        return form

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> CaseWheelsetMeasures:
        """Return the figures whose `to_dict` is `content`."""
        numbers: dict[str, Any] = {name: or_nan(value) for name, value in content.items()}
        return cls(**{**numbers, "valve_actuations": whole(numbers["valve_actuations"])})


def whole(count: float) -> float:
    """Return a count as a whole number; NaN where nothing was counted."""
    return count if math.isnan(count) else int(count)


@dataclass(frozen=True, slots=True)
class CaseResult:
    """One case, judged. `scenario` is the file as the case names it (forward slashes).

    `reason` says why the outcome is what it is. `measures` is None and `wheelsets` empty when the simulation
    failed. `parts` maps a role (`controller`, ...) to the part that the case was run with; it is empty where
    an earlier version wrote the result. `duration` (seconds of wall clock) is for progress and JUnit only,
    never part of the document: a result must not depend on the machine.
    """

    id: str
    scenario: str
    parameters: dict[str, str]
    expect: Expectation
    outcome: Outcome
    criteria: tuple[Verdict, ...] = ()
    measures: CaseMeasures | None = None
    wheelsets: tuple[CaseWheelsetMeasures, ...] = ()
    reason: str = ""
    parts: Mapping[str, EffectivePart] = field(default_factory=dict)
    duration: float = field(default=0.0, compare=False)

    @property
    def met(self) -> bool:
        """Whether the outcome is the expected one; a skipped case meets only the expectation `pass`."""
        return self.outcome == self.expect or (self.outcome == "skipped" and self.expect == "pass")

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form: the fields of the result document, NaN as None, without `duration`.

        Parts are named by their ids; :func:`parts_table` has them in full.
        """
        return {
            "id": self.id,
            "scenario": self.scenario,
            "parameters": dict(self.parameters),
            "expect": self.expect,
            "outcome": self.outcome,
            "reason": self.reason,
            "criteria": [verdict.to_dict() for verdict in self.criteria],
            "measures": self.measures.to_dict() if self.measures else None,
            "wheelsets": [wheelset.to_dict() for wheelset in self.wheelsets],
            "parts": {role: part.id for role, part in self.parts.items()},
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any], parts: Mapping[str, EffectivePart]) -> CaseResult:
        """Return the result whose `to_dict` is `content` (None in a figure becomes NaN).

        `parts` are those that it may name, by id. Raises KeyError where it names another.
        """
        measures = content["measures"]
        own = {
            "criteria": tuple(map(Verdict.from_dict, content["criteria"])),
            "measures": CaseMeasures.from_dict(measures) if measures else None,
            "wheelsets": tuple(map(CaseWheelsetMeasures.from_dict, content["wheelsets"])),
            "parts": {role: parts[part_id] for role, part_id in content.get("parts", {}).items()},
        }
        return cls(**{**content, **own})

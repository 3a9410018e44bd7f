"""The result of one case: outcome, verdicts and figures, in the units a brake engineer reads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, PlainSerializer, PlainValidator, ValidationInfo

from uictest.evaluation.json_form import Number, finite_or_none, nan_for_none
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


def whole(count: float) -> float:
    """Return a count as a whole number; NaN where nothing was counted."""
    return count if math.isnan(count) else int(count)


Count = Annotated[
    float, BeforeValidator(nan_for_none), AfterValidator(whole), PlainSerializer(finite_or_none)
]


@dataclass(frozen=True, slots=True)
class CaseMeasures:
    """The figures of one stop, units in the names (nl: litres at 20 degC and 1 bar). NaN: not reached."""

    braking_distance_m: Number
    braking_time_s: Number
    mean_deceleration_mps2: Number
    initial_adhesion_g: Number
    minimum_deceleration_mps2: Number
    maximum_deceleration_mps2: Number
    reservoir_minimum_bar: Number
    air_consumed_nl: Number
    energy_residual: Number
    air_residual: Number


@dataclass(frozen=True, slots=True)
class CaseWheelsetMeasures:
    """The figures of one wheelset in one stop; `maximum_slide` is a share (1 = locked).

    `valve_actuations` is a whole number, NaN where a record does not hold the valve's commands.
    """

    maximum_slide: Number
    locked_time_s: Number
    valve_actuations: Count
    maximum_clamping_force_n: Number
    air_vented_nl: Number


def _part_ids(parts: Mapping[str, EffectivePart]) -> dict[str, str]:
    return {role: part.id for role, part in parts.items()}


def _parts_by_role(part_ids: object, info: ValidationInfo) -> dict[str, EffectivePart]:
    """Return the parts that a case names by their ids; the context of the validation holds all by id."""
    if not isinstance(part_ids, Mapping):
        raise ValueError("Input should be a mapping from roles to ids of parts")
    parts: Mapping[str, EffectivePart] = info.context or {}
    if missing := [part_id for part_id in part_ids.values() if part_id not in parts]:
        raise ValueError(f"the document has no part {missing[0]!r}")
    return {role: parts[part_id] for role, part_id in part_ids.items()}


NamedParts = Annotated[
    Mapping[str, EffectivePart], PlainValidator(_parts_by_role), PlainSerializer(_part_ids)
]
"""In JSON a case names its parts by their ids: the document holds each part once."""


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
    reason: str = ""
    criteria: tuple[Verdict, ...] = ()
    measures: CaseMeasures | None = None
    wheelsets: tuple[CaseWheelsetMeasures, ...] = ()
    parts: NamedParts = field(default_factory=dict)
    duration: Annotated[float, Field(exclude=True)] = field(default=0.0, compare=False)

    @property
    def met(self) -> bool:
        """Whether the outcome is the expected one; a skipped case meets only the expectation `pass`."""
        return self.outcome == self.expect or (self.outcome == "skipped" and self.expect == "pass")

"""The result of one case: outcome, verdicts and measures, in the units a brake engineer reads."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Annotated, Literal

from pydantic import Field, PlainSerializer, PlainValidator, ValidationInfo

from uictest.controllers import ResponseTimes
from uictest.evaluation.json_form import json_form
from uictest.evaluation.parameters import EffectivePart
from uictest.evaluation.verdict import Layer, Status, Verdict, relative_margin
from uictest.measures import STOP_COLUMNS, WHEELSET_COLUMNS

Outcome = Literal["pass", "fail", "invalid", "inconclusive", "error", "skipped"]
Expectation = Literal["pass", "fail", "invalid"]


def _columns(content: object, known: Collection[str]) -> dict[str, float]:
    """Return the numbers of a document in these columns; null and what an earlier version lacked as NaN."""
    if not isinstance(content, Mapping) or not content or not set(content) <= set(known):
        raise ValueError(f"Input should have columns out of {', '.join(known)}")
    if not all(value is None or _is_number(value) for value in content.values()):
        raise ValueError("Input should hold numbers only")
    return {name: math.nan if (value := content.get(name)) is None else value for name in known}


def _is_number(value: object) -> bool:
    # JSON writes whole numbers of any length; one beyond the largest float is no measure.
    return type(value) is float or (type(value) is int and abs(value) <= sys.float_info.max)


_finite = PlainSerializer(json_form)
CaseMeasures = Annotated[Mapping[str, float], PlainValidator(partial(_columns, known=STOP_COLUMNS)), _finite]
"""What a result reports of a stop: :data:`~uictest.measures.STOP_COLUMNS` -> number, NaN: not reached."""

CaseWheelsetMeasures = Annotated[
    Mapping[str, float], PlainValidator(partial(_columns, known=WHEELSET_COLUMNS)), _finite
]
"""What it reports of one wheelset: :data:`~uictest.measures.WHEELSET_COLUMNS` -> number, NaN: not reached."""


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
    an earlier version wrote the result. `response_times` are those of a controller in a stop that was paced
    by the clock. `controller_version` is what a controller from outside said of itself in this stop, and
    `case_sha256` what it was given to name the stop, see :func:`uictest.rig.assembly.case_sha256`. The
    document has these three only where there is something in them. `duration` (seconds of wall clock) is for
    progress and JUnit only, never part of the document: a result must not depend on the machine.
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
    response_times: ResponseTimes | None = None
    controller_version: str = ""
    case_sha256: str = ""
    duration: Annotated[float, Field(exclude=True)] = field(default=0.0, compare=False)

    @property
    def met(self) -> bool:
        """Whether the outcome is the expected one; a skipped case counts as `pass`."""
        return self.outcome == self.expect or (self.outcome == "skipped" and self.expect == "pass")


def outcome_of(verdicts: Iterable[Verdict]) -> tuple[Outcome, str]:
    """Return the outcome of a stop and why.

    A failed validity criterion makes the stop invalid: it does not count as a test, whatever its
    requirements. Otherwise a failed requirement fails the stop, unless a validity criterion is inconclusive:
    the stop may be no test. Any other inconclusive criterion makes the stop inconclusive. A stop without any
    applicable criterion is skipped.
    """
    verdicts = list(verdicts)
    if reasons := _reasons(verdicts, ("fail",), "validity"):
        return "invalid", reasons
    reasons = _reasons(verdicts, ("fail",), "requirement")
    if reasons and not _reasons(verdicts, ("inconclusive",), "validity"):
        return "fail", reasons
    if any(verdict.status == "inconclusive" for verdict in verdicts):
        return "inconclusive", _reasons(verdicts, ("fail", "inconclusive"))
    if not any(verdict.status == "pass" for verdict in verdicts):
        return "skipped", _reasons(verdicts, ("not_applicable",)) or "no criterion"
    return "pass", ""


def _reasons(verdicts: list[Verdict], statuses: Sequence[Status], layer: Layer | None = None) -> str:
    return "; ".join(
        f"{verdict.id}: {verdict.reason}"
        for verdict in verdicts
        if verdict.status in statuses and layer in (None, verdict.layer)
    )


def narrowest_margin(result: CaseResult) -> tuple[float | None, str]:
    """Return the smallest relative margin of a case and the id of its criterion; None and "" without any."""
    margins = [
        (margin, verdict.id)
        for verdict in result.criteria
        if (margin := relative_margin(verdict)) is not None
    ]
    return min(margins, default=(None, ""))

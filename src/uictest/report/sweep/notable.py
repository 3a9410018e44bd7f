"""The cases of a sweep that are worth a line of their own: the worst ones, and others that were not met."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uictest import evaluation
from uictest.report.escaping import printable
from uictest.report.wording import explanation, outcome_word, result_word

if TYPE_CHECKING:
    from uictest.report.sweep.content import SweepContent


@dataclass(frozen=True, slots=True)
class NotableCase:
    """A case as a line of a report has it; `why` is empty where it was met."""

    id: str
    met: bool
    word: str
    outcome: str
    why: str
    distance: float | None = None
    """Braking distance, m."""
    margin: float | None = None
    """Narrowest margin over its bound, %, and the criterion that has it."""
    criterion: str = ""


def notable_cases(content: SweepContent) -> list[NotableCase]:
    """Return the worst cases and the first that were not met, each once, those not met in front."""
    worst = [_looked_at(result) for result in content.worst]
    known = {case.id for case in worst}
    others = [_counted(each) for each in content.document["missed"] if each["id"] not in known]
    return sorted([*worst, *others], key=lambda case: case.met)


def _looked_at(result: evaluation.CaseResult) -> NotableCase:
    why = "" if result.met else "; ".join(explanation(result))
    distance = (result.measures or {}).get("braking_distance_m")
    margin, criterion = evaluation.narrowest_margin(result)
    share = None if margin is None else 100.0 * margin
    word = result_word(result)
    return NotableCase(result.id, result.met, word, result.outcome, why, distance, share, criterion)


def _counted(missed: Mapping[str, str]) -> NotableCase:
    """Return a case of which only the outcome and the reason were kept."""
    outcome = missed["outcome"]
    why = printable(": ".join(text for text in (f"got {outcome}", missed["reason"]) if text))
    return NotableCase(missed["id"], False, outcome_word(outcome, met=False), outcome, why)

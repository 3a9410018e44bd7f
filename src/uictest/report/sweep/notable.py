"""The cases of a sweep that reports list: the worst ones, and others that were not met."""

from __future__ import annotations

from dataclasses import dataclass

from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.sweep.result import MissedCase, SweepResult
from uictest.report.wording import explanation, outcome_word, result_word


@dataclass(frozen=True, slots=True)
class NotableCase:
    """A case as one line of a report; `why` is empty where it was met."""

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


def notable_cases(result: SweepResult) -> list[NotableCase]:
    """Return the worst cases and the first missed ones, each once, missed cases first."""
    worst = [_from_result(case) for case in result.worst]
    known = {case.id for case in worst}
    others = [_from_missed(case) for case in result.missed if case.id not in known]
    return sorted([*worst, *others], key=lambda case: case.met)


def _from_result(result: evaluation.CaseResult) -> NotableCase:
    why = "" if result.met else "; ".join(explanation(result))
    distance = (result.measures or {}).get("braking_distance_m")
    margin, criterion = evaluation.narrowest_margin(result)
    share = None if margin is None else 100.0 * margin
    word = result_word(result)
    return NotableCase(result.id, result.met, word, result.outcome, why, distance, share, criterion)


def _from_missed(case: MissedCase) -> NotableCase:
    """Return a case of which only outcome and reason are known."""
    why = printable(": ".join(text for text in (f"got {case.outcome}", case.reason) if text))
    return NotableCase(case.id, False, outcome_word(case.outcome, met=False), case.outcome, why)

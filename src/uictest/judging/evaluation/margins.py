"""How far a stop is from failing a criterion: a number that a search can follow."""

from __future__ import annotations

import math
from typing import Final

from uictest.core.measures import MEASURES
from uictest.judging.evaluation.outcome import failed_checks, missed_requirements
from uictest.judging.evaluation.result import CaseResult
from uictest.judging.evaluation.verdict import Verdict

_MISSED: Final = -1e-12
"""Margin of a value at a bound that it must not reach."""


def guiding_margin(result: CaseResult, criterion: str) -> float:
    """Return the margin of a stop to a criterion over its limit: negative where it fails, never 0 there.

    NaN where the criterion is not judged, where the figures are not those of the test, and where a
    requirement that stands in a valid test alone is missed in another stop.

    Where a measure is 0 until something begins, as the time of a lock or a count is, its margin would be the
    same in all stops before. There 1 - a is added, with a from 0 to 1 how near a stop comes to the beginning:
    of a lock, 1 is the beginning and 2 a stop without any slide.
    Margins of different criteria are of different scales: never add them.
    """
    verdict = next((verdict for verdict in result.decided if verdict.id == criterion), None)
    if verdict is None or verdict.status not in ("pass", "fail") or failed_checks(result.decided):
        return math.nan
    if verdict.status == "fail":
        stands = verdict.layer != "requirement" or verdict in missed_requirements(result.decided)
        return min(_scaled_margin(verdict), _MISSED) if stands else math.nan
    margin = max(_scaled_margin(verdict), 0.0)
    column = MEASURES[verdict.measure].approach if verdict.measure in MEASURES else ""
    if not column:
        return margin
    approaches = [value for wheelset in result.wheelsets if math.isfinite(value := wheelset[column])]
    return margin + 1.0 - min(max(approaches, default=1.0), 1.0)


def _scaled_margin(verdict: Verdict) -> float:
    """Return the margin over the limit; over one unit where the limit is 0. Infinity for no finite value."""
    if verdict.margin is None or not math.isfinite(verdict.margin):
        return -math.inf if verdict.status == "fail" else math.inf
    return verdict.margin / (max(abs(verdict.lower or 0.0), abs(verdict.upper or 0.0)) or 1.0)

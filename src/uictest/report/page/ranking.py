"""Which cases a page draws: the ones worth looking at first."""

from __future__ import annotations

from collections.abc import Iterable

from uictest import evaluation

DRAWN = 18
"""Cases drawn on one page. Each takes up to 270 kB, and a page must still open from a mail attachment."""


def worst_first(results: Iterable[evaluation.CaseResult]) -> list[evaluation.CaseResult]:
    """Return the results with those not met first, then those whose verdicts stand least firmly."""
    return sorted(results, key=_rank)


def _rank(result: evaluation.CaseResult) -> tuple[bool, bool, float]:
    margin, _ = evaluation.narrowest_margin(result)
    return result.met, result.outcome == "pass", 1.0 if margin is None else margin

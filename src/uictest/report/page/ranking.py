"""Which cases a page draws: the ones worth looking at first."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult, Verdict

DRAWN = 18
"""Cases drawn on one page. Each takes about 160 kB, and a page must still open from a mail attachment."""


def worst_first(results: Iterable[CaseResult]) -> list[CaseResult]:
    """Return the results with those not met first, then those whose verdicts stand least firmly."""
    return sorted(results, key=lambda result: (result.met, result.outcome == "pass", _tightest(result)))


def _tightest(result: CaseResult) -> float:
    margins = (_share(verdict) for verdict in result.criteria)
    return min((margin for margin in margins if margin is not None), default=1.0)


def _share(verdict: Verdict) -> float | None:
    """Return the margin over the bound, so that criteria of any unit compare; a flip counts as none."""
    if verdict.margin is None:
        return None
    bound = max(abs(verdict.lower or 0.0), abs(verdict.upper or 0.0))
    return verdict.margin / bound if verdict.firm and bound else min(verdict.margin, 0.0)

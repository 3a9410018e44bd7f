"""Which cases a page draws: the ones worth looking at first."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult

DRAWN = 18
"""Cases drawn on one page. Each takes up to 270 kB, and a page must still open from a mail attachment."""


def worst_first(results: Iterable[CaseResult]) -> list[CaseResult]:
    """Return the results with those not met first, then those whose verdicts stand least firmly."""
    return sorted(results, key=_rank)


def _rank(result: CaseResult) -> tuple[bool, bool, float]:
    from uictest.evaluation import narrowest_margin

    margin, _ = narrowest_margin(result)
    return result.met, result.outcome == "pass", 1.0 if margin is None else margin

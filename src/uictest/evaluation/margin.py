"""How close a case came to missing one of its criteria, on a scale that all criteria share."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uictest.evaluation.result import CaseResult
    from uictest.evaluation.verdict import Verdict


def relative_margin(verdict: Verdict) -> float | None:
    """Return the margin over the bound, negative where it is missed; None where there is none.

    A criterion that is met exactly only says yes or no, as that of standstill does, and has none. A verdict
    that flips within the range of a definition counts as no margin at all.
    """
    if verdict.margin is None or (verdict.margin == 0.0 and verdict.status == "pass" and verdict.firm):
        return None
    bound = max(abs(verdict.lower or 0.0), abs(verdict.upper or 0.0))
    return verdict.margin / bound if verdict.firm and bound else min(verdict.margin, 0.0)


def narrowest_margin(result: CaseResult) -> tuple[float | None, str]:
    """Return the smallest relative margin of a case and the id of its criterion; None and "" without any."""
    found = [(margin, each.id) for each in result.criteria if (margin := relative_margin(each)) is not None]
    return min(found, default=(None, ""))

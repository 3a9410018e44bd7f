"""Two numbers against a tolerance."""

from __future__ import annotations

import math

from uictest.comparison.tolerance import Tolerances
from uictest.report import Difference


def compare_numbers(
    case: str, quantity: str, first: float, second: float, tolerances: Tolerances, unit: str = ""
) -> Difference | None:
    """Return how two figures differ, None where they are the same. No number equals only no number."""
    if first == second or (math.isnan(first) and math.isnan(second)):
        return None
    if not (math.isfinite(first) and math.isfinite(second)):
        remark = "there is one on one side only"
        return Difference(case, quantity, first, second, within=False, unit=unit, remark=remark)
    deviation = abs(second - first)
    allowed = tolerances.of(quantity).allowed(max(abs(first), abs(second)))
    return Difference(case, quantity, first, second, deviation <= allowed, unit, deviation, allowed)

"""Whether a verdict would flip within the stated range of a definition, and where."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import groupby, pairwise

from uictest.core.units import in_unit
from uictest.judging.evaluation.decision import Decision
from uictest.judging.evaluation.verdict import Sensitivity, Status, VerdictInterval

RESOLUTION = 1e-7
"""In the unit of the definition: how closely a flip is located."""

Decide = Callable[[float], Decision]


def sensitivity(
    name: str, unit: str, lower: float, upper: float, step: float | None, decide: Decide
) -> Sensitivity:
    """Return how the verdict changes while the definition `name` runs from `lower` to `upper` (SI).

    `decide` gives the decision at a value of the definition. With a `step` the definition takes multiples of
    it only, and all of them in the range are decided. Without one it is continuous, what it defines is
    monotonic between whole seconds, and each flip is located by halving.
    """
    points = _classes(lower, upper, step) if step else _whole_and_ends(lower, upper)
    decided = [(point, decide(point)) for point in points]
    if not step:
        decided = _refined(decided, decide)
    intervals = tuple(_intervals([(in_unit(point, unit), decision.status) for point, decision in decided]))
    return Sensitivity(name, unit, round(in_unit(lower, unit), 6), round(in_unit(upper, unit), 6), intervals)


def _classes(lower: float, upper: float, step: float) -> list[float]:
    return [k * step for k in range(round(lower / step), round(upper / step) + 1)]


def _whole_and_ends(lower: float, upper: float) -> list[float]:
    whole = [float(k) for k in range(math.floor(lower) + 1, math.ceil(upper))]
    return [lower, *whole, upper] if upper > lower else [lower]


def _refined(decided: list[tuple[float, Decision]], decide: Decide) -> list[tuple[float, Decision]]:
    refined = decided[:1]
    for before, after in pairwise(decided):
        refined += [*_flips_between(before, after, decide), after]
    return refined


def _flips_between(
    before: tuple[float, Decision], after: tuple[float, Decision], decide: Decide
) -> list[tuple[float, Decision]]:
    # Two bounds may both be crossed between two points, so that the middle differs from both ends: halving
    # goes on in every half whose ends differ.
    if _same(before[1], after[1]) or after[0] - before[0] < RESOLUTION:
        return []
    point = 0.5 * (before[0] + after[0])
    middle = (point, decide(point))
    return [*_flips_between(before, middle, decide), middle, *_flips_between(middle, after, decide)]


def _same(one: Decision, other: Decision) -> bool:
    return (one.status, one.side) == (other.status, other.side)


def _intervals(decided: list[tuple[float, Status]]) -> list[VerdictInterval]:
    runs = (list(run) for _, run in groupby(decided, key=lambda point: point[1]))
    return [VerdictInterval(round(run[0][0], 6), round(run[-1][0], 6), run[0][1]) for run in runs]

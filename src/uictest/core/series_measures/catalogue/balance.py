"""How alike the two bogies brake."""

from __future__ import annotations

import math

from uictest.core.series_measures.measure import CountedStop, median_and_worst


def bogie_imbalance(stop: CountedStop) -> float:
    """Return by how much the decelerations that the bogies give differ, in % of their mean."""
    first, second = (stop.measures.get(f"deceleration_bogie_{n}_mps2", math.nan) for n in (1, 2))
    total = first + second
    return 200.0 * abs(first - second) / total if total else math.nan


MEASURES = (
    *median_and_worst(
        "bogie_imbalance",
        "share",
        "%",
        "difference of the decelerations that the two bogies give, over their mean",
        bogie_imbalance,
    ),
)

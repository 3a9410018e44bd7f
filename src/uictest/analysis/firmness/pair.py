"""Which of two stops under the same noise comes to less: what a study of firmness asks of two controllers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final

from uictest.analysis.firmness.stops import Drawn
from uictest.judging.evaluation import CaseResult

FIRST, SECOND, SAME = "pass", "fail", "same"
"""Status of a quantity: the first stop comes to less, the second one, neither."""


def _of_stop(name: str) -> Callable[[CaseResult], float]:
    return lambda result: (result.measures or {}).get(name, math.nan)


def _of_worst_wheelset(name: str) -> Callable[[CaseResult], float]:
    return lambda result: max((each.get(name, math.nan) for each in result.wheelsets), default=math.nan)


COMPARED: Final[Mapping[str, Callable[[CaseResult], float]]] = {
    "braking distance": _of_stop("braking_distance_m"),
    "air consumed": _of_stop("air_consumed_nl"),
    "contact energy of the worst wheelset": _of_worst_wheelset("contact_energy_kj"),
}
"""Quantities of which less is better."""


def compared(first: CaseResult, second: CaseResult) -> Drawn:
    """Return which of two stops comes to less, with the difference as a share of the first.

    It is an error where one of them failed or came to no standstill. Of a first stop that comes to nothing
    no share is known.
    """
    statuses, margins = {}, {}
    for name, read in COMPARED.items():
        one, other = read(first), read(second)
        if math.isnan(one) or math.isnan(other):
            return Drawn("error")
        statuses[name] = FIRST if one < other else SECOND if other < one else SAME
        if one:
            margins[name] = (other - one) / one
    return Drawn("pass", statuses, margins)

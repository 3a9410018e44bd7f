"""The result of a simulated stop: judged where its measures are numbers, an error where they are not."""

from __future__ import annotations

import math
from collections.abc import Iterator

from uictest import scenario
from uictest.evaluation.case import error_result, evaluate
from uictest.evaluation.records import StopMeasures, Wheelsets
from uictest.evaluation.result import CaseResult

_OF_THE_STOP = (
    "end_time",
    "end_distance",
    "end_speed",
    "reservoir_minimum_pressure",
    "air_consumed",
    "energy_residual",
    "air_residual",
)
_OF_WHEELSETS = (
    "maximum_slide",
    "sliding_duration",
    "locked_time",
    "longest_lock",
    "valve_actuations",
    "maximum_clamping_force",
    "air_vented",
)
"""Measures that every simulated stop has; the others are NaN where something never happened."""


def evaluate_simulated(
    case: scenario.Case,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    duration: float = 0.0,
    *,
    explain: bool = True,
) -> CaseResult:
    """Return the judged result of a simulated case, outcome `error` where a measure is not finite.

    Arguments as for :func:`uictest.evaluation.case.evaluate`.
    """
    broken = list(_not_finite(measures, wheelset_measures))
    if broken:
        return error_result(case, _reason(measures, broken), duration)
    return evaluate(case, measures, wheelset_measures, duration, explain=explain)


def _not_finite(measures: StopMeasures, wheelsets: Wheelsets) -> Iterator[str]:
    yield from (name for name in _OF_THE_STOP if not math.isfinite(getattr(measures, name)))
    for number, wheelset in enumerate(wheelsets, start=1):
        broken = (name for name in _OF_WHEELSETS if not math.isfinite(getattr(wheelset, name)))
        yield from (f"{name}_{number}" for name in broken)


def _reason(measures: StopMeasures, broken: list[str]) -> str:
    if broken == ["air_residual"] and measures.air_consumed == 0.0:
        return (
            f"the stop ended after {measures.end_time:.3g} s, before the brake took any air, so that the air"
            " balance has no value; brake from a higher speed or with a shorter dead time"
        )
    named = ", ".join(broken[:3]) + (", ..." if len(broken) > 3 else "")
    return f"the simulation gives no finite {named}: the numbers of the scenario do not fit together"

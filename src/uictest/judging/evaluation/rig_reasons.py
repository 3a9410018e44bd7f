"""Why a check of the rig fails, in words that name the part of the rig."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from uictest.controllers import ResponseTimes
from uictest.core.units import value_text
from uictest.judging.evaluation.verdict import Verdict
from uictest.plans import scenario

_SATURATIONS: Final = ("loadcell_saturation", "pressure_saturation")


def why_rig_fails(
    criterion: scenario.Criterion, resolved: scenario.Scenario, measures: Any, wheelsets: Sequence[Any]
) -> str:
    """Return which sensors are limited, or what the compensation was not identified for; else nothing."""
    if criterion.measure == "compensation_misfit":
        misfits = scenario.misfits(resolved)
        return "; ".join((*map(str, misfits), scenario.FIT_HINT)) if misfits else ""
    if criterion.measure not in _SATURATIONS:
        return ""
    limited = list(_limited(criterion.measure, resolved, measures, wheelsets))
    other = next(each for each in _SATURATIONS if each != criterion.measure)
    both = any(_limited(other, resolved, measures, wheelsets))
    first = "the first of any kind" if both else "the first"
    return f"{'; '.join(limited)}; {first} by {value_text(float(measures.saturation_time), 's')}"


def _limited(
    measure: str, resolved: scenario.Scenario, measures: Any, wheelsets: Sequence[Any]
) -> Iterator[str]:
    sensors = resolved.rig.sensors
    of_force = measure == "loadcell_saturation"
    what, reach = (
        ("loadcells", sensors.loadcell.range) if of_force else ("pressure sensor", sensors.pressure.range)
    )
    times = {f"wheelset {n}": float(getattr(each, measure)) for n, each in enumerate(wheelsets, start=1)}
    if not of_force:
        times["the brake line"] = float(measures.line_saturation)
    for place, time in times.items():
        if time > 0.0:
            yield f"{what} of {place} limited to {reach.text} for {value_text(time, 's')}"


CRITERION: Final = "real-time"
"""Id of the verdict on a missed deadline."""


def missed_deadlines(times: ResponseTimes | None) -> Iterator[Verdict]:
    """Yield the verdict that a stop with missed deadlines is invalid; nothing where there are none."""
    if times is not None and times.missed_deadlines > 0:
        missed = float(times.missed_deadlines)
        yield Verdict(
            id=CRITERION,
            layer="rig",
            value=missed,
            unit="1",
            lower=None,
            upper=0.0,
            margin=-missed,
            status="fail",
            reason=_reason(times),
        )


def _reason(times: ResponseTimes) -> str:
    return (
        f"{times.missed_deadlines} of {times.answers} answers came after the end of their cycle of"
        f" {1e3 * times.cycle_time_s:g} ms; the longest took {1e3 * times.longest_answer_s:.3g} ms"
        f" (cycle {times.longest_answer_cycle})"
    )

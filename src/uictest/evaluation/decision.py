"""One criterion decided for one choice of its definitions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uictest.evaluation.bounds import Bounds, deciding
from uictest.evaluation.measured import read
from uictest.evaluation.reading import Reading
from uictest.evaluation.records import StopMeasures, Wheelsets
from uictest.evaluation.units import in_unit, text, tidy, with_unit
from uictest.evaluation.verdict import Judgement

if TYPE_CHECKING:
    from uictest.scenario.parts.criteria import Criterion


@dataclass(frozen=True, slots=True)
class Decision:
    """A verdict with the value that decided it (in the measure's unit; None where there is none) and why.

    `side` is -1, 0 or 1: below, between or above the bounds.
    """

    verdict: Judgement
    value: float | None
    reason: str
    side: int = 0


def decide(
    criterion: Criterion, definition: Mapping[str, float], measures: StopMeasures, wheelsets: Wheelsets
) -> Decision:
    """Decide a criterion that applies, with its definitions set to `definition` (SI)."""
    bounds, unit = bounds_of(criterion), criterion.unit
    reading = read(criterion.measure, measures, wheelsets, definition)
    values = [in_unit(number, unit) for number in reading.values]
    if reading.missing:
        return _without_full_value(reading, values, bounds, unit)
    needed = criterion.wheelsets_needed(len(values))
    if not 1 <= needed <= len(values):
        return Decision("not_applicable", None, f"the record holds {len(values)} wheelsets")
    value = deciding(values, bounds, needed)
    reason = reading.remark or _why(values, value, bounds, needed, unit)
    if math.isnan(value):
        return Decision("fail", None, reason)
    return Decision("pass" if bounds.hold(value) else "fail", value, reason, bounds.side(value))


def bounds_of(criterion: Criterion) -> Bounds:
    """Return the bounds of a criterion in the unit of its measure."""
    lower, upper = (
        None if bound is None else tidy(in_unit(bound, criterion.unit))
        for bound in (criterion.lower, criterion.upper)
    )
    return Bounds(lower, upper, criterion.strict)


def _without_full_value(reading: Reading, values: list[float], bounds: Bounds, unit: str) -> Decision:
    # What is still growing and already beyond the upper bound has failed, whatever it would have become.
    if reading.at_least and bounds.side(values[0]) > 0:
        return Decision("fail", values[0], f"{text(values[0], unit)} so far, {reading.missing}", 1)
    return Decision("not_applicable", None, reading.missing)


def _why(values: list[float], value: float, bounds: Bounds, needed: int, unit: str) -> str:
    demand = with_unit(str(bounds), unit)
    if len(values) == 1:
        return "" if bounds.hold(value) else _broken(value, bounds, demand, unit)
    kept = sum(bounds.hold(each) for each in values)
    listed = with_unit(", ".join(text(each, "1") for each in values), unit)
    return f"{kept} of {len(values)} wheelsets keep {demand}, {needed} needed: {listed}"


def _broken(value: float, bounds: Bounds, demand: str, unit: str) -> str:
    if not math.isfinite(value):
        return f"{value} never keeps {demand}"
    return f"{text(value, unit)} misses {demand} by {text(-bounds.margin(value), unit)}"

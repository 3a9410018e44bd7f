"""One criterion decided for one choice of its definitions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from uictest import scenario
from uictest.evaluation.bounds import Bounds, deciding
from uictest.evaluation.coverage import MissingData, ObservedStop
from uictest.evaluation.verdict import Status
from uictest.measures import MEASURES, Course
from uictest.units import in_unit, to_12_digits, value_text, with_unit


@dataclass(frozen=True, slots=True)
class Decision:
    """A status with the value that decided it (in the measure's unit; None where there is none) and why.

    `side` is -1, 0 or 1: below, between or above the bounds.
    """

    status: Status
    value: float | None
    reason: str
    side: int = 0


def decide(
    criterion: scenario.Criterion, bounds: Bounds, definition: Mapping[str, float], stop: ObservedStop
) -> Decision:
    """Decide a criterion that applies and has these `bounds`, with its definitions set to `definition` (SI).

    Where data are missing, each value is known to lie in an interval: from the value so far upwards for a
    measure that can only grow, downwards for one that can only fall, anywhere without data that bound it. The
    criterion passes or fails only if it does so wherever in their intervals the values lie.
    """
    unit, course = criterion.unit, criterion.course
    observed = MEASURES[criterion.measure].read(stop.measures, stop.wheelsets, definition)
    values = [in_unit(number, unit) for number in observed.values]
    settled = course == "settles" and not observed.unavailable_reason
    missing = stop.missing(criterion.measure, len(values) or 1, settled=settled)
    if observed.unavailable_reason:
        return _without_value(observed.unavailable_reason, missing)
    needed = criterion.wheelsets_needed(len(values))
    if not 1 <= needed <= len(values):
        return Decision("inconclusive", None, f"the record holds {len(values)} wheelsets")
    if missing:
        return _of_intervals(values, missing, course, bounds, needed, unit)
    value = deciding(values, bounds, needed)
    return _decided(
        "pass" if bounds.hold(value) else "fail", value, bounds, _why(values, value, bounds, needed, unit)
    )


def bounds_of(criterion: scenario.Criterion) -> Bounds:
    """Return the bounds of a criterion in the unit of its measure."""
    lower, upper = (
        None if bound is None else to_12_digits(in_unit(bound, criterion.unit))
        for bound in (criterion.lower, criterion.upper)
    )
    return Bounds(lower, upper, criterion.strict)


def _decided(status: Status, value: float, bounds: Bounds, reason: str) -> Decision:
    if math.isnan(value):
        return Decision(status, None, reason)
    return Decision(status, value, reason, bounds.side(value))


def _without_value(why: str, missing: Sequence[MissingData | None]) -> Decision:
    lacking = [gap for gap in missing if gap]
    if not lacking:
        return Decision("not_applicable", None, why)
    bounded = all(gap.bounded for gap in lacking)
    return Decision("inconclusive", None, "; ".join([*([why] if bounded else []), _listed(lacking)]))


def _of_intervals(
    values: Sequence[float],
    missing: Sequence[MissingData | None],
    course: Course,
    bounds: Bounds,
    needed: int,
    unit: str,
) -> Decision:
    holds = [_holds(value, gap, course, bounds) for value, gap in zip(values, missing, strict=True)]
    keeping = [value for value, held in zip(values, holds, strict=True) if held]
    breaking = [value for value, held in zip(values, holds, strict=True) if held is False]
    possible = len(values) - len(breaking)
    wheelsets, demand = f"of {len(values)} wheelsets", with_unit(str(bounds), unit)
    status: Status = "inconclusive"
    value, count = math.nan, f"{needed} {wheelsets} must keep {demand}"
    if len(keeping) >= needed:
        status, value = "pass", deciding(keeping, bounds, needed)
        count = f"{len(keeping)} {wheelsets} keep {demand}, {needed} needed"
    elif possible < needed:
        status, value = "fail", deciding(breaking, bounds, needed - possible)
        count = f"{len(breaking)} {wheelsets} miss {demand}, {needed} must keep it"
    shown = [
        value_text(value, "1") if _known(value, gap) else "-"
        for value, gap in zip(values, missing, strict=True)
    ]
    reasons = _listed([gap for gap in missing if gap])
    if set(shown) == {"-"}:
        return _decided(status, value, bounds, reasons)
    so_far = f"{with_unit(', '.join(shown), unit)} so far; {reasons}"
    return _decided(status, value, bounds, so_far if len(values) == 1 else f"{count}: {so_far}")


def _known(value: float, gap: MissingData | None) -> bool:
    return gap is None or (gap.bounded and not math.isnan(value))


def _holds(value: float, gap: MissingData | None, course: Course, bounds: Bounds) -> bool | None:
    """Return whether a value keeps the bounds whatever the missing data are; None: it depends on them."""
    if gap is None:
        return bounds.hold(value)
    known = _known(value, gap)
    lowest = value if known and course == "grows" else -math.inf
    highest = value if known and course == "falls" else math.inf
    return bounds.hold_throughout(lowest, highest)


def _listed(missing: Sequence[MissingData]) -> str:
    return "; ".join(dict.fromkeys(gap.reason for gap in missing))


def _why(values: list[float], value: float, bounds: Bounds, needed: int, unit: str) -> str:
    demand = with_unit(str(bounds), unit)
    if len(values) == 1:
        return "" if bounds.hold(value) else _broken(value, bounds, demand, unit)
    kept = sum(bounds.hold(each) for each in values)
    listed = with_unit(", ".join(value_text(each, "1") for each in values), unit)
    return f"{kept} of {len(values)} wheelsets keep {demand}, {needed} needed: {listed}"


def _broken(value: float, bounds: Bounds, demand: str, unit: str) -> str:
    if not math.isfinite(value):
        return f"{value} never keeps {demand}"
    return f"{value_text(value, unit)} misses {demand} by {value_text(-bounds.margin(value), unit)}"

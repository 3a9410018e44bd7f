"""One criterion decided for one choice of its definitions, and where another one would flip the verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby, pairwise
from typing import NamedTuple

from uictest.core.measures import MEASURES, Course
from uictest.core.units import in_unit, value_text, with_unit
from uictest.judging.evaluation.bounds import Bounds, MissingData, ObservedStop, deciding
from uictest.judging.evaluation.verdict import Sensitivity, Status, VerdictInterval
from uictest.plans import scenario

RESOLUTION = 1e-7
"""In the unit of the definition: how closely a flip is located."""


class Decision(NamedTuple):
    """A status with the value that decided it (in the measure's unit; None where there is none) and why.

    `side` is -1, 0 or 1: below, between or above the bounds. `missed_by` holds the wheelsets, from 1, whose
    values are known to miss them.
    """

    status: Status
    value: float | None
    reason: str
    side: int = 0
    missed_by: tuple[int, ...] = ()


def decide(
    criterion: scenario.Criterion, bounds: Bounds, definition: Mapping[str, float], stop: ObservedStop
) -> Decision:
    """Decide a criterion that applies and has these `bounds`, with its definitions set to `definition` (SI).

    Where data are missing, each value is known to lie in an interval: from the value so far upwards for a
    measure that can only grow, downwards for one that can only fall, anywhere without data that bound it. The
    criterion passes or fails only if it does so wherever in their intervals the values lie.
    """
    unit, course = criterion.unit, criterion.course
    read_by = stop.definition(criterion, definition)
    observed = MEASURES[criterion.measure].read(stop.measures, stop.wheelsets, read_by)
    values = [in_unit(number, unit) for number in observed.values]
    settled = course == "settles" and not observed.unavailable_reason
    missing = stop.missing(criterion.measure, len(values) or 1, settled=settled)
    if observed.open_reason and not missing:
        missing = (MissingData(observed.open_reason),) * len(values)
    if observed.unavailable_reason:
        starts_late = stop.coverage is not None and stop.coverage.no_initial_speed
        final = observed.whatever_follows and not starts_late
        if stop.no_stopping and criterion.layer == "validity":
            # Nothing shows that the stop is a test: what would have shown it may lie behind its end.
            missing = missing or (MissingData(stop.no_stopping),)
        return _without_value(observed.unavailable_reason, () if final else missing)
    needed = criterion.wheelsets_needed(len(values))
    if not 1 <= needed <= len(values):
        return Decision("inconclusive", None, f"the record holds {len(values)} wheelsets")
    where = criterion.speed_range(definition)
    if missing:
        return _PartlyKnown(values, missing, course, bounds, needed, unit, where).decision()
    value = deciding(values, bounds, needed)
    status: Status = "pass" if bounds.hold(value) else "fail"
    decision = _decided(status, value, bounds, _why_decided(values, value, bounds, needed, unit, where))
    return decision._replace(missed_by=_missed_by(map(bounds.hold, values)) if len(values) > 1 else ())


class _PartlyKnown(NamedTuple):
    """Values of a measure, in `unit`, some of which lack data; `needed` of them must keep the bounds.

    `where` says at which train speeds the measure looks.
    """

    values: Sequence[float]
    missing: Sequence[MissingData | None]
    course: Course
    bounds: Bounds
    needed: int
    unit: str
    where: str = ""

    def decision(self) -> Decision:
        """Return the decision that holds wherever the values lie; inconclusive where there is none."""
        holds = list(map(self._holds, self.values, self.missing))
        keeping = [value for value, held in zip(self.values, holds, strict=True) if held]
        breaking = [value for value, held in zip(self.values, holds, strict=True) if held is False]
        possible = len(self.values) - len(breaking)
        of_wheelsets, demand = f"of {len(self.values)} wheelsets", self.bounds.demand(self.unit)
        if len(keeping) >= self.needed:
            count = f"{len(keeping)} {of_wheelsets} {demand} ({self.needed} needed)"
            return self._decided("pass", deciding(keeping, self.bounds, self.needed), count)
        if possible < self.needed:
            count = f"{len(breaking)} {of_wheelsets} not {demand} ({self.needed} needed)"
            decision = self._decided("fail", deciding(breaking, self.bounds, self.needed - possible), count)
            return decision._replace(missed_by=_missed_by(holds) if len(self.values) > 1 else ())
        return self._decided("inconclusive", math.nan, f"{self.needed} {of_wheelsets} must be {demand}")

    def _holds(self, value: float, gap: MissingData | None) -> bool | None:
        """Return whether a value keeps the bounds whatever the missing data are; None: it depends on them."""
        if gap is None:
            return self.bounds.hold(value)
        known = _known(value, gap)
        lowest = value if known and self.course == "grows" else -math.inf
        highest = value if known and self.course == "falls" else math.inf
        return self.bounds.hold_throughout(lowest, highest)

    def _decided(self, status: Status, value: float, count: str) -> Decision:
        texts = [
            value_text(value, "1") if _known(value, gap) else "-"
            for value, gap in zip(self.values, self.missing, strict=True)
        ]
        reasons = _listed([gap for gap in self.missing if gap])
        if set(texts) == {"-"}:
            return _decided(status, value, self.bounds, reasons)
        so_far = f"{_looking(with_unit(', '.join(texts), self.unit), self.where)} so far; {reasons}"
        reason = so_far if len(self.values) == 1 else f"{count}: {so_far}"
        return _decided(status, value, self.bounds, reason)


def _missed_by(holds: Iterable[bool | None]) -> tuple[int, ...]:
    return tuple(n for n, held in enumerate(holds, start=1) if held is False)


def _decided(status: Status, value: float, bounds: Bounds, reason: str) -> Decision:
    if math.isnan(value):
        return Decision(status, None, reason)
    return Decision(status, value, reason, bounds.side(value))


def _without_value(why: str, missing: Sequence[MissingData | None]) -> Decision:
    gaps = [gap for gap in missing if gap]
    if not gaps:
        return Decision("not_applicable", None, why)
    bounded = all(gap.bounded for gap in gaps)
    return Decision("inconclusive", None, "; ".join([*([why] if bounded else []), _listed(gaps)]))


def _known(value: float, gap: MissingData | None) -> bool:
    return gap is None or (gap.bounded and not math.isnan(value))


def _listed(missing: Sequence[MissingData]) -> str:
    return "; ".join(dict.fromkeys(gap.reason for gap in missing))


def _why_decided(
    values: Sequence[float], value: float, bounds: Bounds, needed: int, unit: str, where: str = ""
) -> str:
    """Return why known values, in `unit`, keep or miss their bounds.

    `value` is the one that decides, `where` says at which train speeds its measure looks.
    """
    if len(values) > 1:
        kept = sum(map(bounds.hold, values))
        listed = _looking(with_unit(", ".join(value_text(number, "1") for number in values), unit), where)
        return f"{kept} of {len(values)} wheelsets {bounds.demand(unit)} ({needed} needed): {listed}"
    holds = bounds.hold(value)
    if holds and not where:
        return ""
    demand = with_unit(str(bounds), unit)
    if not holds:
        return _missed(value, bounds, demand, unit, where)
    margin = value_text(bounds.margin(value), unit)
    return f"{_looking(value_text(value, unit), where)} keeps {demand} by {margin}"


def _looking(text: str, where: str) -> str:
    return f"{text} ({where})" if where else text


def _missed(value: float, bounds: Bounds, demand: str, unit: str, where: str) -> str:
    if not math.isfinite(value):
        return f"{value} never keeps {demand}"
    short = value_text(-bounds.margin(value), unit)
    return f"{_looking(value_text(value, unit), where)} misses {demand} by {short}"


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

"""One criterion decided on what is known of a stop, and where another definition would flip the verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from typing import NamedTuple

from uictest.core.measures import MEASURES, Course, Measure, StopMeasures, Wheelsets
from uictest.core.units import all_in_unit, as_written, in_unit, value_text, values_text, with_unit
from uictest.judging.evaluation.verdict import Sensitivity, Status, VerdictInterval
from uictest.plans import scenario


class Bounds(NamedTuple):
    """Bounds of a value, in `unit`; None: no bound. `strict`: a value at the bound does not pass."""

    lower: float | None
    upper: float | None
    strict: bool = False
    unit: str = "1"

    def margin(self, value: float) -> float:
        """Return the distance to the nearest bound, positive inside, negative outside; NaN for NaN."""
        if math.isnan(value):
            return math.nan
        lower = -math.inf if self.lower is None else self.lower
        upper = math.inf if self.upper is None else self.upper
        return min(value - lower, upper - value)

    def hold(self, value: float) -> bool:
        """Return whether a value keeps its bounds. NaN and infinity never do."""
        return math.isfinite(value) and self._above(value) and self._below(value)

    def hold_throughout(self, low: float, high: float) -> bool | None:
        """Return whether a value that lies somewhere from `low` to `high` keeps the bounds; None: open."""
        if self._above(low) and self._below(high):
            return True
        return None if self._above(high) and self._below(low) else False

    def side(self, value: float) -> int:
        """Return -1 below the lower bound, 1 above the upper one, 0 between."""
        below = self.lower is not None and value < self.lower
        above = self.upper is not None and value > self.upper
        return int(above) - int(below)

    def _above(self, value: float) -> bool:
        return self.lower is None or (value > self.lower if self.strict else value >= self.lower)

    def _below(self, value: float) -> bool:
        return self.upper is None or (value < self.upper if self.strict else value <= self.upper)

    @property
    def demand(self) -> str:
        """Where a value must lie, for a reader: "within the limit of 1 s", "above 35 %"."""
        if self.lower is not None and self.upper is not None:
            return f"within the limits of {self.text}"
        end = next(end for end in (self.lower, self.upper, math.nan) if end is not None)
        bound = value_text(end, self.unit)
        if self.strict:
            return f"{'below' if self.lower is None else 'above'} {bound}"
        return f"within the limit of {bound}" if self.lower is None else f"at or above {bound}"

    @property
    def text(self) -> str:
        """The bounds with their unit: ">= 35 %"."""
        return with_unit(str(self), self.unit)

    def __str__(self) -> str:
        """Return the bounds for a reader: ">= 35", "< 0.08", "440 .. 490"."""
        equal = "" if self.strict else "="
        if self.lower is None:
            return f"<{equal} {self.upper:.4g}"
        if self.upper is None:
            return f">{equal} {self.lower:.4g}"
        return f"{self.lower:.4g} .. {self.upper:.4g}"


def bounds_of(criterion: scenario.Criterion) -> Bounds:
    """Return the bounds of a criterion in the unit of its measure."""
    unit = criterion.unit
    lower, upper = (
        None if bound is None else as_written(bound, unit) for bound in (criterion.lower, criterion.upper)
    )
    return Bounds(lower, upper, criterion.strict, unit)


def deciding(values: Sequence[float], bounds: Bounds, needed: int) -> float:
    """Return the value that decides whether at least `needed` of the values keep the bounds.

    That is the one with the `needed`-th largest margin: it keeps the bounds if and only if `needed` do. NaN
    and infinity count as the worst of all.
    """
    if len(values) == 1:
        return values[0]

    def merit(value: float) -> float:
        return bounds.margin(value) if math.isfinite(value) else -math.inf

    return sorted(values, key=merit, reverse=True)[needed - 1]


class MissingData(NamedTuple):
    """What a value of a measure lacks, in words.

    `bounded`: the data that there are bound the value, as part of a stop does; otherwise it may be anything.
    """

    reason: str
    bounded: bool = True

    def and_also(self, reason: str) -> MissingData:
        """Return this with a second reason; where the value may be anything, the first suffices."""
        return MissingData(f"{self.reason}; {reason}") if self.bounded else self


@dataclass(frozen=True, slots=True)
class Coverage:
    """What the record of a real stop lacks before its end.

    Args:
        missing: measure -> what each of its values lacks (one for the stop, or one per wheelset), None where
            nothing; measures that are known throughout the record are left out.
        no_initial_speed: why the initial speed is not known; empty where it is.
        not_computed: measure -> the channels that it is computed from and that the record does not have.

    """

    missing: Mapping[str, tuple[MissingData | None, ...]]
    no_initial_speed: str = ""
    not_computed: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ObservedStop:
    """The measures of a stop as far as it was observed.

    Args:
        resolved: its scenario.
        measures: measures of the stop.
        wheelsets: measures of its wheelsets.
        coverage: what the record of a real stop lacks; None for a simulation.
        conditions: what criteria may require of it.
        cut_off: why it was not observed to its end; empty where it was.
        no_stopping: why it is not a stop to standstill under the brake alone; empty where it is.

    """

    resolved: scenario.Scenario
    measures: StopMeasures
    wheelsets: Wheelsets
    coverage: Coverage | None = None
    conditions: scenario.TestConditions = field(init=False)
    cut_off: str = field(init=False)
    no_stopping: str = field(init=False)

    def __post_init__(self) -> None:
        for name, value in (
            ("conditions", scenario.test_conditions_of(self.resolved)),
            ("cut_off", _why_cut_off(self.resolved, self.measures, self.coverage)),
            ("no_stopping", _why_no_stopping(self.resolved)),
        ):
            object.__setattr__(self, name, value)

    def definition(self, criterion: scenario.Criterion, stated: Mapping[str, float]) -> Mapping[str, float]:
        """Return the definitions and corrections by which the measure of a criterion is read."""
        if not MEASURES[criterion.measure].corrected:
            return stated
        conditions = scenario.corrections(self.resolved, criterion)
        return {**stated, **{name: float(value) for name, value in conditions.items()}}

    def missing(self, measure: str, count: int, *, settled: bool) -> tuple[MissingData | None, ...]:
        """Return the missing data of each of the `count` values of a measure; empty where none lacks any.

        To a value that is `settled` the end of the observation does not matter.
        """
        gaps = self.coverage.missing.get(measure, ()) if self.coverage else ()
        if settled or not self.cut_off:
            return gaps
        end = MissingData(self.cut_off)
        return tuple(gap.and_also(self.cut_off) if gap else end for gap in gaps or (None,) * count)


def _why_no_stopping(resolved: scenario.Scenario) -> str:
    drag = resolved.drag
    if drag is not None:
        return f"drag braking: traction holds {drag.speed.text} for {drag.duration.text}"
    return "" if resolved.until is None else f"the stop ends at {resolved.until.text}, above standstill"


def _why_cut_off(resolved: scenario.Scenario, measures: StopMeasures, coverage: Coverage | None) -> str:
    if coverage is None and resolved.drag is not None and measures.held_time < 0.99 * resolved.drag.duration:
        held = value_text(measures.held_time, "s")
        return f"traction held {resolved.drag.speed.text} for {held} of {resolved.drag.duration.text}"
    if measures.stopped or (resolved.until is not None and measures.end_speed <= resolved.until):
        return ""
    speed = "an unknown speed"
    if not math.isnan(measures.end_speed):
        speed = value_text(in_unit(measures.end_speed, "km/h"), "km/h")
    if coverage is not None:
        return f"the record ends after {value_text(measures.end_time, 's')} with the train at {speed}"
    limit = resolved.simulation.maximum_duration.text
    return f"the simulation ended after {limit} at {speed}; raise `simulation.maximum_duration`"


RESOLUTION = 1e-7
"""In the unit of the definition: how closely a flip is located."""


class Decision(NamedTuple):
    """A status with the value that decided it (in the measure's unit; None where there is none) and why.

    `side` is -1, 0 or 1: below, between or above the bounds. `missed_by` holds the wheelsets, from 1, whose
    values are known to miss them. `lacks_data` as in a verdict.
    """

    status: Status
    value: float | None
    reason: str
    side: int = 0
    missed_by: tuple[int, ...] = ()
    lacks_data: bool = False


def decide(
    criterion: scenario.Criterion,
    bounds: Bounds,
    definition: Mapping[str, float],
    stop: ObservedStop,
    *,
    explained: bool = True,
) -> Decision:
    """Decide a criterion that applies and has these `bounds`, with its definitions set to `definition` (SI).

    Without `explained`, a decision on values that are known comes without its reason.

    Where data are missing, each value is known to lie in an interval: from the value so far upwards for a
    measure that can only grow, downwards for one that can only fall, anywhere without data that bound it. The
    criterion passes or fails only if it does so wherever in their intervals the values lie.
    """
    measure = MEASURES[criterion.measure]
    observed = measure.read(stop.measures, stop.wheelsets, stop.definition(criterion, definition))
    values = all_in_unit(observed.values, measure.unit)
    settled = measure.course == "settles" and not observed.unavailable_reason
    missing = stop.missing(criterion.measure, len(values) or 1, settled=settled)
    if observed.open_reason and not missing:
        missing = (MissingData(observed.open_reason),) * len(values)
    if observed.unavailable_reason:
        starts_late = stop.coverage is not None and stop.coverage.no_initial_speed
        final = observed.whatever_follows and not starts_late
        if stop.no_stopping and criterion.layer == "validity":
            # Nothing shows that the stop is a test: what would have shown it may lie after its end.
            missing = missing or (MissingData(stop.no_stopping),)
        gaps = [] if final else [gap for gap in missing if gap]
        return _without_value(measure, observed.unavailable_reason, gaps)
    needed = 1 if criterion.wheelsets is None else criterion.wheelsets_needed(len(values))
    if not 1 <= needed <= len(values):
        return Decision("inconclusive", None, f"the record holds {len(values)} wheelsets")
    where = measure.speed_range(definition) if measure.speed_range and explained else ""
    if missing:
        return _PartlyKnown(values, missing, measure.course, bounds, needed, where).decision()
    value = deciding(values, bounds, needed)
    reason = _why_decided(values, value, bounds, needed, where) if explained else ""
    decision = _decided("pass" if bounds.hold(value) else "fail", value, bounds, reason)
    return decision._replace(missed_by=_missed_by(map(bounds.hold, values)) if len(values) > 1 else ())


class _PartlyKnown(NamedTuple):
    """Values of a measure, some of which lack data; `needed` of them must keep the bounds.

    `where` says at which train speeds the measure looks.
    """

    values: Sequence[float]
    missing: Sequence[MissingData | None]
    course: Course
    bounds: Bounds
    needed: int
    where: str = ""

    def decision(self) -> Decision:
        """Return the decision that holds wherever the values lie; inconclusive where there is none."""
        holds = list(map(self._holds, self.values, self.missing))
        keeping = [value for value, held in zip(self.values, holds, strict=True) if held]
        breaking = [value for value, held in zip(self.values, holds, strict=True) if held is False]
        possible = len(self.values) - len(breaking)
        of_wheelsets, demand = f"of {len(self.values)} wheelsets", self.bounds.demand
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
        is_known = _is_known(value, gap)
        lowest = value if is_known and self.course == "grows" else -math.inf
        highest = value if is_known and self.course == "falls" else math.inf
        return self.bounds.hold_throughout(lowest, highest)

    def _decided(self, status: Status, value: float, count: str) -> Decision:
        texts = [
            value_text(value, "1") if _is_known(value, gap) else "-"
            for value, gap in zip(self.values, self.missing, strict=True)
        ]
        reasons = _listed_reasons([gap for gap in self.missing if gap])
        if set(texts) == {"-"}:
            return _decided(status, value, self.bounds, reasons)
        so_far = (
            f"{_with_location(with_unit(', '.join(texts), self.bounds.unit), self.where)} so far; {reasons}"
        )
        reason = so_far if len(self.values) == 1 else f"{count}: {so_far}"
        return _decided(status, value, self.bounds, reason)


def _missed_by(holds: Iterable[bool | None]) -> tuple[int, ...]:
    return tuple(n for n, held in enumerate(holds, start=1) if held is False)


def _decided(status: Status, value: float, bounds: Bounds, reason: str) -> Decision:
    if math.isnan(value):
        return Decision(status, None, reason)
    return Decision(status, value, reason, bounds.side(value))


def _without_value(measure: Measure, why: str, gaps: Sequence[MissingData]) -> Decision:
    if not gaps:
        # It is computed from what no record has, and from which this stop gives nothing either.
        recorded = measure.recorded
        lacks_data = recorded is not None and recorded.computed and recorded.when == "never"
        return Decision("not_applicable", None, why, lacks_data=lacks_data)
    bounded = all(gap.bounded for gap in gaps)
    return Decision("inconclusive", None, "; ".join([*([why] if bounded else []), _listed_reasons(gaps)]))


def _is_known(value: float, gap: MissingData | None) -> bool:
    return gap is None or (gap.bounded and not math.isnan(value))


def _listed_reasons(missing: Sequence[MissingData]) -> str:
    return "; ".join(dict.fromkeys(gap.reason for gap in missing))


def _why_decided(values: Sequence[float], value: float, bounds: Bounds, needed: int, where: str) -> str:
    """Return the reason for which known values keep or miss their bounds.

    `value` is the one that decides, `where` says at which train speeds its measure looks.
    """
    if len(values) > 1:
        holding = sum(map(bounds.hold, values))
        listed = _with_location(values_text(values, bounds.unit), where)
        return f"{holding} of {len(values)} wheelsets {bounds.demand} ({needed} needed): {listed}"
    holds, unit = bounds.hold(value), bounds.unit
    if holds and not where:
        return ""
    if not math.isfinite(value):
        return f"{value} never keeps {bounds.text}"
    verb, margin = ("keeps" if holds else "misses"), value_text(abs(bounds.margin(value)), unit)
    return f"{_with_location(value_text(value, unit), where)} {verb} {bounds.text} by {margin}"


def _with_location(text: str, where: str) -> str:
    return f"{text} ({where})" if where else text


Decide = Callable[[float], Decision]


def sensitivity(
    name: str, unit: str, lower: float, upper: float, step: float | None, decide: Decide
) -> Sensitivity:
    """Return the intervals of the verdict while the definition `name` runs from `lower` to `upper` (SI).

    `decide` gives the decision at a value of the definition. With a `step` the definition takes multiples of
    it only, and all of them in the range are decided. Without one it is continuous, what it defines is
    monotonic between whole seconds, and each flip is located by halving.
    """
    if step:
        multiples = range(round(lower / step), round(upper / step) + 1)
        decided = [(multiple * step, decide(multiple * step)) for multiple in multiples]
    else:
        whole = map(float, range(math.floor(lower) + 1, math.ceil(upper)))
        points = [lower, *whole, upper] if upper > lower else [lower]
        at_points = [(point, decide(point)) for point in points]
        decided = at_points[:1]
        for before, after in pairwise(at_points):
            decided += [*_flips_between(before, after, decide), after]
    first, last, *values = all_in_unit([lower, upper, *(point for point, _ in decided)], unit)
    intervals = []
    statuses = zip(values, [decision.status for _, decision in decided], strict=True)
    for status, alike in groupby(statuses, key=lambda pair: pair[1]):
        ends = [value for value, _ in alike]
        intervals.append(VerdictInterval(round(ends[0], 6), round(ends[-1], 6), status))
    return Sensitivity(name, unit, round(first, 6), round(last, 6), tuple(intervals))


def _flips_between(
    before: tuple[float, Decision], after: tuple[float, Decision], decide: Decide
) -> list[tuple[float, Decision]]:
    # Two bounds may both be crossed between two points, so that the middle differs from both ends: halving
    # goes on in every half whose ends differ.
    same = (before[1].status, before[1].side) == (after[1].status, after[1].side)
    if same or after[0] - before[0] < RESOLUTION:
        return []
    point = 0.5 * (before[0] + after[0])
    middle = (point, decide(point))
    return [*_flips_between(before, middle, decide), middle, *_flips_between(middle, after, decide)]

"""The bounds of a criterion, values against them, and the observed part of a stop."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from uictest.core.identity_cache import once_per_object
from uictest.core.measures import StopMeasures, Wheelsets
from uictest.core.units import in_unit, to_12_digits, value_text, with_unit
from uictest.plans import scenario


class Bounds(NamedTuple):
    """Bounds of a value, in its unit; None: no bound. `strict`: a value at the bound does not pass."""

    lower: float | None
    upper: float | None
    strict: bool = False

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

    def demand(self, unit: str) -> str:
        """Return where a value must lie, for a reader: "within the limit of 1 s", "above 35 %"."""
        if self.lower is not None and self.upper is not None:
            return f"within the limits of {with_unit(str(self), unit)}"
        bound = value_text(_or(self.lower, _or(self.upper, math.nan)), unit)
        if self.strict:
            return f"{'below' if self.lower is None else 'above'} {bound}"
        return f"within the limit of {bound}" if self.lower is None else f"at or above {bound}"

    def __str__(self) -> str:
        """Return the bounds for a reader: ">= 35", "< 0.08", "440 .. 490"."""
        equal = "" if self.strict else "="
        if self.lower is None:
            return f"<{equal} {self.upper:.4g}"
        if self.upper is None:
            return f">{equal} {self.lower:.4g}"
        return f"{self.lower:.4g} .. {self.upper:.4g}"


@once_per_object
def bounds_of(criterion: scenario.Criterion) -> Bounds:
    """Return the bounds of a criterion in the unit of its measure."""
    lower, upper = (
        None if bound is None else to_12_digits(in_unit(bound, criterion.unit))
        for bound in (criterion.lower, criterion.upper)
    )
    return Bounds(lower, upper, criterion.strict)


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


def _or(bound: float | None, otherwise: float) -> float:
    return otherwise if bound is None else bound


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


class ObservedStop(NamedTuple):
    """The measures of a stop as far as it was observed.

    `cut_off` says why that was not to its end; empty where it was. `coverage` is None for a simulation.
    `no_stopping` says why it is no stop to standstill under the brake alone; empty where it is. `resolved` is
    the scenario, which states what distances are corrected for.
    """

    measures: StopMeasures
    wheelsets: Wheelsets
    cut_off: str = ""
    coverage: Coverage | None = None
    no_stopping: str = ""
    resolved: scenario.Scenario | None = None

    def definition(self, criterion: scenario.Criterion, stated: Mapping[str, float]) -> Mapping[str, float]:
        """Return what the measure of a criterion is read by: definitions and what it is corrected for."""
        if self.resolved is None or not criterion.corrected:
            return stated
        conditions = scenario.corrections(self.resolved, criterion)
        return {**stated, **{name: float(value) for name, value in conditions.items()}}

    def missing(self, measure: str, count: int, *, settled: bool) -> tuple[MissingData | None, ...]:
        """Return what each of the `count` values of a measure lacks; empty where none lacks anything.

        To a value that is `settled` the end of the observation does not matter.
        """
        gaps = self.coverage.missing.get(measure, ()) if self.coverage else ()
        if settled or not self.cut_off:
            return gaps
        end = MissingData(self.cut_off)
        return tuple(gap.and_also(self.cut_off) if gap else end for gap in gaps or (None,) * count)


def why_no_stopping(resolved: scenario.Scenario) -> str:
    """Return why a stop does not stop a train by its brake alone; empty where it does."""
    drag = resolved.drag
    if drag is not None:
        return f"drag braking: traction holds {drag.speed.text} for {drag.duration.text}"
    return "" if resolved.until is None else f"the stop ends at {resolved.until.text}, above standstill"


def why_cut_off(resolved: scenario.Scenario, measures: StopMeasures, coverage: Coverage | None) -> str:
    """Return why a stop was not observed to its end; empty where it was."""
    if coverage is None and resolved.drag is not None and measures.held_time < 0.99 * resolved.drag.duration:
        held = value_text(measures.held_time, "s")
        return f"traction held {resolved.drag.speed.text} for {held} of {resolved.drag.duration.text}"
    if measures.stopped or (resolved.until is not None and measures.end_speed <= resolved.until):
        return ""
    speed = (
        "an unknown speed"
        if math.isnan(measures.end_speed)
        else value_text(in_unit(measures.end_speed, "km/h"), "km/h")
    )
    if coverage is not None:
        return f"the record ends after {value_text(measures.end_time, 's')} with the train at {speed}"
    limit = resolved.simulation.maximum_duration.text
    return f"the simulation ended after {limit} at {speed}; raise `simulation.maximum_duration`"

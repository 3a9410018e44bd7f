"""Where the value of a criterion was taken: the instant or the interval, the plot, the wheelset."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from uictest.judging import evaluation
from uictest.report.page.stop.mark import vents
from uictest.report.traces.moments import TRAIN, Interval, Moments
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.traces.trace import PlotTrace


@dataclass(frozen=True, slots=True)
class Taken:
    """From `start` to `end`, s since the brake command, in the plot `plot`; one instant where both are equal.

    `wheelset` is the one that decides; None for a measure of the train. `value` is the height of the instant
    in the unit of the plot, None where there is none.
    """

    plot: str
    start: float
    end: float
    wheelset: int | None = None
    value: float | None = None


_SAMPLES = 3.0
"""Intervals of a record by which a duration in it may differ from the one that the rig measured; chosen."""

Finder = Callable[[evaluation.Verdict, PlotTrace], Taken | None]


def taken_at(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
    """Return where the value of a criterion was taken; None where the plots show no such place."""
    find = _FINDERS.get(verdict.measure)
    return find(verdict, trace) if find is not None and verdict.value is not None else None


def _extreme(plot: str) -> Finder:
    """Return what finds the instant of the largest or smallest value."""

    def find(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
        extremes = _moments(verdict, trace).extremes
        if not extremes:
            return None
        n = _nearest(verdict, {n: value for n, (_, value) in extremes.items()})
        time, value = extremes[n]
        return Taken(plot, time, time, None if n == TRAIN else n, value)

    return find


def _all_intervals(plot: str) -> Finder:
    """Return what finds the intervals of the wheelset that decides, from the first to the last."""

    def find(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
        intervals = _moments(verdict, trace).intervals
        if not intervals:
            return None
        n = _nearest(verdict, {n: sum(map(_duration, own)) for n, own in intervals.items()})
        return Taken(plot, intervals[n][0][0], intervals[n][-1][1], n)

    return find


def _longest_interval(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
    longest = {n: max(own, key=_duration) for n, own in _moments(verdict, trace).intervals.items()}
    if not longest:
        return None
    n = _nearest(verdict, {n: _duration(interval) for n, interval in longest.items()})
    return Taken("locked", *longest[n], n)


def _lock_of_sound_wheelset(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
    """Return the lock that lasts as long as the value says: one of a faulty wheelset may last longer."""
    locks = _moments(verdict, trace).intervals.items()
    lasting = [
        Taken("speed", *lock, n)
        for n, own in locks
        for lock in own
        if abs(_duration(lock) - (verdict.value or 0.0)) <= _SAMPLES * trace.interval
    ]
    return lasting[0] if len(lasting) == 1 else None


def _first_phase(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
    duration = verdict.defined("first_phase_duration")
    if trace.sliding_time is None or duration is None:
        return None
    return Taken("deceleration", trace.sliding_time, trace.sliding_time + duration)


def _until(plot: str) -> Finder:
    """Return what finds the time from the brake command until the criterion no longer looks."""

    def find(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
        until = _moments(verdict, trace).until
        return None if until is None else Taken(plot, trace.start, until)

    return find


def _vents(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
    """Return from the first to the last vent of the wheelset that decides."""
    counts = {n: float(len(bars)) for n in WHEELSETS if (bars := vents(trace, n))}
    if not counts:
        return None
    n = _nearest(verdict, counts)
    bars = vents(trace, n)
    return Taken("valves", bars[0][0], bars[-1][1], n)


def _whole(plot: str) -> Finder:
    return lambda verdict, trace: Taken(plot, trace.start, trace.end)


def _end(plot: str) -> Finder:
    return lambda verdict, trace: Taken(plot, trace.end, trace.end)


def _duration(interval: Interval) -> float:
    first, last = interval
    return last - first


def _moments(verdict: evaluation.Verdict, trace: PlotTrace) -> Moments:
    return trace.moments.get(verdict.id, Moments())


def _nearest(verdict: evaluation.Verdict, values: Mapping[int, float]) -> int:
    """Return the wheelset whose value is that of the criterion; both were found in the same samples."""
    wanted = verdict.value or 0.0
    return min(values, key=lambda n: abs(values[n] - wanted))


_FINDERS: Final[Mapping[str, Finder]] = MappingProxyType(
    {
        "braking_distance": _end("speed"),
        "braking_time": _end("speed"),
        "standstill": _end("speed"),
        "mean_deceleration": _whole("deceleration"),
        "initial_adhesion": _first_phase,
        "minimum_deceleration": _extreme("deceleration"),
        "maximum_deceleration": _extreme("deceleration"),
        "reservoir_minimum_pressure": _extreme("pressure"),
        "maximum_slide_above_cutoff": _extreme("slide"),
        "sliding_share": _until("slide"),
        "sliding_share_of_wheelsets": _until("slide"),
        "maximum_clamping_force": _extreme("force"),
        "maximum_disc_temperature": _extreme("temperature"),
        "locked_time": _all_intervals("locked"),
        "longest_lock": _longest_interval,
        "longest_lock_of_sound_wheelsets": _lock_of_sound_wheelset,
        "reference_excess": _extreme("speed"),
        "sliding_duration": _all_intervals("sliding"),
        "valve_actuations": _vents,
        "air_consumed": _end("pressure"),
        "energy_residual": _end("speed"),
        "air_residual": _end("pressure"),
        "air_energy_residual": _end("pressure"),
    }
)
"""Measure -> what finds where its value was taken; the other measures have no place in the plots."""

"""What the plots of one stop are drawn from: a recording in the engineer's units."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core import recording
from uictest.core.units import STANDARD_GRAVITY
from uictest.judging import evaluation
from uictest.report.causes import label_words
from uictest.report.traces.moments import Moments, moments_of
from uictest.report.traces.quantities import (
    OF_RAIL,
    PLOT_QUANTITIES,
    WHEELSETS,
    channel_names,
)
from uictest.report.traces.vent_cycles import VentCycle, vent_cycles

Samples = NDArray[np.float64]
Rows = NDArray[np.intp]


def extremes(columns: Samples, y: Samples) -> Rows:
    """Return the rows that hold the smallest and the largest y of every column, in their order.

    Args:
        columns: the column of each sample, never falling; shape (n,), n > 0.
        y: samples, shape (n,). Of a column with missing samples (NaN) one of these is kept, too: a line
            through the rows has its gap there.

    """
    starts = np.flatnonzero(np.diff(columns, prepend=columns[0] - 1))
    column = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(columns)))
    missing = np.isnan(y)
    gaps = np.flatnonzero(missing)
    kept = [gaps[np.diff(column[gaps], append=len(starts)) > 0]]
    for extreme in (np.fmin, np.fmax):
        own = extreme.reduceat(y, starts)[column]
        rows = np.flatnonzero((y == own) | (missing & np.isnan(own)))
        kept.append(rows[np.diff(column[rows], prepend=-1) > 0])
    return _each_once(kept, len(y))


def _each_once(rows: Sequence[Rows], count: int) -> Rows:
    """Return the rows, out of `count`, in their order; `np.unique` would load masked arrays for it."""
    kept = np.zeros(count, dtype=np.bool_)
    kept[np.concatenate(rows)] = True
    return np.flatnonzero(kept)


def thinned(y: Samples, bins: int) -> Rows:
    """Return the rows of a series to be drawn: both ends, and the extremes of at most `bins` equal parts."""
    parts = np.arange(len(y), dtype=np.float64) // -(-len(y) // bins)
    return _each_once([extremes(parts, y), np.array([0, len(y) - 1])], len(y))


class FaultSpan(NamedTuple):
    """A stretch of a stop in which one fault was active: what it was, first and last time in s."""

    label: str
    start: float
    end: float


def fault_spans(record: recording.Recording) -> tuple[FaultSpan, ...]:
    """Return when each fault was active, as far as the samples tell; none where no faults were recorded."""
    labels = record.metadata.get("faults", "")
    if not labels or "active_faults" not in record.channels:
        return ()
    return tuple(
        span
        for place, label in enumerate(labels.split(", "))
        for span in _spans(record, label_words(label), 1 << place)
    )


def _spans(record: recording.Recording, label: str, bit: int) -> Iterator[FaultSpan]:
    time, active = record["time"], record["active_faults"].astype(np.int64) & bit != 0
    ends = np.flatnonzero(np.diff(active, prepend=False, append=False))
    for first, after in ends.reshape(-1, 2).tolist():
        yield FaultSpan(label, float(time[first]), float(time[min(after, len(time) - 1)]))


MOST_SAMPLES = 20_000
"""A record with more is drawn through the extremes of its channels; 200 s at 100 Hz, chosen."""
BINS = 800
"""Into so many parts such a record is divided: about one per pixel."""

DECELERATION_WINDOW = 0.5
"""s: over how long the deceleration that is drawn is averaged; chosen to show what a passenger feels."""

SLIDE_SPEED = 1.0
"""m/s: at and below it a slide is no number; the rig records 0 there."""

STATES = ("valve_command",)
"""Quantities that hold states: every change of them is drawn, at its time."""

UNKNOWN = -1
"""The state where none was recorded."""

Series = NDArray[np.float64]


class Curve(NamedTuple):
    """The points of a line, as samples: `x` and `y` are equally long; where y is NaN the line has a gap."""

    x: Series
    y: Series


class States(NamedTuple):
    """A channel of states: `state[k]` holds from `time[k]` (s) to `time[k + 1]`, the last to the end."""

    time: Series
    state: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class PlotTrace:
    """What is drawn of one stop.

    Args:
        start, end: first and last time of the record, s since the brake command.
        interval: time between two samples of the record, s.
        curves: name -> line over time (s), in the unit of `quantities.PLOT_QUANTITIES`; wheelsets have
            `_1` .. `_4` at the end. All share one array of times.
        states: name -> states over time.
        derived: names of the curves that the record does not hold.
        moments: id of a criterion -> when it was decided.
        faults: when faults were active.
        vents: every vent, from the samples as they were recorded.
        band: of a repeated case, name -> what its stops span: the lower and the upper edge over time.
        band_stops: how many stops these are.

    """

    start: float
    end: float
    interval: float
    curves: Mapping[str, Curve]
    states: Mapping[str, States] = field(default_factory=dict)
    derived: tuple[str, ...] = ()
    moments: Mapping[str, Moments] = field(default_factory=dict)
    faults: tuple[FaultSpan, ...] = ()
    vents: tuple[VentCycle, ...] = ()
    band: Mapping[str, tuple[Curve, Curve]] = field(default_factory=dict)
    band_stops: int = 0

    def valve_spans(self, n: int, wanted: Sequence[int]) -> list[tuple[float, float]]:
        """Return when (s) the valve of a wheelset is in one of some states; what follows at once is one."""
        states = self.states.get(f"valve_command_{n}")
        if states is None:
            return []
        times = np.append(states.time, self.end)
        ends = np.flatnonzero(np.diff(np.isin(states.state, wanted), prepend=False, append=False))
        return [(float(times[a]), float(times[b])) for a, b in ends.reshape(-1, 2).tolist()]


def trace_of(
    record: recording.Recording,
    verdicts: Iterable[evaluation.Verdict] = (),
    wheelsets: Sequence[Mapping[str, float]] = (),
) -> PlotTrace:
    """Return what is drawn of a stop: every sample, or of many the extremes; every change of a state.

    Args:
        record: samples of the stop, SI.
        verdicts: of the stop; the trace holds when each of them was decided.
        wheelsets: what the result reports of each.

    """
    time = record["time"]
    series = series_in_units(record)
    states = {name for state in STATES for name in channel_names(state)}
    rows = _drawn_rows([samples for name, samples in series.items() if name not in states])
    drawn = time[rows]
    return PlotTrace(
        float(time[0]),
        float(time[-1]),
        recording.mean_interval(time),
        {name: Curve(drawn, samples[rows]) for name, samples in series.items() if name not in states},
        {name: _states(time, samples) for name, samples in series.items() if name in states},
        tuple(name for name in series if name not in record.channels),
        moments_of(verdicts, record, wheelsets),
        fault_spans(record),
        vent_cycles(time, series),
    )


def trace_of_stop(record: recording.Recording, result: evaluation.CaseResult) -> PlotTrace:
    """Return what is drawn of a judged case, whose drawn stop the record holds."""
    stop = result.drawn_stop
    return trace_of(record, stop.criteria, stop.wheelsets)


def series_in_units(record: recording.Recording) -> dict[str, Series]:
    """Return what can be drawn over time, derived series too, in the units of `PLOT_QUANTITIES`."""
    return _in_units(_without_slides_at_rest(dict(record.channels) | _derived(record)))


def deceleration(time: Series, speed: Series) -> Series:
    """Return the deceleration (g) of a train, averaged over a window around each moment.

    `time` is in s and `speed` in m/s. At the ends of the record the window is what is left of it.
    """
    if len(time) < 2:
        return np.zeros_like(time)
    before = np.maximum(time - DECELERATION_WINDOW / 2, time[0])
    after = np.minimum(time + DECELERATION_WINDOW / 2, time[-1])
    change = np.interp(before, time, speed) - np.interp(after, time, speed)
    return np.asarray(change / (after - before) / STANDARD_GRAVITY, dtype=np.float64)


def slide(speed: Series, wheel_speed: Series) -> Series:
    """Return the slide (v - r omega) / v of a wheelset; NaN at and below `SLIDE_SPEED`."""
    runs = speed > SLIDE_SPEED
    with np.errstate(invalid="ignore", over="ignore"):  # a damaged record may hold any number
        return np.where(runs, (speed - wheel_speed) / np.where(runs, speed, 1.0), np.nan)


def _without_slides_at_rest(channels: Mapping[str, Series]) -> dict[str, Series]:
    """Return the channels with NaN for the slides at and below `SLIDE_SPEED`, which a line leaves out."""
    if (speed := channels.get("speed")) is None:
        return dict(channels)
    slides = {name: channels[name] for name in channel_names("slide") if name in channels}
    return dict(channels) | {
        name: np.where(speed <= SLIDE_SPEED, np.nan, samples) for name, samples in slides.items()
    }


def _derived(record: recording.Recording) -> dict[str, Series]:
    """Return what is drawn though the record does not hold it, SI (the deceleration in g)."""
    channels = record.channels
    if "speed" not in channels:
        return {}
    speed = channels["speed"]
    derived = {"deceleration": deceleration(channels["time"], speed)}
    for n in WHEELSETS:
        if f"wheel_speed_{n}" in channels and f"slide_{n}" not in channels:
            derived[f"slide_{n}"] = slide(speed, channels[f"wheel_speed_{n}"])
    return derived


def _in_units(channels: Mapping[str, Series]) -> dict[str, Series]:
    is_cleaned = any(np.any(share > 0.0) for share in _of(channels, "cleaned_share"))
    varies = any(map(_changes, _of(channels, "friction")))
    hidden = () if is_cleaned else OF_RAIL[varies:]
    with np.errstate(over="ignore"):
        return {
            name: (np.asarray(channels[name], dtype=np.float64) - quantity.zero) / quantity.scale
            for key, quantity in PLOT_QUANTITIES.items()
            for name in channel_names(key)
            if name in channels and key not in hidden
        }


def _changes(samples: Series) -> bool:
    known = samples[np.isfinite(samples)]
    return bool(np.any(known != known[:1]))


def _of(channels: Mapping[str, Series], key: str) -> list[Series]:
    return [channels[name] for name in channel_names(key) if name in channels]


def _drawn_rows(signals: Sequence[Series]) -> slice | Rows:
    """Return the rows of which a line shows a point: all, or of a long record those of any extreme."""
    if not signals or len(signals[0]) <= MOST_SAMPLES:
        return slice(None)
    return _each_once([thinned(each, BINS) for each in signals], len(signals[0]))


def _states(time: Series, samples: Series) -> States:
    state = np.where(np.isfinite(samples), np.rint(samples), UNKNOWN).astype(np.int64)
    changes = np.flatnonzero(np.diff(state, prepend=state[0] - 1))
    return States(time[changes], state[changes])

"""What the plots of one stop are drawn from: a recording in the engineer's units."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core import recording
from uictest.core.units import STANDARD_GRAVITY
from uictest.judging import evaluation
from uictest.report.traces.behaviour import NOTHING_KNOWN, WspBehaviour, wsp_behaviour
from uictest.report.traces.moments import Moments, moments_of
from uictest.report.traces.quantities import OF_RAIL, PLOT_QUANTITIES, VENT, WHEELSETS, channel_names
from uictest.report.verdict_sentences import label_words

Series = NDArray[np.float64]
Rows = NDArray[np.intp]

MOST_SAMPLES: Final = 20_000
"""A record with more is drawn through the extremes of its channels; 200 s at 100 Hz, chosen."""
BINS: Final = 800
"""Into so many parts such a record is divided: about one per pixel."""
DECELERATION_WINDOW: Final = 0.5
"""s: over how long the deceleration that is drawn is averaged; chosen to show what a passenger feels."""
SLIDE_SPEED: Final = 1.0
"""m/s: at and below it a slide is not a number; the rig records 0 there."""
_UNKNOWN_STATE: Final = -1
"""The state where none was recorded."""


class Curve(NamedTuple):
    """The points of a line, as samples: `x` and `y` are equally long; where y is NaN the line has a gap."""

    x: Series
    y: Series


class States(NamedTuple):
    """A channel of states: `state[k]` holds from `time[k]` (s) to `time[k + 1]`, the last to the end."""

    time: Series
    state: NDArray[np.int64]


class FaultSpan(NamedTuple):
    """A stretch of a stop in which one fault was active: what it was, first and last time in s."""

    label: str
    start: float
    end: float


class VentCycle(NamedTuple):
    """One vent of a wheelset. What was not recorded, or did not happen, is NaN.

    Args:
        wheelset: its number.
        start: start of the vent, s since the brake command.
        duration: duration of the vent, s.
        slide: at its start, %.
        drop: drop of the pressure from the start of the vent to its lowest value before the next one, bar.
        recovery: from the start of the vent until the slide, after its peak, is no larger than then, s; NaN
            where the next vent comes before.

    """

    wheelset: int
    start: float
    duration: float
    slide: float
    drop: float
    recovery: float


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
        behaviour: what the WSP did.
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
    behaviour: WspBehaviour = NOTHING_KNOWN
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
    """Return the trace of a stop: every sample, or of many the extremes; every change of a state.

    Args:
        record: samples of the stop, SI.
        verdicts: verdicts of the stop; the trace holds when each of them was decided.
        wheelsets: what the result reports of each.

    """
    time = record["time"]
    series = series_in_units(record)
    states = [name for name in channel_names("valve_command") if name in series]
    lines = {name: samples for name, samples in series.items() if name not in states}
    rows: slice | Rows = slice(None)
    if lines and len(time) > MOST_SAMPLES:
        rows = _sorted_rows([thinned(samples, BINS) for samples in lines.values()], len(time))
    drawn = time[rows]
    return PlotTrace(
        float(time[0]),
        float(time[-1]),
        recording.mean_interval(time),
        {name: Curve(drawn, samples[rows]) for name, samples in lines.items()},
        {name: _state_spans(time, series[name]) for name in states},
        tuple(name for name in series if name not in record.channels),
        moments_of(verdicts, record, wheelsets),
        fault_spans(record),
        vent_cycles(time, series),
        wsp_behaviour(record.channels),
    )


def trace_of_stop(record: recording.Recording, result: evaluation.CaseResult) -> PlotTrace:
    """Return the trace of a judged case, whose drawn stop the record holds."""
    stop = result.drawn_stop
    return trace_of(record, stop.criteria, stop.wheelsets)


def _state_spans(time: Series, samples: Series) -> States:
    state = np.where(np.isfinite(samples), np.rint(samples), _UNKNOWN_STATE).astype(np.int64)
    changes = np.flatnonzero(np.diff(state, prepend=state[0] - 1))
    return States(time[changes], state[changes])


def series_in_units(record: recording.Recording) -> dict[str, Series]:
    """Return the series that can be drawn over time, derived ones too, in the units of `PLOT_QUANTITIES`.

    Slides at and below `SLIDE_SPEED` are NaN; the state of the rail is left out where it does not change.
    """
    channels = dict(record.channels)
    at_rest: NDArray[np.bool_] | bool = False
    if "speed" in channels:
        speed = channels["speed"]
        at_rest = speed <= SLIDE_SPEED
        channels["deceleration"] = deceleration(channels["time"], speed)
        for n in WHEELSETS:
            if f"wheel_speed_{n}" in channels and f"slide_{n}" not in channels:
                channels[f"slide_{n}"] = slide(speed, channels[f"wheel_speed_{n}"])
    hidden = _hidden_of_rail(channels)
    series = {}
    with np.errstate(over="ignore"):
        for key, quantity in PLOT_QUANTITIES.items():
            for name in channel_names(key):
                if name in channels and key not in hidden:
                    samples = np.where(at_rest, np.nan, channels[name]) if key == "slide" else channels[name]
                    series[name] = (np.asarray(samples, dtype=np.float64) - quantity.zero) / quantity.scale
    return series


def _hidden_of_rail(channels: Mapping[str, Series]) -> tuple[str, ...]:
    """Return the quantities of the rail that say nothing: nothing was cleaned, or friction is constant."""

    def recorded(key: str) -> list[Series]:
        return [channels[name] for name in channel_names(key) if name in channels]

    if any(np.any(share > 0.0) for share in recorded("cleaned_share")):
        return ()
    known = [friction[np.isfinite(friction)] for friction in recorded("friction")]
    varies = any(np.any(friction != friction[:1]) for friction in known)
    return OF_RAIL[varies:]


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


def extremes(columns: Series, y: Series) -> Rows:
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
    chosen = [gaps[np.diff(column[gaps], append=len(starts)) > 0]]
    for extreme in (np.fmin, np.fmax):
        of_column = extreme.reduceat(y, starts)[column]
        rows = np.flatnonzero((y == of_column) | (missing & np.isnan(of_column)))
        chosen.append(rows[np.diff(column[rows], prepend=-1) > 0])
    return _sorted_rows(chosen, len(y))


def thinned(y: Series, bins: int) -> Rows:
    """Return the rows of a series to be drawn: both ends, and the extremes of at most `bins` equal parts."""
    parts = np.arange(len(y), dtype=np.float64) // -(-len(y) // bins)
    return _sorted_rows([extremes(parts, y), np.array([0, len(y) - 1])], len(y))


def _sorted_rows(rows: Sequence[Rows], count: int) -> Rows:
    """Return each of the rows, out of `count`, once; `np.unique` would load masked arrays for it."""
    is_chosen = np.zeros(count, dtype=np.bool_)
    is_chosen[np.concatenate(rows)] = True
    return np.flatnonzero(is_chosen)


def fault_spans(record: recording.Recording) -> tuple[FaultSpan, ...]:
    """Return when each fault was active, as far as the samples tell; none where no faults were recorded."""
    labels = record.metadata.get("faults", "")
    if not labels or "active_faults" not in record.channels:
        return ()
    time, active_faults = record["time"], record["active_faults"].astype(np.int64)
    spans = []
    for bit, label in enumerate(labels.split(", ")):
        active = active_faults & (1 << bit) != 0
        ends = np.flatnonzero(np.diff(active, prepend=False, append=False))
        for first, after in ends.reshape(-1, 2).tolist():
            end = time[min(after, len(time) - 1)]
            spans.append(FaultSpan(label_words(label), float(time[first]), float(end)))
    return tuple(spans)


def vent_cycles(time: Series, series: Mapping[str, Series]) -> tuple[VentCycle, ...]:
    """Return the vents of all wheelsets in the order of their starts.

    Args:
        time: time of the samples, s.
        series: samples by channel: states of valves, slides in %, pressures in bar.

    """
    cycles = (cycle for n in WHEELSETS for cycle in _vents_of_wheelset(time, series, n))
    return tuple(sorted(cycles, key=lambda cycle: cycle.start))


def _vents_of_wheelset(time: Series, series: Mapping[str, Series], n: int) -> Iterator[VentCycle]:
    if (valve := series.get(f"valve_command_{n}")) is None:
        return
    missing = np.full(len(time), math.nan)
    slides, pressure = series.get(f"slide_{n}", missing), series.get(f"tank_pressure_{n}", missing)
    edges = np.flatnonzero(np.diff(np.rint(valve) == VENT, prepend=False, append=False))
    starts, ends = edges[::2], edges[1::2]
    next_starts = np.append(starts, len(time))[1:]
    for start, end, following in zip(starts, ends, next_starts, strict=True):
        yield VentCycle(
            n,
            float(time[start]),
            float(time[min(end, len(time) - 1)] - time[start]),
            float(slides[start]),
            float(pressure[start] - np.min(pressure[start:following])),
            _recovery_time(time[start:following], slides[start:following]),
        )


def _recovery_time(time: Series, slides: Series) -> float:
    """Return the time from the first sample until the slide, after its peak, is back; NaN if it is not."""
    if math.isnan(slides[0]):
        return math.nan
    peak = int(np.nanargmax(slides))
    back = np.flatnonzero(slides[peak:] <= slides[0])
    return float(time[peak + back[0]] - time[0]) if len(back) else math.nan


BAND_STOPS: Final = 20
"""Stops of a repeated case that its band holds, the first ones: those of a large run are simulated again."""
BAND_QUANTITIES: Final = ("speed", "wheel_speed", "slide", "cylinder_pressure")
_BIN_WIDTH: Final = 0.05
"""s: of every part of a stop the extremes are kept, so that a band takes a fifth of the samples; chosen."""
_ROUNDING: Final = 1e-6
"""Of a part: times that lie no further apart are one."""


class StopExtremes(NamedTuple):
    """The lowest and the highest value of every part of a stop.

    Args:
        start: first time of the record, s since the brake command.
        part: how long each part is, s.
        lowest, highest: channel -> values in the unit of `quantities.PLOT_QUANTITIES`; NaN where there is
            none.

    """

    start: float
    part: float
    lowest: Mapping[str, Series]
    highest: Mapping[str, Series]


def stop_extremes(record: recording.Recording) -> StopExtremes:
    """Return the extremes of what a band shows of a stop."""
    time, series = record[recording.TIME], series_in_units(record)
    interval = float(np.median(np.diff(time))) if len(time) > 1 else _BIN_WIDTH
    bin_width = interval * max(round(_BIN_WIDTH / interval), 1)
    # A sample at the border of two parts belongs to the later one, however times are rounded.
    bin_index = np.floor((time - time[0]) / bin_width + _ROUNDING).astype(np.intp)
    starts = np.flatnonzero(np.diff(bin_index, prepend=-1))

    def bin_extremes(extreme: np.ufunc) -> dict[str, Series]:
        values = {}
        for name in (name for key in BAND_QUANTITIES for name in channel_names(key) if name in series):
            values[name] = np.full(bin_index[-1] + 1, np.nan)
            values[name][bin_index[starts]] = extreme.reduceat(series[name], starts)
        return values

    return StopExtremes(float(time[0]), bin_width, bin_extremes(np.fmin), bin_extremes(np.fmax))


def with_band(trace: PlotTrace, stops: Sequence[StopExtremes]) -> PlotTrace:
    """Return a trace with the band of the stops of its case, in whatever order; none of fewer than two.

    Beyond the end of a shorter stop the band is that of the stops that still run, up to the end of the trace.
    """
    if len(stops) < 2:
        return trace
    first = stops[0]
    bins = max(len(values) for stop in stops for values in stop.lowest.values())
    # The last border is the first one at or after the end of the trace.
    drawn = min(int(np.ceil((trace.end - first.start) / first.part - _ROUNDING)), bins) + 1
    x = np.minimum(first.start + first.part * np.arange(drawn), trace.end)

    def edge(values: Sequence[Series], extreme: np.ufunc) -> Curve:
        by_stop = np.full((len(stops), bins + 2), np.nan)
        for row, bin_values in zip(by_stop, values, strict=True):
            row[1 : len(bin_values) + 1] = bin_values
        over_stops = extreme.reduce(by_stop)
        # At a border the extreme of both parts: no sample lies beyond the line from one border to the next.
        return Curve(x, extreme(over_stops[:-1], over_stops[1:])[:drawn])

    band = {
        name: (
            edge([stop.lowest[name] for stop in stops], np.fmin),
            edge([stop.highest[name] for stop in stops], np.fmax),
        )
        for name in first.lowest
    }
    return replace(trace, band=band, band_stops=len(stops))

"""Two recordings at common instants, drawn over each other, and beneath each channel the difference."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.comparison.tolerance import Tolerances
from uictest.core import recording
from uictest.core.recording import state_kind
from uictest.core.units import CELSIUS_ZERO, SIZES
from uictest.plans.scenario.yaml import nearest
from uictest.report import Curve, PlotTrace, number, shown_unit, thinned

Samples = NDArray[np.float64]


class Sampled(NamedTuple):
    """Samples over an abscissa that rises strictly; both have shape (n,)."""

    at: Samples
    values: Samples


@dataclass(frozen=True, slots=True)
class CommonSamples:
    """Two series at the same places; all have shape (n,), and n is 0 where the two share no place."""

    at: Samples
    first: Samples
    second: Samples

    @property
    def difference(self) -> Samples:
        """The second less the first; NaN where a side has no value."""
        return self.second - self.first


def common_samples(first: Sampled, second: Sampled, *, holds: bool = False) -> CommonSamples:
    """Return two series at their :func:`recording.common_instants`, the same in either order.

    Between samples they are straight lines. `holds`: a sample stands until the next one, as that of a valve
    does.
    """
    at = recording.common_instants(first.at, second.at)
    read = (recording.at_instants(*side, at, holds=holds) for side in (first, second))
    return CommonSamples(at, *read)


def over_time(record: recording.Recording, channel: str) -> Sampled:
    """Return a channel over the time since the brake command (s)."""
    return Sampled(*(np.asarray(record[name], dtype=np.float64) for name in (recording.TIME, channel)))


def over_distance(record: recording.Recording, channel: str) -> Sampled:
    """Return a channel over the distance (m), without the samples at which the train gets no further.

    Raises ValueError with the reason where that makes no sense.
    """
    if DISTANCE not in record.channels:
        raise ValueError(f"there is no {DISTANCE}")
    distance = np.asarray(record[DISTANCE], dtype=np.float64)
    farthest = np.maximum.accumulate(distance)
    # Comparisons with missing samples, and with what is beyond all numbers, are false.
    with np.errstate(invalid="ignore"):
        falls = not np.all(farthest - distance <= _ROLL_BACK)
    if falls:
        raise ValueError(f"the {DISTANCE} has gaps or falls")
    moving = np.diff(farthest, prepend=-np.inf) > 0.0
    if np.count_nonzero(moving) < _FEWEST:
        raise ValueError(f"the {DISTANCE} stands still")
    return Sampled(distance[moving], np.asarray(record[channel], dtype=np.float64)[moving])


DISTANCE = "distance"
_FEWEST = 2
"""Samples that a line takes."""
_ROLL_BACK = 1.0
"""m: a train that has stopped swings back by millimetres; more is not a distance run. Chosen."""


@dataclass(frozen=True, slots=True)
class WorstInstant:
    """Where two series lie furthest apart: `at` in s or m, both sides in the unit of the channel."""

    at: float
    first: float
    second: float


@dataclass(frozen=True, slots=True)
class ChannelDifference:
    """A channel of two recordings at common instants.

    Args:
        channel: its name.
        unit: unit of its samples, one of the page.
        samples: both sides over time, s.
        worst: where both sides have a value and lie furthest apart; None where they share no such instant.
        mean: mean of second - first over these instants; None where there are none.
        allowed: how far the sides may lie apart; None where no tolerance was given.

    """

    channel: str
    unit: str
    samples: CommonSamples
    worst: WorstInstant | None
    mean: float | None
    allowed: float | None = None

    @property
    def within(self) -> bool | None:
        """Whether the sides are nowhere further apart than is allowed; None without a tolerance."""
        if self.allowed is None or self.worst is None:
            return None
        return abs(self.worst.second - self.worst.first) <= self.allowed


def channel_difference(
    channel: str, first: recording.Recording, second: recording.Recording, allowed: float | None = None
) -> ChannelDifference:
    """Return the difference of a channel that both recordings have in the same unit."""
    both = common_samples(over_time(first, channel), over_time(second, channel), holds=holds(channel))
    finite = both.difference[np.isfinite(both.difference)]
    mean = float(finite.mean()) if len(finite) else None
    return ChannelDifference(channel, first.units[channel], both, worst_instant(both), mean, allowed)


def allowed_of(channel: str, records: Iterable[recording.Recording], tolerances: Tolerances) -> float:
    """Return the allowed difference of a channel of two recordings, in its unit, by the larger range."""
    samples = (np.asarray(record[channel], dtype=np.float64) for record in records)
    finite = (values[np.isfinite(values)] for values in samples)
    return tolerances.of(channel).allowed(
        max(float(np.ptp(values)) if len(values) else 0.0 for values in finite)
    )


def worst_instant(both: CommonSamples) -> WorstInstant | None:
    """Return the instant at which two series lie furthest apart; None where they share no value."""
    apart = np.abs(both.difference)
    if not np.isfinite(apart).any():
        return None
    worst = int(np.argmax(np.where(np.isfinite(apart), apart, -1.0)))
    return WorstInstant(float(both.at[worst]), float(both.first[worst]), float(both.second[worst]))


def holds(channel: str) -> bool:
    """Return whether a sample of a channel stands until the next one."""
    return state_kind(channel) is not None


def in_shown_units(record: recording.Recording) -> recording.Recording:
    """Return a recording in the units of the page: km/h, bar, kN, degC, slides in %."""
    units = {name: shown_unit(name, unit) for name, unit in record.units.items()}
    channels = {
        name: samples if units[name] == record.units[name] else _in_unit(samples, units[name])
        for name, samples in record.channels.items()
    }
    return recording.Recording(channels, units, record.metadata)


def _in_unit(samples: recording.Samples, unit: str) -> recording.Samples:
    exact = np.asarray(samples, dtype=np.float64)  # of short samples, a quotient is short, too
    return exact - CELSIUS_ZERO if unit == "degC" else exact / SIZES[unit]


def common_channels(first: Mapping[str, str], second: Mapping[str, str]) -> list[str]:
    """Return the channels that both recordings have in the same unit, time left out; from their units."""
    return [name for name, unit in first.items() if name != "time" and second.get(name) == unit]


def only_in(first: Mapping[str, str], second: Mapping[str, str]) -> list[str]:
    """Return the channels that only the first recording has; from the units of both."""
    return [name for name in first if name not in second]


def select_channels(patterns: Sequence[str], channels: Iterable[str]) -> list[str]:
    """Return the channels that match a pattern, in the order of the patterns; `*` stands for any text.

    Raises ValueError with the nearest name and all names where a pattern matches none.
    """
    names = list(dict.fromkeys(channels))
    selected: dict[str, None] = {}
    for pattern in patterns:
        matching = [name for name in names if fnmatchcase(name, pattern)]
        if not matching:
            guess = nearest(pattern, names)
            hint = f"did you mean {guess!r}? " if guess else ""
            accepted = ", ".join(names) or "none"
            raise ValueError(f"no channel {pattern!r} on both sides; {hint}both have: {accepted}")
        selected |= dict.fromkeys(matching)
    return list(selected)


Line = Literal["first", "second", "difference"]

BINS: Final = 400
"""Parts of a stop of which a line shows the extremes: half as many as on the page of a run, as the three
lines of a channel share their points, and so add up at the cursor."""


def curve_name(line: Line, channel: str) -> str:
    """Return the name of a curve among those of an overlay."""
    return f"{line} {channel}"


def curves_over_time(
    first: recording.Recording, second: recording.Recording, differences: Iterable[ChannelDifference]
) -> dict[str, Curve]:
    """Return the three lines of every channel over the time since the brake command (s)."""
    curves: dict[str, Curve] = {}
    for each in differences:
        sides = over_time(first, each.channel), over_time(second, each.channel)
        curves |= _channel_curves(each.channel, sides, each.samples)
    return curves


@dataclass(frozen=True, slots=True)
class OverDistance:
    """Lines over distance (m), and where the sides of each channel lie furthest apart; else why not."""

    curves: Mapping[str, Curve] = field(default_factory=dict)
    worst: Mapping[str, WorstInstant | None] = field(default_factory=dict)
    why_not: str = ""


def over_common_distance(
    first: recording.Recording, second: recording.Recording, channels: Sequence[str]
) -> OverDistance:
    """Return the three lines of every channel over distance (m), the distance itself left out.

    There is none where a side cannot be drawn over distance, or they share none.
    """
    curves: dict[str, Curve] = {}
    worst: dict[str, WorstInstant | None] = {}
    for channel in channels:
        if channel == DISTANCE:
            continue
        try:
            sides = _over_distance("A", first, channel), _over_distance("B", second, channel)
        except ValueError as error:
            return OverDistance(why_not=str(error))
        both = common_samples(*sides, holds=holds(channel))
        if not len(both.at):
            return OverDistance(why_not="A and B share no distance")
        curves |= _channel_curves(channel, sides, both)
        worst[channel] = worst_instant(both)
    return OverDistance(curves, worst)


def _over_distance(side: str, record: recording.Recording, channel: str) -> Sampled:
    try:
        return over_distance(record, channel)
    except ValueError as error:
        raise ValueError(f"in {side} {error}") from error


def _channel_curves(channel: str, sides: tuple[Sampled, Sampled], both: CommonSamples) -> dict[str, Curve]:
    shared = _rows_of_extremes(both.first, both.second, both.difference)
    steps = holds(channel)
    places = both.at[shared]
    lines = {
        curve_name("first", channel): _side_curve(sides[0], places),
        curve_name("second", channel): _side_curve(sides[1], places),
        curve_name("difference", channel): Curve(places, both.difference[shared]),
    }
    return {name: _stepped_curve(curve) if steps else curve for name, curve in lines.items() if len(curve.x)}


def _side_curve(side: Sampled, places: Samples) -> Curve:
    """Return a side through its extremes, and through its samples at the points of the difference."""
    shared, on_sample = recording.rows_at(side.at, places)
    rows = np.union1d(_rows_of_extremes(side.values), shared[on_sample])
    return Curve(side.at[rows], side.values[rows])


def _rows_of_extremes(*series: Samples) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the rows that hold the extremes of every one of some series of equal length."""
    if not len(series[0]):
        return np.zeros(0, dtype=np.intp)
    return np.unique(np.concatenate([thinned(each, BINS) for each in series]))


def _stepped_curve(curve: Curve) -> Curve:
    return Curve(np.repeat(curve.x, 2)[1:], np.repeat(curve.y, 2)[:-1])


DRAWN = 12
"""Largest number of channels drawn where none are chosen."""

FIRST_DRAWN = ("speed", *(f"slide_{n}" for n in (1, 2, 3, 4)), "tank_pressure_1", "clamping_force_1")
"""The most informative channels of a stop: they come first where none are chosen."""


@dataclass(frozen=True, slots=True)
class Overlay:
    """Both sides of some channels, and their differences.

    Args:
        title: what was recorded: the id of a case.
        channels: those that are drawn.
        intervals: mean time between two samples of each side, s.
        trace: their curves over time, named by `overlay_curves.curve_name`.
        over_distance: the same over distance.
        not_drawn: channels of both sides that are not drawn.
        only_first, only_second: channels of one side.
        remarks: what was not compared, and how samples at other instants were.

    """

    title: str
    channels: Sequence[ChannelDifference]
    intervals: tuple[float, float]
    trace: PlotTrace
    over_distance: OverDistance
    not_drawn: Sequence[str] = ()
    only_first: Sequence[str] = ()
    only_second: Sequence[str] = ()
    remarks: Sequence[str] = ()


def default_channels(remarkable: Sequence[str], common: Sequence[str]) -> list[str]:
    """Return the channels drawn where none are chosen: the speed and the remarkable channels."""
    first = [name for name in FIRST_DRAWN if name == "speed" or name in remarkable]
    return [name for name in dict.fromkeys([*first, *remarkable]) if name in common][:DRAWN]


def overlay_of(
    title: str,
    first: recording.Recording,
    second: recording.Recording,
    differences: Sequence[ChannelDifference],
) -> Overlay:
    """Return the channels that differ so, each side drawn to its own end."""
    channels = [each.channel for each in differences]
    common = common_channels(first.units, second.units)
    return Overlay(
        title,
        differences,
        (recording.mean_interval(first[recording.TIME]), recording.mean_interval(second[recording.TIME])),
        _overlay_trace(first, second, differences),
        over_common_distance(first, second, channels),
        [name for name in common if name not in channels],
        only_in(first.units, second.units),
        only_in(second.units, first.units),
        list(sampling_remarks(first, second)),
    )


def sampling_remarks(first: recording.Recording, second: recording.Recording) -> Iterator[str]:
    """Yield the notes on samples at different instants, and on time not compared; A is the first side."""
    times = first[recording.TIME], second[recording.TIME]
    instants, coarser = recording.common_instants(*times), recording.coarser(*times)
    if not len(instants):
        yield "A and B share no time: nothing of their channels is compared"
        return
    if coarser is not None:
        sides = ("A", "B") if coarser is times[0] else ("B", "A")
        every = [f"{1e3 * step:.4g} ms" for step in sorted(map(recording.mean_interval, times), reverse=True)]
        yield (
            f"compared at the instants of {sides[0]}, every {every[0]}; {sides[1]} has a sample every"
            f" {every[1]} and is read off straight lines between its samples"
        )
    elif len(instants) > np.count_nonzero(recording.covers(times[1], times[0])):
        yield "compared at the instants of both; each is read off straight lines between its samples"
    for side, time, other in zip("AB", times, times[::-1], strict=True):
        (begin, end), (begins, ends) = time[[0, -1]], recording.covers(other, time[[0, -1]])
        if begin < other[0] and not begins:
            yield f"{side} begins {number(float(other[0] - begin))} s earlier: not compared"
        if end > other[-1] and not ends:
            later = number(float(end - other[-1]))
            yield f"{side} goes on for {later} s, from {number(float(other[-1]))} s: not compared"


def _overlay_trace(
    first: recording.Recording, second: recording.Recording, differences: Sequence[ChannelDifference]
) -> PlotTrace:
    times = first[recording.TIME], second[recording.TIME]
    intervals = {recording.mean_interval(time) for time in times}
    start, end = (float(pick(time[place] for time in times)) for pick, place in ((min, 0), (max, -1)))
    # Times of another interval than the other side's would be rounded to it.
    interval = intervals.pop() if len(intervals) == 1 else 0.0
    return PlotTrace(start, end, interval, curves_over_time(first, second, differences))

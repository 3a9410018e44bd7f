"""Two recordings drawn over each other, and beneath each channel the difference."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np

from uictest.analysis.comparison.common_samples import (
    DISTANCE,
    ChannelDifference,
    CommonSamples,
    Sampled,
    Samples,
    WorstInstant,
    common_channels,
    common_samples,
    holds,
    only_in,
    over_distance,
    over_time,
    worst_instant,
)
from uictest.core import recording
from uictest.report import Curve, PlotTrace, number, thinned

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
        curves |= _curves(each.channel, sides, each.samples)
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
        curves |= _curves(channel, sides, both)
        worst[channel] = worst_instant(both)
    return OverDistance(curves, worst)


def _over_distance(side: str, record: recording.Recording, channel: str) -> Sampled:
    try:
        return over_distance(record, channel)
    except ValueError as error:
        raise ValueError(f"in {side} {error}") from error


def _curves(channel: str, sides: tuple[Sampled, Sampled], both: CommonSamples) -> dict[str, Curve]:
    shared = _points(both.first, both.second, both.difference)
    steps = holds(channel)
    places = both.at[shared]
    lines = {
        curve_name("first", channel): _side(sides[0], places),
        curve_name("second", channel): _side(sides[1], places),
        curve_name("difference", channel): Curve(places, both.difference[shared]),
    }
    return {name: _stepped(curve) if steps else curve for name, curve in lines.items() if len(curve.x)}


def _side(side: Sampled, places: Samples) -> Curve:
    """Return a side through its extremes, and through its samples at the points of the difference."""
    shared, on_sample = recording.rows_at(side.at, places)
    rows = np.union1d(_points(side.values), shared[on_sample])
    return Curve(side.at[rows], side.values[rows])


def _points(*series: Samples) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the rows that hold the extremes of every one of some series of equal length."""
    if not len(series[0]):
        return np.zeros(0, dtype=np.intp)
    return np.unique(np.concatenate([thinned(each, BINS) for each in series]))


def _stepped(curve: Curve) -> Curve:
    """Return a curve that stays at each of its points until the next one."""
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
    """Return what is drawn where no channels are chosen: the speed and the remarkable channels."""
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
        _trace(first, second, differences),
        over_common_distance(first, second, channels),
        [name for name in common if name not in channels],
        only_in(first.units, second.units),
        only_in(second.units, first.units),
        list(sampling_remarks(first, second)),
    )


def sampling_remarks(first: recording.Recording, second: recording.Recording) -> Iterator[str]:
    """Yield how samples at different instants were compared, and which time was not; A is the first side."""
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


def _trace(
    first: recording.Recording, second: recording.Recording, differences: Sequence[ChannelDifference]
) -> PlotTrace:
    times = first[recording.TIME], second[recording.TIME]
    intervals = {recording.mean_interval(time) for time in times}
    start, end = (float(pick(time[place] for time in times)) for pick, place in ((min, 0), (max, -1)))
    # Times of another interval than the other side's would be rounded to it.
    interval = intervals.pop() if len(intervals) == 1 else 0.0
    return PlotTrace(start, end, interval, curves_over_time(first, second, differences))

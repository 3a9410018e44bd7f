"""Two recordings drawn over each other, and beneath each channel the difference of both."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from uictest.analysis.comparison.channel_difference import ChannelDifference
from uictest.analysis.comparison.channels import common_channels, only_in
from uictest.analysis.comparison.overlay_curves import OverDistance, curves_over_time, over_common_distance
from uictest.core import recording
from uictest.report import PlotTrace, interval_of, number

DRAWN = 12
"""Largest number of channels drawn where none are chosen."""

FIRST_DRAWN = ("speed", *(f"slide_{n}" for n in (1, 2, 3, 4)), "tank_pressure_1", "clamping_force_1")
"""The most informative channels of a stop: they come first where none are chosen."""

_SAME = 1e-9
"""Of a time or an interval: what differs by less is rounding."""


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
        (interval_of(first[recording.TIME]), interval_of(second[recording.TIME])),
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
    start, end = max(time[0] for time in times), min(time[-1] for time in times)
    if start > end:
        yield "A and B share no time: nothing of their channels is compared"
        return
    steps = [interval_of(time) for time in times]
    if abs(steps[0] - steps[1]) > _SAME * max(steps):
        sides = ("A", "B") if steps[0] > steps[1] else ("B", "A")
        every = [f"{1e3 * step:.4g} ms" for step in sorted(steps, reverse=True)]
        yield (
            f"compared at the instants of {sides[0]}, every {every[0]}; {sides[1]} has a sample every"
            f" {every[1]} and is read off straight lines between its samples"
        )
    for side, time in zip("AB", times, strict=True):
        if start - time[0] > _SAME * max(1.0, abs(start)):
            yield f"{side} begins {number(float(start - time[0]))} s earlier: not compared"
        if time[-1] - end > _SAME * max(1.0, abs(end)):
            later = number(float(time[-1] - end))
            yield f"{side} goes on for {later} s, from {number(float(end))} s: not compared"


def _trace(
    first: recording.Recording, second: recording.Recording, differences: Sequence[ChannelDifference]
) -> PlotTrace:
    times = first[recording.TIME], second[recording.TIME]
    intervals = {interval_of(time) for time in times}
    start, end = (float(pick(time[place] for time in times)) for pick, place in ((min, 0), (max, -1)))
    # Times of another interval than the other side's would be rounded to it.
    interval = intervals.pop() if len(intervals) == 1 else 0.0
    return PlotTrace(start, end, interval, curves_over_time(first, second, differences))

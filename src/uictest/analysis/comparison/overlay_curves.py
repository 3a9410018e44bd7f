"""The lines of an overlay: both sides of a channel and their difference, over time or over distance."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np

from uictest.analysis.comparison.channel_difference import (
    ChannelDifference,
    WorstInstant,
    holds,
    worst_instant,
)
from uictest.analysis.comparison.common_samples import (
    DISTANCE,
    CommonSamples,
    Sampled,
    Samples,
    common_samples,
    over_distance,
    over_time,
)
from uictest.core import recording
from uictest.report import Curve, thinned

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
    rows = np.union1d(_points(side.values), np.flatnonzero(np.isin(side.at, places)))
    return Curve(side.at[rows], side.values[rows])


def _points(*series: Samples) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the rows that hold the extremes of every one of some series of equal length."""
    if not len(series[0]):
        return np.zeros(0, dtype=np.intp)
    return np.unique(np.concatenate([thinned(each, BINS) for each in series]))


def _stepped(curve: Curve) -> Curve:
    """Return a curve that stays at each of its points until the next one."""
    return Curve(np.repeat(curve.x, 2)[1:], np.repeat(curve.y, 2)[:-1])

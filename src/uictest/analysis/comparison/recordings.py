"""Two recordings: channel by channel over their common time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.comparison.channel_difference import ChannelDifference, allowed_of, channel_difference
from uictest.analysis.comparison.channels import common_channels, in_shown_units, select_channels
from uictest.analysis.comparison.difference import Comparison
from uictest.analysis.comparison.overlay import default_channels, overlay_of
from uictest.analysis.comparison.tolerance import Tolerances, compare_numbers
from uictest.core import recording
from uictest.report import Difference, number


def compare_recordings(
    first: recording.Recording,
    second: recording.Recording,
    names: tuple[str, str],
    tolerances: Tolerances,
    channels: Sequence[str] = (),
) -> Comparison:
    """Compare two recordings in the units of the page.

    Samples are compared over the time that both cover, at the instants of the recording that is sampled more
    coarsely; the other one is read off straight lines between its samples, and states at their last sample.

    Args:
        first, second: the recordings.
        names: what they are called.
        tolerances: what may differ, in the units of the page.
        channels: patterns of the channels to draw; the speed and those that differ where there are none.

    Raises:
        ValueError: a pattern matches no channel that both recordings have.

    """
    first, second = in_shown_units(first), in_shown_units(second)
    common = {
        name: channel_difference(name, first, second, allowed_of(name, first, tolerances))
        for name in common_channels(first.units, second.units)
    }
    quantities = [_durations(first, second, tolerances), *_channels(first, second, common)]
    differences = [difference for difference in quantities if difference is not None]
    remarkable = [difference.quantity for difference in differences if not difference.within]
    drawn = select_channels(channels, common) if channels else default_channels(remarkable, list(common))
    overlay = overlay_of("Recordings", first, second, [common[name] for name in drawn])
    return Comparison(*names, len(quantities), differences, overlay.remarks, [overlay])


def _durations(
    first: recording.Recording, second: recording.Recording, tolerances: Tolerances
) -> Difference | None:
    ours, theirs = (float(record["time"][-1]) for record in (first, second))
    return compare_numbers("", "duration", ours, theirs, tolerances, unit="s")


def _channels(
    first: recording.Recording, second: recording.Recording, common: Mapping[str, ChannelDifference]
) -> Iterator[Difference | None]:
    """Yield one item per channel compared: None where both sides are the same."""
    for name in dict.fromkeys([*first.channels, *second.channels]):
        if name == recording.TIME:
            continue
        if name in common:
            yield _channel(common[name])
        else:
            ours, theirs = (record.units.get(name, "none") for record in (first, second))
            remark = "different units" if "none" not in (ours, theirs) else "only one side has the channel"
            yield Difference("", name, ours, theirs, within=False, remark=remark)


def _channel(channel: ChannelDifference) -> Difference | None:
    """Return how a channel differs; None where all common samples are the same."""
    both = channel.samples
    lacking = np.isnan(both.first) != np.isnan(both.second)
    if lacking.any() or not len(both.at):
        return _incomparable(channel, np.flatnonzero(lacking))
    worst = channel.worst
    if worst is None or worst.first == worst.second:
        return None
    return Difference(
        "",
        channel.channel,
        worst.first,
        worst.second,
        within=bool(channel.within),
        unit=channel.unit,
        deviation=abs(worst.second - worst.first),
        allowed=channel.allowed,
        remark=f"largest at {number(worst.at)} s",
    )


def _incomparable(channel: ChannelDifference, lacking: NDArray[np.intp]) -> Difference:
    """Return the difference of a channel that one side lacks at some instants, or that shares none."""
    both = channel.samples
    sides, remark = (math.nan, math.nan), "the two share no time"
    if len(lacking):
        at = lacking[0]
        sides = float(both.first[at]), float(both.second[at])
        remark = f"only one side has a value at {len(lacking)} of {len(both.at)} instants"
        remark += f", first at {number(float(both.at[at]))} s"
    return Difference(
        "", channel.channel, *sides, within=False, unit=channel.unit, allowed=channel.allowed, remark=remark
    )

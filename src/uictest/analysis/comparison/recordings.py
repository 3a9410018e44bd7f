"""Two recordings, or two run folders with the recordings that both hold."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest import report
from uictest.analysis.comparison.comparison_document import Comparison
from uictest.analysis.comparison.overlay import (
    DISTANCE,
    FIRST_DRAWN,
    ChannelDifference,
    Overlay,
    allowed_of,
    channel_difference,
    common_channels,
    default_channels,
    in_shown_units,
    overlay_of,
    select_channels,
)
from uictest.analysis.comparison.runs import compare_runs
from uictest.analysis.comparison.tolerance import Tolerances, compare_numbers
from uictest.core import recording
from uictest.report import Difference, counted, number


def compare_recordings(
    first: recording.Recording,
    second: recording.Recording,
    names: tuple[str, str],
    tolerances: Tolerances,
    channels: Sequence[str] = (),
) -> Comparison:
    """Compare two recordings in the units of the page.

    Samples are compared over the time that both cover, at the instants of the recording that is sampled more
    coarsely, of both where neither is; a recording without a sample there is read off straight lines between
    its samples, and states at their last sample. Which recording is the first decides nothing.

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
        name: channel_difference(name, first, second, allowed_of(name, (first, second), tolerances))
        for name in common_channels(first.units, second.units)
    }
    ours, theirs = (float(record["time"][-1]) for record in (first, second))
    quantities = [
        compare_numbers("", "duration", ours, theirs, tolerances, unit="s"),
        *_channel_differences(first, second, common),
    ]
    differences = [difference for difference in quantities if difference is not None]
    remarkable = [difference.quantity for difference in differences if not difference.within]
    drawn = select_channels(channels, common) if channels else default_channels(remarkable, list(common))
    overlay = overlay_of("Recordings", first, second, [common[name] for name in drawn])
    about = list(_runs_of(names, first, second))
    return Comparison(*names, len(quantities), differences, overlay.remarks, [overlay], about=about)


def _runs_of(
    names: tuple[str, str], first: recording.Recording, second: recording.Recording
) -> Iterator[str]:
    """Yield by how much further the second recording runs than the first."""
    if DISTANCE in first.channels and DISTANCE in second.channels:
        ours, theirs = (float(np.nanmax(record[DISTANCE])) for record in (first, second))
        word = "further" if theirs > ours else "less far"
        change = f"{number(abs(theirs - ours))} m {word}" if ours != theirs else "as far"
        yield f"{names[1]} runs {change}: {number(theirs)} m, {names[0]} {number(ours)} m."


def _channel_differences(
    first: recording.Recording, second: recording.Recording, common: Mapping[str, ChannelDifference]
) -> Iterator[Difference | None]:
    """Yield one item per channel compared: None where both sides are the same."""
    for name in dict.fromkeys([*first.channels, *second.channels]):
        if name == recording.TIME:
            continue
        if name in common:
            yield _channel_difference(common[name])
        else:
            ours, theirs = (record.units.get(name, "none") for record in (first, second))
            remark = "different units" if "none" not in (ours, theirs) else "only one side has the channel"
            yield Difference("", name, ours, theirs, within=False, remark=remark)


def _channel_difference(channel: ChannelDifference) -> Difference | None:
    """Return the difference of a channel; None where all common samples are the same."""
    both = channel.samples
    lacking = np.isfinite(both.first) != np.isfinite(both.second)
    if lacking.any() or not len(both.at):
        return _incomparable_channel(channel, np.flatnonzero(lacking))
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


def _incomparable_channel(channel: ChannelDifference, lacking: NDArray[np.intp]) -> Difference:
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


DRAWN = 12
"""Largest number of stops drawn."""

Pair = tuple["recording.Recording", "recording.Recording"]


def compare_run_folders(first: Path, second: Path, tolerances: Tolerances) -> Comparison:
    """Compare the results of two finished runs. Raises OSError or ValueError where one cannot be read."""
    return compare_runs(report.read_run(first), report.read_run(second), tolerances)


def with_overlays(
    compared: Comparison, first: Path, second: Path, channels: Sequence[str], tolerances: Tolerances
) -> Comparison:
    """Return the comparison of two run folders with the stops that differ drawn over each other.

    Args:
        compared: the results compared.
        first, second: the folders.
        channels: patterns of the channels to draw; a choice of the program where there are none.
        tolerances: a channel that one of them names is drawn with it; the others were given for figures.

    Raises:
        OSError, ValueError: a recording cannot be read, or a pattern matches no channel of any stop.

    """
    cases = list(dict.fromkeys(difference.case for difference in compared.differences))
    pairs = {case_id: pair for case_id in cases[:DRAWN] if (pair := _recorded_pair(case_id, first, second))}
    shared_names = [name for pair in pairs.values() for name in _shared_channels(pair)]
    chosen = select_channels(channels, shared_names) if channels and pairs else None
    overlays = [stops_laid_over(case_id, pair, chosen, tolerances) for case_id, pair in pairs.items()]
    remarks = list(_undrawn_stop_lines(cases, pairs, first, second))
    return dataclasses.replace(compared, overlays=overlays, undrawn=remarks)


def _recorded_pair(case_id: str, first: Path, second: Path) -> Pair | None:
    paths = [report.recording_path(folder, case_id) for folder in (first, second)]
    if not all(path.is_file() for path in paths):
        return None
    return recording.read_parquet(paths[0]), recording.read_parquet(paths[1])


def _shared_channels(pair: Pair) -> list[str]:
    return common_channels(pair[0].units, pair[1].units)


def stops_laid_over(
    case_id: str, pair: Pair, chosen: Sequence[str] | None = None, tolerances: Tolerances | None = None
) -> Overlay:
    """Return two recordings of a stop in the units of the page, one laid over the other.

    `chosen` names the channels; where it is None, the most informative ones are drawn. A tolerance that
    names a channel is drawn with it.
    """
    pair = in_shown_units(pair[0]), in_shown_units(pair[1])
    common = _shared_channels(pair)
    names = default_channels(FIRST_DRAWN, common) if chosen is None else chosen
    named = [name for name in common if tolerances is not None and tolerances.names(name)]
    allowed = {name: allowed_of(name, pair, tolerances) for name in named if tolerances is not None}
    return overlay_of(
        case_id,
        *pair,
        [channel_difference(name, *pair, allowed.get(name)) for name in names if name in common],
    )


def _undrawn_stop_lines(
    cases: Sequence[str], pairs: dict[str, Pair], first: Path, second: Path
) -> Iterator[str]:
    """Yield a line for the stops that differ and are not drawn, with the reason."""
    for case_id in cases[:DRAWN]:
        if case_id not in pairs:
            recorded = [
                each.resolve().name
                for each in (first, second)
                if report.recording_path(each, case_id).is_file()
            ]
            side = f"only {recorded[0]} has" if recorded else "neither run has"
            yield f"{case_id}: {side} a recording; run both with --record all"
    if len(cases) > DRAWN:
        yield f"{counted(len(cases) - DRAWN, 'more stop')} differ and are not drawn: a page draws {DRAWN}"

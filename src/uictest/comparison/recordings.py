"""Two recordings: channel by channel over their common time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from uictest import recording
from uictest.comparison.channels import common_channels, in_shown_units, select_channels
from uictest.comparison.difference import Comparison
from uictest.comparison.overlay import default_channels, overlay_of
from uictest.comparison.tolerance import Tolerances, compare_numbers
from uictest.report import Difference, number

Samples = NDArray[np.float64]


def compare_recordings(
    first: recording.Recording,
    second: recording.Recording,
    names: tuple[str, str],
    tolerances: Tolerances,
    channels: Sequence[str] = (),
) -> Comparison:
    """Compare two recordings in the units of the page.

    Samples are compared at the times of the first recording as far as the second reaches; where their times
    differ the second is read off straight lines between its samples.

    Args:
        first, second: the recordings.
        names: what they are called.
        tolerances: what may differ, in the units of the page.
        channels: patterns of the channels to draw; the speed and those that differ where there are none.

    Raises:
        ValueError: a pattern matches no channel that both recordings have.

    """
    first, second = in_shown_units(first), in_shown_units(second)
    quantities = [_durations(first, second, tolerances), *_channels(first, second, tolerances)]
    differences = [difference for difference in quantities if difference is not None]
    common = common_channels(first.units, second.units)
    remarkable = [difference.quantity for difference in differences if not difference.within]
    drawn = select_channels(channels, common) if channels else default_channels(remarkable, common)
    overlay = overlay_of("Recordings", first, second, names, drawn)
    return Comparison(*names, len(quantities), differences, overlays=[overlay])


def _durations(
    first: recording.Recording, second: recording.Recording, tolerances: Tolerances
) -> Difference | None:
    ours, theirs = (float(record["time"][-1]) for record in (first, second))
    return compare_numbers("", "duration", ours, theirs, tolerances, unit="s")


def _channels(
    first: recording.Recording, second: recording.Recording, tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per channel compared: None where both sides are the same."""
    for name in dict.fromkeys([*first.channels, *second.channels]):
        if name == "time":
            continue
        ours, theirs = (record.units.get(name, "none") for record in (first, second))
        if ours != theirs:
            remark = "different units" if "none" not in (ours, theirs) else "only one side has the channel"
            yield Difference("", name, ours, theirs, within=False, remark=remark)
        else:
            yield _channel(name, ours, first, second, tolerances)


def _channel(
    name: str, unit: str, first: recording.Recording, second: recording.Recording, tolerances: Tolerances
) -> Difference | None:
    time, ours, theirs = common_samples(name, first, second)
    apart = np.abs(theirs - ours)
    apart[np.isnan(ours) & np.isnan(theirs)] = 0.0
    if not len(apart) or not np.any(apart != 0.0):
        return None
    worst = int(np.argmax(np.where(np.isnan(apart), np.inf, apart)))
    deviation = float(apart[worst])
    known = ours[np.isfinite(ours)]
    allowed = tolerances.of(name).allowed(float(np.ptp(known)) if len(known) else 0.0)
    return Difference(
        "",
        name,
        float(ours[worst]),
        float(theirs[worst]),
        within=deviation <= allowed,
        unit=unit,
        deviation=None if np.isnan(deviation) else deviation,
        allowed=allowed,
        remark=f"largest at {number(float(time[worst]))} s",
    )


def common_samples(
    name: str, first: recording.Recording, second: recording.Recording
) -> tuple[Samples, Samples, Samples]:
    """Return the common times and the samples of a channel of both recordings at these."""
    time, other = first["time"], second["time"]
    common = (time >= other[0]) & (time <= other[-1])
    ours = np.asarray(first[name], dtype=np.float64)[common]
    if np.array_equal(time[common], other):
        return time[common], ours, np.asarray(second[name], dtype=np.float64)
    return time[common], ours, np.interp(time[common], other, np.asarray(second[name], dtype=np.float64))

"""Two recordings: channel by channel over their common time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from uictest.comparison.difference import Comparison
from uictest.comparison.numbers import compare_numbers
from uictest.comparison.overlay import overlay_of
from uictest.comparison.tolerance import Tolerances
from uictest.report.difference import Difference
from uictest.report.wording import number

if TYPE_CHECKING:
    from uictest.recording import Recording

Samples = NDArray[np.float64]


def compare_recordings(
    first: Recording, second: Recording, names: tuple[str, str], tolerances: Tolerances, case: str = ""
) -> Comparison:
    """Compare two recordings; `names` is what they are called, `case` the case both belong to.

    Samples are compared at the times of the first recording as far as the second reaches; where their times
    differ the second is read off straight lines between its samples.
    """
    found = [_durations(case, first, second, tolerances), *_channels(case, first, second, tolerances)]
    differences = [difference for difference in found if difference is not None]
    remarkable = [difference.quantity for difference in differences if not difference.within]
    overlay = overlay_of(case or "Recordings", first, second, names, remarkable)
    return Comparison(*names, len(found), differences, overlays=[overlay])


def _durations(case: str, first: Recording, second: Recording, tolerances: Tolerances) -> Difference | None:
    ours, theirs = (float(recording["time"][-1]) for recording in (first, second))
    return compare_numbers(case, "duration", ours, theirs, tolerances, unit="s")


def _channels(
    case: str, first: Recording, second: Recording, tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per channel compared: None where both sides are the same."""
    for name in dict.fromkeys([*first.channels, *second.channels]):
        if name == "time":
            continue
        ours, theirs = (recording.units.get(name, "none") for recording in (first, second))
        if ours != theirs:
            remark = "the channel has different units, or is on one side only"
            yield Difference(case, name, ours, theirs, within=False, remark=remark)
        else:
            yield _channel(case, name, ours, first, second, tolerances)


def _channel(
    case: str, name: str, unit: str, first: Recording, second: Recording, tolerances: Tolerances
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
        case,
        name,
        float(ours[worst]),
        float(theirs[worst]),
        within=deviation <= allowed,
        unit=unit,
        deviation=None if np.isnan(deviation) else deviation,
        allowed=allowed,
        remark=f"largest at {number(float(time[worst]))} s",
    )


def common_samples(name: str, first: Recording, second: Recording) -> tuple[Samples, Samples, Samples]:
    """Return the common times and the samples of a channel of both recordings at these."""
    time, other = first["time"], second["time"]
    common = (time >= other[0]) & (time <= other[-1])
    ours = np.asarray(first[name], dtype=np.float64)[common]
    if np.array_equal(time[common], other):
        return time[common], ours, np.asarray(second[name], dtype=np.float64)
    return time[common], ours, np.interp(time[common], other, np.asarray(second[name], dtype=np.float64))

"""Clocks of a log: without their steps, and those of its files beside each other."""

from __future__ import annotations

import zlib
from collections.abc import Collection, Sequence
from datetime import UTC, datetime
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats import UnreadableError
from uictest.recorded.service_log.signals import Array, Before, Rows

_EARLIEST_DATE, _LATEST_DATE = 946_684_800.0, 4_102_444_800.0
"""s: 2000-01-01 and 2100-01-01 as Unix time; a clock that shows less or more counts from somewhere else."""
_LARGEST_OVERLAP = 3.0
"""s by which a clock may have been put right between two files, less than a stop takes; chosen."""
_MOST_REPEATED = 0.1
"""Share of the rows in which a clock may repeat its time; chosen."""
_LONGEST_INTERVAL = 60.0
"""s: a longer interval between two rows is a step of the clock or an interruption; chosen."""


def clock_text(time: float) -> str:
    """Return a recorded time for a reader: a date where the clock shows one, else seconds."""
    if not _EARLIEST_DATE < time < _LATEST_DATE:
        return f"{time:.12g} s"
    return datetime.fromtimestamp(time, UTC).replace(tzinfo=None).isoformat(" ", "milliseconds")


def continuous_clock(time: Array, before: Before) -> Array:
    """Return a clock that runs on where the recorded one steps: there it takes the last interval before."""
    intervals = np.concatenate(([before.interval], np.diff(time)))
    sound = runs_on(intervals)
    last = np.maximum.accumulate(np.where(sound, np.arange(len(intervals)), 0))
    return np.cumsum(np.concatenate(([before.clock], intervals[last][1:])))


def last_interval(time: Array, before: Before) -> float:
    """Return the last interval of the recorded clock that is no step, s."""
    sound = np.flatnonzero(runs_on(np.diff(time)))
    return float(time[sound[-1] + 1] - time[sound[-1]]) if len(sound) else before.interval


def steps_of_clock(time: Array) -> NDArray[np.intp]:
    """Return the rows at which the recorded clock steps: back, not at all, or by more than a minute."""
    return np.flatnonzero(~runs_on(np.diff(time))) + 1


def runs_on(intervals: Array) -> NDArray[np.bool_]:
    """Return which intervals between two rows are no steps of the clock."""
    return (intervals > 0.0) & (intervals <= _LONGEST_INTERVAL)


class FileClock:
    """What the clock of a file shows: its first and last date, and repeated times; a checksum of its rows."""

    def __init__(self, file: Path) -> None:
        self.file, self.dates = file, np.zeros(0)
        self._rows, self._repeated, self.checksum = 0, 0, 0

    def add(self, rows: Rows) -> None:
        """Note the next rows."""
        # A recorder may begin with a default date, until its clock is put right.
        right = rows.time if self._rows else rows.time[int(steps_of_clock(rows.time)[-1:].sum()) :]
        dated = right[right > _EARLIEST_DATE]
        self.dates = np.concatenate((self.dates, dated))[[0, -1]] if len(dated) else self.dates
        self._rows += len(rows.time)
        self._repeated += int(np.count_nonzero(~(np.abs(np.diff(rows.time)) > 0.0)))
        self.checksum = zlib.crc32(rows.train.tobytes(), zlib.crc32(rows.time.tobytes(), self.checksum))

    def require_fine(self) -> None:
        """Raise UnreadableError for a clock that does not tell how long a stop lasts."""
        share = self._repeated / max(self._rows, 1)
        if share > _MOST_REPEATED:
            raise UnreadableError(
                f"the clock repeats its time, or shows none, in {100.0 * share:.0f} % of the rows, so no stop"
                " has a duration: write times with more decimals"
            )


def in_order(clocks: Sequence[FileClock], with_stops: Collection[Path]) -> list[Path]:
    """Return the files in the order of their dates, as they are where one has none.

    Raises UnreadableError where files have the same rows: their stops would be found twice. Without dates
    only copies are told, since each file may begin anew.
    """
    for one, other in combinations(clocks, 2):
        if one.checksum == other.checksum and one.file in with_stops:
            raise UnreadableError(f"{other.file}: named twice, or a copy of {one.file}")
    dated = sorted((each for each in clocks if len(each.dates)), key=lambda each: float(each.dates[0]))
    for one, other in pairwise(dated):
        overlap = one.dates[-1] - other.dates[0]
        if overlap > _LARGEST_OVERLAP:
            raise UnreadableError(
                f"{other.file}: begins {overlap:.0f} s before {one.file} ends, its stops would be found"
                " twice: cut one of them, or find the stops of each by itself"
            )
    return [each.file for each in (dated if len(dated) == len(clocks) else clocks)]

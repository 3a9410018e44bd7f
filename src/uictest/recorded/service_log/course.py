"""A stretch of a log: its clock without steps, the speed, and the applications of the brake in it."""

from __future__ import annotations

import zlib
from collections.abc import Collection, Iterator, Sequence
from datetime import UTC, datetime
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats import UnreadableError
from uictest.recorded.field_data import SHORTEST_APPLICATION
from uictest.recorded.service_log.signals import Array, Before, Rows, constant_before, reference_speed

_EARLIEST_DATE, _LATEST_DATE = 946_684_800.0, 4_102_444_800.0
"""s: 2000-01-01 and 2100-01-01 as Unix time; a clock that shows less or more counts from somewhere else."""
_LARGEST_OVERLAP = 3.0
"""s by which a clock may have been put right between two files, less than a stop takes; chosen."""
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
    """Return the last interval of the recorded clock that is not a step, s."""
    sound = np.flatnonzero(runs_on(np.diff(time)))
    return float(time[sound[-1] + 1] - time[sound[-1]]) if len(sound) else before.interval


def steps_of_clock(time: Array) -> NDArray[np.intp]:
    """Return the rows at which the recorded clock steps: back, not at all, or by more than a minute."""
    return np.flatnonzero(~runs_on(np.diff(time))) + 1


def runs_on(intervals: Array) -> NDArray[np.bool_]:
    """Return the mask of intervals between two rows that are not steps of the clock."""
    return (intervals > 0.0) & (intervals <= _LONGEST_INTERVAL)


class FileClock:
    """What the clock of a file shows: its first and last date, and repeated times; a checksum of its rows."""

    MOST_REPEATED = 0.1
    """Share of the rows in which a clock may repeat its time; chosen."""

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
        if share > self.MOST_REPEATED:
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
    dated = sorted((clock for clock in clocks if len(clock.dates)), key=lambda clock: float(clock.dates[0]))
    for one, other in pairwise(dated):
        overlap = one.dates[-1] - other.dates[0]
        if overlap > _LARGEST_OVERLAP:
            raise UnreadableError(
                f"{other.file}: begins {overlap:.0f} s before {one.file} ends, its stops would be found"
                " twice: cut one of them, or find the stops of each by itself"
            )
    return [clock.file for clock in (dated if len(dated) == len(clocks) else clocks)]


class Course:
    """The rows of a stretch with a clock without steps, the size of the speed, and the interruptions.

    Args:
        rows: of the stretch.
        before: what they follow. A clock and a distance that go on from it have the same bits wherever the
            stretch begins.

    """

    SHORTEST_RELEASE = 3.0
    """s: a shorter release belongs to the application: pressures fall where the WSP vents all; chosen."""
    RUN_OUT = 3.0
    """s after the release in which a train that still moves may come to its stop; chosen."""
    STANDS = 1.0
    """s in which a train that stands must be slow for more than half: less is a dropout; chosen."""
    BEFORE, AFTER = 5.0, 3.0
    """s that belong to a stop before the brake and after standstill; chosen."""
    LARGEST_JUMP = 2.0
    """m/s between the rows at a step of the clock: if more, the recording was interrupted; chosen."""
    REMARKED_GAP = 5.0
    """s without a row within a stop that a remark reports; chosen."""
    FALL, STEEPEST = 0.5, 5.0
    """s before standstill, and m/s2 by which a train slows down there: else its speed is lost; chosen."""
    HELD = 0.1
    """Share of the speed that drag braking loses at most; chosen."""
    LONG_HELD = 20.0
    """s for which a stop that keeps its speed after the application is remarked on; chosen."""
    ROWS_OF_SPEED = 6
    """Most known speeds up to the application whose median is its speed; chosen."""
    SECONDS_OF_SPEED = 1.0
    """s that these rows span at most; chosen."""
    TIE = 1e-6
    """s by which a sum of intervals may miss the time that it stands for."""
    REMARKED_STEPS = 3
    """Steps of the clock that a stop names one by one; chosen."""

    def __init__(self, rows: Rows, before: Before) -> None:
        self._rows, self._before = rows, before
        self.time, self.first_row = rows.time, before.row
        self.unusable = ~np.isfinite(rows.train)
        self.clock = continuous_clock(rows.time, before)
        self.braked, self.unknown = _brake_applied(self.clock, rows.braked)
        self.signed = reference_speed(self.clock, rows.train, rows.wheels, before)
        self.speed = np.abs(self.signed)
        self.travelled = _distance_travelled(self.clock, self.speed, before.travelled)
        self.steps = steps_of_clock(rows.time)
        jumps = ~(np.abs(np.diff(self.speed)) <= self.LARGEST_JUMP)
        self.interruptions = self.steps[jumps[self.steps - 1]]

    def before(self, row: int) -> Before:
        """Return the state before a stretch that begins at a row."""
        if row == 0:
            return self._before
        _, train, wheels, _ = self._rows
        return Before(
            self.first_row + row,
            float(self.clock[row]),
            last_interval(self.time[: row + 1], self._before),
            float(self.travelled[row]),
            constant_before(row, self.clock, train, wheels, self._before.train),
            constant_before(row, self.clock, wheels, train, self._before.wheels),
        )

    def row_before(self, row: int, seconds: float) -> int:
        """Return the first row at most so many seconds before a row."""
        return int(np.searchsorted(self.clock, self.clock[row] - seconds - self.TIE))

    def row_after(self, row: int, seconds: float) -> int:
        """Return the first row later than so many seconds after a row."""
        return int(np.searchsorted(self.clock, self.clock[row] + seconds + self.TIE, side="right"))

    def speed_at(self, first: int) -> float:
        """Return the speed at which the brake is applied in a row."""
        before = self.speed[self.row_before(first, self.SECONDS_OF_SPEED) : first + 1]
        known = before[np.isfinite(before)][-self.ROWS_OF_SPEED :]
        return float(np.median(known)) if len(known) else float("nan")

    def standstill(self, first: int, end: int, level: float) -> int | None:
        """Return the row at which a train that brakes from `first` to `end` falls to a speed and stays there.

        None where it does not, or only later than `RUN_OUT` after the release, or after an interruption.
        """
        last = self.row_after(end - 1, self.RUN_OUT)
        following = self.interruptions[self.interruptions > first]
        last = min(last, int(following[0])) if len(following) else last
        below = self.speed[first:last] <= level
        for k in map(int, first + np.flatnonzero(below & ~np.concatenate(([False], below[:-1])))):
            until = min(self.row_after(k, self.STANDS), last)
            if np.nanmedian(self.speed[k:until]) <= level and not self._drops_too_fast(first, k):
                return k
        return None

    def _drops_too_fast(self, first: int, row: int) -> bool:
        """Return whether the speed falls to its value in a row faster than a train can slow down."""
        before = max(min(self.row_before(row, self.FALL), row - 1), first)
        known = np.flatnonzero(np.isfinite(self.speed[first : before + 1]))
        before = first + int(known[-1]) if len(known) else before
        fall, seconds = self.speed[before] - self.speed[row], self.clock[row] - self.clock[before]
        return bool(fall > self.LARGEST_JUMP + self.STEEPEST * seconds)

    def rows_of(self, first: int, stop_row: int, released: int) -> tuple[int, int]:
        """Return the rows of an event with its lead, without what lies beyond a step of the clock.

        `released` is the row at which the application before ended.
        """
        begin = max(released, self.row_before(first, self.BEFORE))
        end = self.row_after(stop_row, self.AFTER)
        before = self.steps[(self.steps > begin) & (self.steps <= first)]
        after = self.steps[(self.steps > stop_row) & (self.steps < end)]
        return (int(before[-1]) if len(before) else begin, int(after[0]) if len(after) else end)

    def applications(self) -> Iterator[tuple[int, int]]:
        """Yield first row and the row after the last of every application; an interruption ends one."""
        pieces = [
            rows
            for rows in _braked_stretches(self.braked, self.interruptions)
            if self._lasts_long_enough(*rows)
        ]
        pieces.reverse()
        while pieces:
            first, end = pieces.pop()
            while pieces and self._continues_application(end, pieces[-1][0]):
                _, end = pieces.pop()
            yield first, end

    def _lasts_long_enough(self, first: int, end: int) -> bool:
        """Return whether the brake is applied for longer than noise of its signal."""
        seconds = self.clock[min(end, len(self.clock) - 1)] - self.clock[first]
        return bool(seconds >= SHORTEST_APPLICATION - self.TIE)

    def is_whole(self, end: int) -> bool:
        """Return whether the record goes on after an application that ends before row `end`."""
        if end == len(self.clock) or end in self.interruptions:
            return False
        return bool(self.clock[end] - self.clock[end - 1] <= self.RUN_OUT)

    def _continues_application(self, end: int, begin: int) -> bool:
        """Return whether rows from `begin` on belong to the application that ended before row `end`."""
        interrupted = np.any((self.interruptions >= end) & (self.interruptions <= begin))
        return bool(self.clock[begin] - self.clock[end] < self.SHORTEST_RELEASE and not interrupted)

    def remarks(self, rows: tuple[int, int], first: int, stop_row: int) -> Iterator[str]:
        """Yield remarks on an event: its `rows`, the first row of the application, the row of its end."""
        begin, end = rows
        inside = self.steps[(self.steps > begin) & (self.steps < end)]
        for row in inside[: self.REMARKED_STEPS]:
            step = self.time[row] - self.time[row - 1]
            yield f"the clock steps by {step:+.6g} s at sample {row - begin + 1} of the stop"
        if len(inside) > self.REMARKED_STEPS:
            yield f"{len(inside) - self.REMARKED_STEPS} further steps of the clock"
        if np.nanmedian(np.append(self.signed[begin:end], 0.0)) < 0.0:
            yield "runs backwards: speeds are recorded with their sign changed"
        gaps = np.diff(self.time[first : stop_row + 1])
        yield from (
            f"not recorded for {gap:.6g} s" for gap in gaps[(gaps > self.REMARKED_GAP) & runs_on(gaps)]
        )
        if self.unusable[begin:end].any():
            yield "the train speed is missing in part"
        if self.unknown[begin:end].any():
            yield "the brake signal is missing in part"
        slower = np.flatnonzero(self.speed[first : stop_row + 1] < (1.0 - self.HELD) * self.speed_at(first))
        if len(slower) and (seconds := self.clock[first + slower[0]] - self.clock[first]) > self.LONG_HELD:
            yield f"the speed is kept for {seconds:.0f} s after the brake is applied"


def _brake_applied(clock: Array, signal: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return two masks of rows: the brake counts as applied, its signal is missing for long.

    A signal that is missing for less than a release is held; for longer the brake may be applied at any time.
    """
    rows, known = np.arange(len(signal)), np.isfinite(signal)
    before = np.maximum.accumulate(np.where(known, rows, 0))
    after = np.minimum.accumulate(np.where(known, rows, len(rows) - 1)[::-1])[::-1]
    unknown = ~known & (clock[after] - clock[before] > Course.SHORTEST_RELEASE)
    return (signal[before] > 0.0) | unknown, unknown


def _braked_stretches(
    braked: NDArray[np.bool_], interruptions: NDArray[np.intp]
) -> Iterator[tuple[int, int]]:
    """Yield every stretch with the brake applied, cut where the recording was interrupted."""
    padded = np.concatenate(([False], braked, [False]))
    starts, ends = np.flatnonzero(padded[1:] & ~padded[:-1]), np.flatnonzero(~padded[1:] & padded[:-1])
    for start, end in zip(starts, ends, strict=True):
        inside = interruptions[(interruptions > start) & (interruptions < end)]
        yield from pairwise([int(start), *map(int, inside), int(end)])


def _distance_travelled(clock: Array, speed: Array, travelled: float) -> Array:
    known = np.nan_to_num(speed)
    return np.cumsum(np.concatenate(([travelled], 0.5 * (known[1:] + known[:-1]) * np.diff(clock))))

"""The course of a stretch of a log: its clock, the speed, and the applications of the brake in it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from uictest.recorded.field_data import SHORTEST_APPLICATION
from uictest.recorded.service_log.clocks import continuous_clock, last_interval, runs_on, steps_of_clock
from uictest.recorded.service_log.signals import Array, Before, Rows, constant_before, reference_speed

SHORTEST_RELEASE = 3.0
"""s: a shorter release belongs to the application: pressures fall where the WSP vents all; chosen."""
_RUN_OUT = 3.0
"""s after the release in which a train that still moves may come to its stop; chosen."""
_STANDS = 1.0
"""s in which a train that stands must be slow for more than half: less is a dropout; chosen."""
_BEFORE, _AFTER = 5.0, 3.0
"""s that belong to a stop before the brake and after standstill; chosen."""
_LARGEST_JUMP = 2.0
"""m/s between two rows beside a step of the clock: more, and the recording was interrupted; chosen."""
_TOLD_GAP = 5.0
"""s without a row within a stop that are told; chosen."""
_FALL, _STEEPEST = 0.5, 5.0
"""s before standstill, and m/s2 by which a train slows down there at most: else its speed is lost; chosen."""
HELD = 0.1
"""Share of the speed that drag braking loses at most; chosen."""
_LONG_HELD = 20.0
"""s for which a stop that keeps its speed after the application is remarked on; chosen."""
ROWS_OF_SPEED = 6
"""Most known speeds up to the application whose median is its speed; chosen."""
_SECONDS_OF_SPEED = 1.0
"""s that these rows span at most; chosen."""
_TIE = 1e-6
"""s by which a sum of intervals may miss the time that it stands for."""
_REMARKED_STEPS = 3
"""Steps of the clock that a stop names one by one; chosen."""


class Course:
    """The rows of a stretch with a clock without steps, the size of the speed, and the interruptions.

    Args:
        rows: of the stretch.
        before: what they follow. A clock and a distance that go on from it have the same bits wherever the
            stretch begins.

    """

    def __init__(self, rows: Rows, before: Before) -> None:
        self._rows, self._before = rows, before
        self.time, self.first_row = rows.time, before.row
        self.unusable = ~np.isfinite(rows.train)
        self.clock = continuous_clock(rows.time, before)
        self.braked, self.unknown = _applied(self.clock, rows.braked)
        self.signed = reference_speed(self.clock, rows.train, rows.wheels, before)
        self.speed = np.abs(self.signed)
        self.travelled = _distance(self.clock, self.speed, before.travelled)
        self.steps = steps_of_clock(rows.time)
        jumps = ~(np.abs(np.diff(self.speed)) <= _LARGEST_JUMP)
        self.interruptions = self.steps[jumps[self.steps - 1]]

    def before(self, row: int) -> Before:
        """Return what a stretch follows that begins at a row."""
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
        return int(np.searchsorted(self.clock, self.clock[row] - seconds - _TIE))

    def row_after(self, row: int, seconds: float) -> int:
        """Return the first row later than so many seconds after a row."""
        return int(np.searchsorted(self.clock, self.clock[row] + seconds + _TIE, side="right"))

    def speed_at(self, first: int) -> float:
        """Return the speed at which the brake is applied in a row."""
        before = self.speed[self.row_before(first, _SECONDS_OF_SPEED) : first + 1]
        known = before[np.isfinite(before)][-ROWS_OF_SPEED:]
        return float(np.median(known)) if len(known) else float("nan")

    def standstill(self, first: int, end: int, level: float) -> int | None:
        """Return the row at which a train that brakes from `first` to `end` falls to a speed and stays there.

        None where it does not, or longer than `_RUN_OUT` after the release, or behind an interruption.
        """
        last = self.row_after(end - 1, _RUN_OUT)
        following = self.interruptions[self.interruptions > first]
        last = min(last, int(following[0])) if len(following) else last
        below = self.speed[first:last] <= level
        for k in map(int, first + np.flatnonzero(below & ~np.concatenate(([False], below[:-1])))):
            until = min(self.row_after(k, _STANDS), last)
            if np.nanmedian(self.speed[k:until]) <= level and not self._drops(first, k):
                return k
        return None

    def _drops(self, first: int, row: int) -> bool:
        """Return whether the speed falls to that of a row faster than a train slows down."""
        before = max(min(self.row_before(row, _FALL), row - 1), first)
        known = np.flatnonzero(np.isfinite(self.speed[first : before + 1]))
        before = first + int(known[-1]) if len(known) else before
        fall, seconds = self.speed[before] - self.speed[row], self.clock[row] - self.clock[before]
        return bool(fall > _LARGEST_JUMP + _STEEPEST * seconds)

    def rows_of(self, first: int, stop_row: int, released: int) -> tuple[int, int]:
        """Return the rows of an event with its lead, without what lies beyond a step of the clock.

        `released` is the row at which the application before ended.
        """
        begin = max(released, self.row_before(first, _BEFORE))
        end = self.row_after(stop_row, _AFTER)
        before = self.steps[(self.steps > begin) & (self.steps <= first)]
        after = self.steps[(self.steps > stop_row) & (self.steps < end)]
        return (int(before[-1]) if len(before) else begin, int(after[0]) if len(after) else end)

    def applications(self) -> Iterator[tuple[int, int]]:
        """Yield first row and the row after the last of every application; an interruption ends one."""
        pieces = [each for each in _pieces(self.braked, self.interruptions) if self._lasts(*each)]
        pieces.reverse()
        while pieces:
            first, end = pieces.pop()
            while pieces and self._goes_on(end, pieces[-1][0]):
                _, end = pieces.pop()
            yield first, end

    def _lasts(self, first: int, end: int) -> bool:
        """Return whether rows with the brake applied are no noise."""
        seconds = self.clock[min(end, len(self.clock) - 1)] - self.clock[first]
        return bool(seconds >= SHORTEST_APPLICATION - _TIE)

    def is_whole(self, end: int) -> bool:
        """Return whether the record shows what follows an application that ends before row `end`."""
        if end == len(self.clock) or end in self.interruptions:
            return False
        return bool(self.clock[end] - self.clock[end - 1] <= _RUN_OUT)

    def _goes_on(self, end: int, begin: int) -> bool:
        """Whether the stretch from row `begin` belongs to the application that ended before row `end`."""
        interrupted = np.any((self.interruptions >= end) & (self.interruptions <= begin))
        return bool(self.clock[begin] - self.clock[end] < SHORTEST_RELEASE and not interrupted)

    def remarks(self, rows: tuple[int, int], first: int, stop_row: int) -> Iterator[str]:
        """Yield what is unusual about an event: its rows, where it is applied and where it ends."""
        begin, end = rows
        inside = self.steps[(self.steps > begin) & (self.steps < end)]
        for row in inside[:_REMARKED_STEPS]:
            step = self.time[row] - self.time[row - 1]
            yield f"the clock steps by {step:+.6g} s at sample {row - begin + 1} of the stop"
        if len(inside) > _REMARKED_STEPS:
            yield f"{len(inside) - _REMARKED_STEPS} further steps of the clock"
        if np.nanmedian(np.append(self.signed[begin:end], 0.0)) < 0.0:
            yield "runs backwards: speeds are recorded with their sign changed"
        gaps = np.diff(self.time[first : stop_row + 1])
        yield from (f"not recorded for {gap:.6g} s" for gap in gaps[(gaps > _TOLD_GAP) & runs_on(gaps)])
        if self.unusable[begin:end].any():
            yield "the train speed is missing in part"
        if self.unknown[begin:end].any():
            yield "the brake signal is missing in part"
        slower = np.flatnonzero(self.speed[first : stop_row + 1] < (1.0 - HELD) * self.speed_at(first))
        if len(slower) and (seconds := self.clock[first + slower[0]] - self.clock[first]) > _LONG_HELD:
            yield f"the speed is kept for {seconds:.0f} s after the brake is applied"


def _applied(clock: Array, signal: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return whether the brake counts as applied, and whether its signal is missing for long.

    A signal that is missing for less than a release is held; for longer the brake may be applied at any time.
    """
    rows, known = np.arange(len(signal)), np.isfinite(signal)
    before = np.maximum.accumulate(np.where(known, rows, 0))
    after = np.minimum.accumulate(np.where(known, rows, len(rows) - 1)[::-1])[::-1]
    unknown = ~known & (clock[after] - clock[before] > SHORTEST_RELEASE)
    return (signal[before] > 0.0) | unknown, unknown


def _pieces(braked: NDArray[np.bool_], interruptions: NDArray[np.intp]) -> Iterator[tuple[int, int]]:
    """Yield every stretch with the brake applied, cut where the recording was interrupted."""
    padded = np.concatenate(([False], braked, [False]))
    starts, ends = np.flatnonzero(padded[1:] & ~padded[:-1]), np.flatnonzero(~padded[1:] & padded[:-1])
    for start, end in zip(starts, ends, strict=True):
        inside = interruptions[(interruptions > start) & (interruptions < end)]
        yield from pairwise([int(start), *map(int, inside), int(end)])


def _distance(clock: Array, speed: Array, travelled: float) -> Array:
    known = np.nan_to_num(speed)
    return np.cumsum(np.concatenate(([travelled], 0.5 * (known[1:] + known[:-1]) * np.diff(clock))))

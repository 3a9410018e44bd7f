"""Finds every application of the brake in a log, and which of them are stops."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.recorded.field_data import ChannelMap
from uictest.recorded.service_log.signals import (
    Array,
    Signals,
    continuous_clock,
    read_signals,
    steps_of_clock,
)

_SHORTEST_RELEASE = 1.0
"""s: a shorter release belongs to the application: pressures fall where the WSP vents; chosen."""
_SHORTEST_APPLICATION = 0.1
"""s: no brake acts so briefly, what is shorter is noise; chosen."""
_RUN_OUT = 3.0
"""s after the release in which a train that still moves may come to its stop; chosen."""
_STANDS = 1.0
"""s in which a train that stands must be slow for more than half: less is a dropout; chosen."""
_BEFORE, _AFTER = 5.0, 3.0
"""s that belong to a stop before the brake and after standstill; chosen."""
_LARGEST_JUMP = 2.0
"""m/s between two rows beside a step of the clock: more, and the recording was interrupted; chosen."""
_HELD = 0.1
"""Share of the speed that drag braking loses at most; chosen."""
_LONG_HELD = 20.0
"""s for which a stop that keeps its speed after the application is remarked on; chosen."""
_ROWS_OF_SPEED = 6
"""Rows up to the application whose median is its speed; chosen."""
_REMARKED_STEPS = 3
"""Steps of the clock that a stop names one by one; chosen."""


@dataclass(frozen=True, slots=True)
class FinderSettings:
    """Which applications of the brake are stops.

    Args:
        from_speed: least speed at which the brake is applied, m/s.
        to_speed: speed down to which the train must come, m/s; 0: standstill, below `standstill_speed`.

    """

    from_speed: float = 20.0 * KILOMETRE_PER_HOUR
    to_speed: float = 0.0


@dataclass(frozen=True, slots=True)
class LoggedEvent:
    """One application of the brake: a stop, or passed over with a reason.

    Args:
        file: in which it begins.
        row: sample in that file at which the brake is applied, from zero.
        time: recorded there, s.
        distance: from the beginning of the file by the speed, m.
        speed: at which the brake is applied, m/s.
        end_speed: at the end of the application, m/s.
        rows: first row and the one after the last of what belongs to it, over all files.
        begins_braked: whether the brake is applied from the first of these rows on.
        reason: why it is no stop; empty for a stop.
        remarks: what is unusual about it: steps of the clock, running backwards.

    """

    file: Path
    row: int
    time: float
    distance: float
    speed: float
    end_speed: float
    rows: tuple[int, int]
    begins_braked: bool
    reason: str = ""
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """Stops of a log, and what was passed over, each in the order of the log.

    Args:
        files: of the log.
        first_rows: row with which each file begins, and the number of all rows.
        stops: found.
        passed_over: every other application of the brake.

    """

    files: Sequence[Path]
    first_rows: Sequence[int]
    stops: tuple[LoggedEvent, ...]
    passed_over: tuple[LoggedEvent, ...]


def find_stops(files: Sequence[Path], channel_map: ChannelMap, settings: FinderSettings | None = None) -> Log:
    """Return the stops in a log of one or several files, which follow each other.

    Raises UnreadableError, MapError, OSError.
    """
    signals = read_signals(files, channel_map)
    standstill = float(channel_map.preparation.standstill_speed)
    events = list(_events(_Course(signals), settings or FinderSettings(), standstill))
    return Log(
        files,
        signals.first_rows,
        tuple(event for event in events if not event.reason),
        tuple(event for event in events if event.reason),
    )


class _Course:
    """The course of a log: its clock without steps, the size of its speed, and where it was interrupted."""

    def __init__(self, signals: Signals) -> None:
        self.signals = signals
        self.clock, self.speed = continuous_clock(signals.time), np.abs(signals.speed)
        self.travelled = _distance(self.clock, self.speed)
        self.steps = steps_of_clock(signals.time)
        jumps = ~(np.abs(np.diff(self.speed)) <= _LARGEST_JUMP)
        self.interruptions = self.steps[jumps[self.steps - 1]]

    def row_after(self, row: int, seconds: float) -> int:
        """Return the first row later than so many seconds after a row."""
        return int(np.searchsorted(self.clock, self.clock[row] + seconds, side="right"))

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
            if np.nanmedian(self.speed[k:until]) <= level:
                return k
        return None

    def rows_of(self, first: int, stop_row: int, released: int) -> tuple[int, int]:
        """Return the rows of an event with its lead, without what lies beyond a step of the clock.

        `released` is the row at which the application before ended.
        """
        begin = max(released, int(np.searchsorted(self.clock, self.clock[first] - _BEFORE)))
        end = self.row_after(stop_row, _AFTER)
        before = self.steps[(self.steps > begin) & (self.steps <= first)]
        after = self.steps[(self.steps > stop_row) & (self.steps < end)]
        return (int(before[-1]) if len(before) else begin, int(after[0]) if len(after) else end)


def _events(course: _Course, settings: FinderSettings, standstill: float) -> Iterator[LoggedEvent]:
    signals, lowest = course.signals, max(settings.to_speed, standstill)
    released = 0
    for first, end in _applications(course):
        rest = course.standstill(first, end, lowest)
        stop_row = end - 1 if rest is None else rest
        rows = course.rows_of(first, stop_row, released)
        initial, final = _speed_at(course.speed, first), float(course.speed[stop_row])
        whole = end < len(course.clock) and end not in course.interruptions
        place = int(np.searchsorted(signals.first_rows, first, side="right")) - 1
        begin = signals.first_rows[place]
        yield LoggedEvent(
            signals.files[place],
            first - begin,
            float(signals.time[first]),
            float(course.travelled[first] - course.travelled[begin]),
            initial,
            final,
            rows,
            rows[0] == first,
            "" if _is_stop(initial, rest, settings) else _reason(initial, final, whole, lowest, settings),
            (*_remarks(course, rows), *_held(course, first, stop_row, initial)),
        )
        released = end


def _held(course: _Course, first: int, stop_row: int, initial: float) -> Iterator[str]:
    """Yield for how long the brake dragged before the train slowed down."""
    slower = np.flatnonzero(course.speed[first : stop_row + 1] < (1.0 - _HELD) * initial)
    if len(slower) and (seconds := course.clock[first + slower[0]] - course.clock[first]) > _LONG_HELD:
        yield f"the speed is kept for {seconds:.0f} s after the brake is applied"


def _applications(course: _Course) -> Iterator[tuple[int, int]]:
    """Yield first row and the row after the last of every application; an interruption ends one."""
    pieces = list(_pieces(course.signals.braked, course.interruptions))
    pieces.reverse()
    while pieces:
        first, end = pieces.pop()
        while pieces and _goes_on(course, end, pieces[-1][0]):
            _, end = pieces.pop()
        last = min(end, len(course.clock) - 1)
        if course.clock[last] - course.clock[first] >= _SHORTEST_APPLICATION:
            yield first, end


def _pieces(braked: NDArray[np.bool_], interruptions: NDArray[np.intp]) -> Iterator[tuple[int, int]]:
    """Yield every stretch with the brake applied, cut where the recording was interrupted."""
    padded = np.concatenate(([False], braked, [False]))
    starts, ends = np.flatnonzero(padded[1:] & ~padded[:-1]), np.flatnonzero(~padded[1:] & padded[:-1])
    for start, end in zip(starts, ends, strict=True):
        inside = interruptions[(interruptions > start) & (interruptions < end)]
        yield from pairwise([int(start), *map(int, inside), int(end)])


def _goes_on(course: _Course, end: int, begin: int) -> bool:
    """Whether the stretch from row `begin` belongs to the application that ended before row `end`."""
    interrupted = np.any((course.interruptions >= end) & (course.interruptions <= begin))
    return bool(course.clock[begin] - course.clock[end] < _SHORTEST_RELEASE and not interrupted)


def _distance(clock: Array, speed: Array) -> Array:
    known = np.nan_to_num(speed)
    return np.concatenate(([0.0], np.cumsum(0.5 * (known[1:] + known[:-1]) * np.diff(clock))))


def _speed_at(speed: Array, first: int) -> float:
    before = speed[max(first + 1 - _ROWS_OF_SPEED, 0) : first + 1]
    return float(np.nanmedian(before)) if np.isfinite(before).any() else float("nan")


def _is_stop(initial: float, rest: int | None, settings: FinderSettings) -> bool:
    return rest is not None and initial >= settings.from_speed


def _reason(initial: float, final: float, whole: bool, lowest: float, settings: FinderSettings) -> str:
    """Return why an application of the brake is no stop."""
    kmh = KILOMETRE_PER_HOUR
    if not np.isfinite(initial):
        return "the speed is not known when the brake is applied"
    if initial <= lowest:
        return "without motion"
    if initial < settings.from_speed:
        return f"from {initial / kmh:.1f} km/h, below {settings.from_speed / kmh:g} km/h"
    if not whole:
        return f"the recording ends or is interrupted at {final / kmh:.1f} km/h"
    if final > (1.0 - _HELD) * initial:
        return f"drag braking: released at {final / kmh:.1f} of {initial / kmh:.1f} km/h"
    return f"released at {final / kmh:.1f} km/h"


def _remarks(course: _Course, rows: tuple[int, int]) -> Iterator[str]:
    signals, (begin, end) = course.signals, rows
    inside = course.steps[(course.steps > begin) & (course.steps < end)]
    for row in inside[:_REMARKED_STEPS]:
        step = signals.time[row] - signals.time[row - 1]
        yield f"the clock steps by {step:+.6g} s at sample {row - begin + 1} of the stop"
    if len(inside) > _REMARKED_STEPS:
        yield f"{len(inside) - _REMARKED_STEPS} further steps of the clock"
    if np.nanmedian(np.append(signals.speed[begin:end], 0.0)) < 0.0:
        yield "runs backwards: speeds are recorded with their sign changed"
    if signals.unusable[begin:end].any():
        yield "the train speed is missing in part"

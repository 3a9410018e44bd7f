"""Finds every application of the brake in a log, and which of them are stops."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.recorded.field_data import ChannelMap
from uictest.recorded.service_log.signals import LONGEST_STEP, Array, Signals, continuous_clock, read_signals

_SHORTEST_RELEASE = 1.0
"""s: a shorter release belongs to the application: pressures fall where the WSP vents; chosen."""
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
    events = list(_events(signals, settings or FinderSettings(), standstill))
    return Log(
        files,
        signals.first_rows,
        tuple(event for event in events if not event.reason),
        tuple(event for event in events if event.reason),
    )


def _events(signals: Signals, settings: FinderSettings, standstill: float) -> Iterator[LoggedEvent]:
    clock, speed = continuous_clock(signals.time), np.abs(signals.speed)
    lowest = max(settings.to_speed, standstill)
    travelled = _distance(clock, speed)
    released = 0
    for first, end in _applications(clock, signals, speed):
        last = int(np.searchsorted(clock, clock[end - 1] + _RUN_OUT, side="right"))
        following = np.flatnonzero(_interruptions(signals.time[first:last], speed[first:last]))
        last = first + int(following[0]) + 1 if len(following) else last
        rest = _standing(clock[first:last], speed[first:last], lowest)
        initial = _initial_speed(speed[max(first - 5, 0) : first + 1])
        stop_row = end - 1 if rest is None else first + rest
        cut = max(released, int(np.searchsorted(clock, clock[first] - _BEFORE)))
        until = int(np.searchsorted(clock, clock[stop_row] + _AFTER, side="right"))
        rows = _unbroken(signals.time, speed, cut, first, stop_row, until)
        final = float(speed[stop_row])
        whole = (
            end < len(clock)
            and not _interruptions(signals.time[end - 1 : end + 1], speed[end - 1 : end + 1]).any()
        )
        reason = _reason(initial, final, rest is not None, whole, lowest, settings)
        file = int(np.searchsorted(signals.first_rows, first, side="right")) - 1
        begin = signals.first_rows[file]
        yield LoggedEvent(
            signals.files[file],
            first - begin,
            float(signals.time[first]),
            float(travelled[first] - travelled[begin]),
            initial,
            final,
            rows,
            reason,
            tuple(_remarks(signals, rows)),
        )
        released = end


def _applications(clock: Array, signals: Signals, speed: Array) -> Iterator[tuple[int, int]]:
    """Yield first row and the row after the last of every application; an interruption ends one."""
    braked = np.concatenate(([False], signals.braked, [False]))
    starts, ends = np.flatnonzero(braked[1:] & ~braked[:-1]), np.flatnonzero(~braked[1:] & braked[:-1])
    breaks = np.flatnonzero(_interruptions(signals.time, speed)) + 1
    pieces = [
        (a, b)
        for start, end in zip(starts, ends, strict=True)
        for a, b in _split(int(start), int(end), breaks)
    ]
    while pieces:
        first, end = pieces.pop(0)
        while (
            pieces
            and pieces[0][0] > end
            and clock[pieces[0][0]] - clock[end] < _SHORTEST_RELEASE
            and not np.any((breaks > first) & (breaks <= pieces[0][0]))
        ):
            end = pieces.pop(0)[1]
        yield first, end


def _split(start: int, end: int, breaks: np.ndarray) -> Iterator[tuple[int, int]]:
    inside = breaks[(breaks > start) & (breaks < end)]
    edges = [start, *map(int, inside), end]
    yield from pairwise(edges)


def _interruptions(time: Array, speed: Array) -> np.ndarray:
    """Return between which rows the clock steps and the train has another speed afterwards."""
    steps = np.diff(time)
    stepped = ~((steps > 0.0) & (steps <= LONGEST_STEP))
    return np.asarray(stepped & ~(np.abs(np.diff(speed)) <= _LARGEST_JUMP))


def _distance(clock: Array, speed: Array) -> Array:
    known = np.nan_to_num(speed)
    return np.concatenate(([0.0], np.cumsum(0.5 * (known[1:] + known[:-1]) * np.diff(clock))))


def _initial_speed(speed: Array) -> float:
    return float(np.nanmedian(speed)) if np.isfinite(speed).any() else float("nan")


def _standing(clock: Array, speed: Array, level: float) -> int | None:
    """Return the first row at which the train falls to a speed and stays there for longer than a dropout."""
    below = speed <= level
    for k in np.flatnonzero(below & ~np.concatenate(([False], below[:-1]))):
        end = int(np.searchsorted(clock, clock[k] + _STANDS, side="right"))
        if np.nanmedian(speed[k:end]) <= level:
            return int(k)
    return None


def _unbroken(time: Array, speed: Array, cut: int, first: int, stop_row: int, until: int) -> tuple[int, int]:
    """Return the rows of an event without what lies beyond a step of the clock before or after it."""
    steps = np.flatnonzero(~((np.diff(time[cut:until]) > 0.0) & (np.diff(time[cut:until]) <= LONGEST_STEP)))
    steps += cut + 1
    before, after = steps[steps <= first], steps[steps > stop_row]
    return (int(before[-1]) if len(before) else cut, int(after[0]) if len(after) else until)


def _reason(
    initial: float, final: float, stands: bool, whole: bool, lowest: float, settings: FinderSettings
) -> str:
    """Return why an application of the brake is no stop; empty where it is one."""
    kmh = KILOMETRE_PER_HOUR
    if not np.isfinite(initial):
        return "the speed is not known when the brake is applied"
    if initial <= lowest:
        return "without motion"
    if initial < settings.from_speed:
        return f"from {initial / kmh:.1f} km/h, below {settings.from_speed / kmh:g} km/h"
    if stands:
        return ""
    if not whole:
        return f"the recording ends or is interrupted at {final / kmh:.1f} km/h"
    if final > (1.0 - _HELD) * initial:
        return f"drag braking: released at {final / kmh:.1f} of {initial / kmh:.1f} km/h"
    return f"released at {final / kmh:.1f} km/h"


def _remarks(signals: Signals, rows: tuple[int, int]) -> Iterator[str]:
    part = slice(*rows)
    steps = np.diff(signals.time[part])
    for k in np.flatnonzero(~((steps > 0.0) & (steps <= LONGEST_STEP)))[:3]:
        yield f"the clock steps by {steps[k]:+.6g} s at sample {rows[0] + int(k) + 1}"
    if np.nanmedian(np.append(signals.speed[part], 0.0)) < 0.0:
        yield "runs backwards: speeds are recorded with their sign changed"
    if signals.unusable[part].any():
        yield "the train speed is missing in part"

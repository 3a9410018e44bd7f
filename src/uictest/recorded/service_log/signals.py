"""What the finder reads of a log: clock, speed and brake of every row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats import UnreadableError
from uictest.recorded.field_data import ChannelMap, MapError, RawChannel, of_wheelsets
from uictest.recorded.service_log.channels import pieces_of

Array = NDArray[np.float64]
WHEELS = of_wheelsets("wheel_speed")
_COMMAND, _DEMAND, _LINE = ("brake_command",), ("demanded_pressure",), ("brake_line_pressure",)
_CYLINDERS = of_wheelsets("cylinder_pressure")
_NEEDED = (*WHEELS, *_COMMAND, *_DEMAND, *_LINE, *_CYLINDERS)
SHOWN_BY: Final = {
    "auto": (_COMMAND, _DEMAND, _LINE, _CYLINDERS),
    "command": (_COMMAND,),
    "demand": (_DEMAND,),
    "pressure": (_LINE, _CYLINDERS),
}
"""What shows in a log that the brake is applied, by the trigger of its channel map; the first that it has."""
_ON = 0.5
"""Above it the brake command, a state of 0 and 1, is given."""
_RELEASED = 1.0
"""Percentile of a pressure at which the brake counts as released; chosen."""
_LARGEST_OFFSET = 0.5e5
"""Pa that a sensor shows at most with the brake released; chosen."""
_LEAST_STUCK = 2.0
"""s for which a speed may show one number to the last digit while the wheels change theirs; chosen."""
_TELLING_CHANGE = 0.5
"""m/s by which the wheels must change meanwhile; chosen."""
_LONGEST_INTERVAL = 60.0
"""s: a longer interval between two rows is a step of the clock or an interruption; chosen."""


@dataclass(frozen=True, slots=True, eq=False)
class Signals:
    """Rows of one log, over all of its files.

    Args:
        time: as recorded, s.
        speed: of the train with its sign, m/s; from the wheels where its own sensor is dead.
        braked: whether the brake is applied.
        unusable: whether a row could not be read in the units of the channel map.
        files: of the log, in order.
        first_rows: row with which each file begins, and the number of all rows.

    """

    time: Array
    speed: Array
    braked: NDArray[np.bool_]
    unusable: NDArray[np.bool_]
    files: Sequence[Path]
    first_rows: Sequence[int]


def read_signals(files: Sequence[Path], channel_map: ChannelMap) -> Signals:
    """Read speed and brake of all files, piece by piece.

    Raises UnreadableError, MapError where a file has no speed or nothing that shows the brake; OSError.
    """
    columns: list[tuple[Array, ...]] = []
    first_rows = [0]
    for path in files:
        try:
            pieces = pieces_of(path, channel_map, _NEEDED)
            rows = [_rows(piece.channels, channel_map.preparation.trigger) for piece in pieces]
        except (UnreadableError, MapError) as error:
            raise type(error)(f"{path}: {error}") from error
        if not rows:
            raise UnreadableError(f"{path}: no samples")
        *own, command, pressure = (np.concatenate(column) for column in zip(*rows, strict=True))
        columns.append((*own, _braked(command, pressure, float(channel_map.preparation.trigger_pressure))))
        first_rows.append(first_rows[-1] + len(own[0]))
    time, train, wheels, braked = (np.concatenate(column) for column in zip(*columns, strict=True))
    speed = _reference_speed(continuous_clock(time), train, wheels)
    return Signals(time, speed, braked > 0.0, ~np.isfinite(train), files, first_rows)


def _rows(channels: dict[str, RawChannel], trigger: str) -> tuple[Array, ...]:
    """Return time, speeds of train and wheels, and what shows the brake: its command, else a pressure."""
    speed = channels["speed"]
    none = np.full(len(speed.time), np.nan)
    wheels = [channels[name].samples for name in WHEELS if name in channels]
    second = _second_largest(wheels) if len(wheels) > 1 else none
    for names in SHOWN_BY[trigger]:
        shown = [channels[name].samples for name in names if name in channels]
        if shown and names == _COMMAND:
            return speed.time, speed.samples, second, shown[0], none
        if shown:
            return speed.time, speed.samples, second, none, np.fmax.reduce(shown)
    looked_for = ", ".join(name for names in SHOWN_BY[trigger] for name in names)
    raise MapError(f"nothing shows when the brake is applied: map one of {looked_for}")


def _braked(command: Array, pressure: Array, rise: float) -> Array:
    """Return 1 where the brake of a file is applied: by its command, else where a pressure has risen.

    A sensor may show some pressure with the brake released: the median of what lies within that rise of the
    lowest hundredth of the file, unless that is too much for an offset, as where the brake is hardly ever
    released.
    """
    known = pressure[np.isfinite(pressure)]
    lowest = float(np.percentile(known, _RELEASED)) if len(known) else 0.0
    offset = float(np.median(known[known <= lowest + rise])) if len(known) else 0.0
    released = offset if 0.0 < offset <= _LARGEST_OFFSET else 0.0
    return ((command > _ON) | (pressure > released + rise)).astype(np.float64)


def _second_largest(wheels: Sequence[Array]) -> Array:
    """Return the speed that at least two wheelsets reach, with its sign: no single sensor makes it."""
    stacked = np.stack(wheels)
    sign = np.where(np.nansum(np.nan_to_num(stacked), axis=0) < 0.0, -1.0, 1.0)
    ordered = np.sort(np.where(np.isfinite(stacked), np.abs(stacked), -1.0), axis=0)
    return np.where(ordered[-2] >= 0.0, sign * ordered[-2], np.nan)


def _reference_speed(clock: Array, train: Array, wheels: Array) -> Array:
    """Return the train speed, and that of the wheels where its sensor shows none, zero or one number."""
    dead = ~np.isfinite(train) | (np.abs(train) < 0.5 * np.abs(wheels) - 1.0)
    edges = np.concatenate(([0], np.flatnonzero(np.diff(train) != 0.0) + 1, [len(train)]))
    firsts, ends = edges[:-1], edges[1:]
    long = (clock[ends - 1] - clock[firsts] > _LEAST_STUCK) & (train[firsts] != 0.0)
    for first, end in zip(firsts[long], ends[long], strict=True):
        dead[first:end] |= bool(np.ptp(wheels[first:end]) > _TELLING_CHANGE)
    return np.where(dead & np.isfinite(wheels), wheels, train)


def continuous_clock(time: Array) -> Array:
    """Return a clock that runs on where the recorded one steps: there it takes the usual interval."""
    intervals = np.diff(time)
    sound = _runs_on(intervals)
    usual = float(np.median(intervals[sound])) if sound.any() else 1.0
    return np.concatenate(([0.0], np.cumsum(np.where(sound, intervals, usual))))


def steps_of_clock(time: Array) -> NDArray[np.intp]:
    """Return the rows at which the recorded clock steps: back, not at all, or by more than a minute."""
    return np.flatnonzero(~_runs_on(np.diff(time))) + 1


def _runs_on(intervals: Array) -> NDArray[np.bool_]:
    return (intervals > 0.0) & (intervals <= _LONGEST_INTERVAL)

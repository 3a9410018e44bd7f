"""What is read of a log, piece by piece: all channels over one time; clock, speed and brake of every row."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import TIME, beyond, state_kind, usual_interval
from uictest.core.recording.formats import DAY, UnreadableError, is_clock, read_pieces
from uictest.recorded.field_data import (
    CHANNEL_UNITS,
    ChannelMap,
    MapError,
    RawChannel,
    at_own_rates,
    of_wheelsets,
    resampled,
    select_channels,
)

Array = NDArray[np.float64]

_SPEED = "speed"


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Channels over the time of the train speed, in SI, and how far apart their own samples are, s."""

    channels: dict[str, RawChannel]
    intervals: dict[str, float]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.channels[_SPEED].time)


def pieces_of(path: Path, channel_map: ChannelMap, needed: Collection[str] | None = None) -> Iterator[Piece]:
    """Yield the channels of a file, piece by piece: the train speed and the `needed` ones, None: all.

    The first piece shows whether the units fit. Implausible samples are NaN.

    Raises UnreadableError, MissingExtraError, MapError, OSError.
    """
    sources = channel_map.sources
    chosen = sources if needed is None else {TIME, _SPEED, *needed}
    names = {alias for name in chosen if name in sources for alias in sources[name].source}
    leading = sources[_SPEED].source if _SPEED in sources else ()
    states = [source for name, source in sources.items() if source.states or state_kind(name)]
    texts = {alias for source in states for alias in source.source}
    known: list[str] = []
    last = math.nan
    for contents in read_pieces(path, channel_map.dialect, names, leading, texts):
        try:
            read = at_own_rates(select_channels(contents, channel_map, None if known else math.inf))
        except MapError:
            if not known:  # The message names what the file has, not only what was looked for.
                select_channels(next(read_pieces(path, channel_map.dialect)), channel_map, math.inf)
            raise
        if is_clock(channel_map.csv.dates):
            read = _with_continued_clock(last, read)
            last = float(np.fmax.reduce(read[_SPEED].time, initial=last))
        known = known or list(read)
        plausible = {name: _without_implausible(c) for name, c in _without_empty_rows(read).items()}
        yield _on_train_time_axis(plausible, known, float(channel_map.preparation.raster))


def _with_continued_clock(last: float, channels: dict[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels whose time of day continues past midnight from `last`, end of the piece before (s)."""
    first = next(iter(channels[_SPEED].time[np.isfinite(channels[_SPEED].time)]), math.nan)
    days = DAY * np.nan_to_num(np.round((last - first) / DAY))
    axes = {id(channel.time): channel.time + max(days, 0.0) for channel in channels.values()}
    return {name: replace(channel, time=axes[id(channel.time)]) for name, channel in channels.items()}


def _without_empty_rows(channels: dict[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels without rows that show neither a time nor a train speed: lines of empty cells."""
    speed = channels[_SPEED]
    filled = ~(np.isnan(speed.time) & np.isnan(speed.samples))
    if filled.all() or not filled.any():
        return channels
    time = speed.time[filled]
    return {
        name: replace(channel, time=time, samples=channel.samples[filled])
        if channel.time is speed.time
        else channel
        for name, channel in channels.items()
    }


def _without_implausible(channel: RawChannel) -> RawChannel:
    implausible = beyond(channel.samples, CHANNEL_UNITS[channel.name]) | np.isinf(channel.samples)
    if not implausible.any():
        return channel
    return replace(channel, samples=np.where(implausible, np.nan, channel.samples))


def _on_train_time_axis(
    channels: dict[str, RawChannel], known: Collection[str], grid_interval: float
) -> Piece:
    """Return the `known` channels over the time of the train speed; NaN where one is not recorded there."""
    time = channels[_SPEED].time
    aligned: dict[str, RawChannel] = {}
    intervals: dict[str, float] = {}
    for name in known:
        channel = channels.get(name)
        if channel is None:
            aligned[name] = RawChannel(name, "", time, np.full(len(time), np.nan))
        elif channel.time is time or np.array_equal(channel.time, time, equal_nan=True):
            aligned[name] = replace(channel, time=time)
        else:
            intervals[name] = usual_interval(channel.time)
            aligned[name] = replace(channel, time=time, samples=resampled(channel, time, grid_interval))
    return Piece(aligned, intervals)


WHEELS = of_wheelsets("wheel_speed")
_COMMAND, _DEMAND, _LINE = ("brake_command",), ("demanded_pressure",), ("brake_line_pressure",)
_CYLINDERS = of_wheelsets("cylinder_pressure")
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
_CLASS, _HIGHEST = 50.0, 20e5
"""Pa: width of the classes in which pressures are counted, and the last of them; chosen."""
_LEAST_STUCK = 2.0
"""s for which a speed may show zero while the wheels roll; chosen."""
_TELLING_CHANGE = 0.5
"""m/s by which the wheels must change meanwhile; chosen."""
_ROLLS = 2.0
"""m/s above which a train rolls whose speed shows zero; chosen."""
_CREEPS = 1.0
"""m/s below which a train speed may be that of a dead sensor if wheels roll; chosen."""
STUCK_BEFORE = 5.0
"""s before a speed is known to be stuck from which it counts as stuck, and for which it may show one number
while the wheels change theirs: one in whole km/h does where a train loses 0.06 m/s2; chosen."""


class Rows(NamedTuple):
    """Rows of a log.

    Args:
        time: as recorded, s.
        train: speed of the train by its own sensor with its sign, m/s.
        wheels: speed that at least two wheelsets reach, three where the train stands, with its sign, m/s.
        braked: 1 where the brake is applied, 0 where it is not, NaN where nothing shows it.

    """

    time: Array
    train: Array
    wheels: Array
    braked: Array

    def followed_by(self, other: Rows) -> Rows:
        """Return these rows followed by others."""
        joined: list[Any] = [np.concatenate(pair) for pair in zip(self, other, strict=True)]
        return Rows(*joined)

    def from_row(self, first: int) -> Rows:
        """Return the rows from one on."""
        remaining: list[Any] = [samples[first:].copy() for samples in self]
        return Rows(*remaining)


def rows_of(path: Path, channel_map: ChannelMap) -> Iterator[Rows]:
    """Yield speed and brake of a file, piece by piece.

    Raises UnreadableError, MissingExtraError, MapError where a file has no speed or nothing that shows the
    brake; OSError.
    """
    trigger, threshold = channel_map.preparation.trigger, None
    alternatives = SHOWN_BY[trigger]
    names = {*WHEELS, *(name for names in alternatives for name in names)}
    for piece in pieces_of(path, channel_map, names):
        if threshold is None:
            shown_by = _shown_by(piece.channels, alternatives)
            threshold = _ON if shown_by == _COMMAND else _pressure_threshold(path, channel_map, shown_by)
        signals = [piece.channels[name].samples for name in shown_by if name in piece.channels]
        speed = piece.channels["speed"]
        wheels = [piece.channels[name].samples for name in WHEELS if name in piece.channels]
        rolling = (
            _speed_of_two_wheelsets(wheels, speed.samples) if len(wheels) > 1 else np.full(len(piece), np.nan)
        )
        signal = np.fmax.reduce(signals)
        braked = np.where(np.isfinite(signal), signal > threshold, np.nan)
        yield Rows(speed.time, speed.samples, rolling, braked)
    if threshold is None:
        raise UnreadableError("no samples")


def _shown_by(channels: Mapping[str, RawChannel], alternatives: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    mapped = [names for names in alternatives if any(name in channels for name in names)]
    for names in mapped:
        if any(np.isfinite(channels[name].samples).any() for name in names if name in channels):
            return names
    if mapped:
        return mapped[0]
    looked_for = ", ".join(name for names in alternatives for name in names)
    raise MapError(f"nothing shows when the brake is applied: map one of {looked_for}")


def _pressure_threshold(path: Path, channel_map: ChannelMap, names: Sequence[str]) -> float:
    """Return the pressure above which the brake of a file is applied, Pa.

    A sensor may show some pressure with the brake released: the median of what lies within that rise of the
    lowest hundredth of the file, unless that is too much for an offset, as where the brake is hardly ever
    released.
    """
    rise = float(channel_map.preparation.trigger_pressure)
    counts = np.zeros(int(_HIGHEST / _CLASS) + 1, dtype=np.int64)
    for piece in pieces_of(path, channel_map, names):
        pressure = np.fmax.reduce([piece.channels[name].samples for name in names if name in piece.channels])
        classes = (
            np.clip(pressure[np.isfinite(pressure)] / _CLASS, 0.0, len(counts) - 1).round().astype(np.int64)
        )
        counts += np.bincount(classes, minlength=len(counts))
    lowest = _class_of_quantile(counts, 0.01 * _RELEASED)
    offset = _CLASS * _class_of_quantile(counts[: lowest + int(rise / _CLASS) + 1], 0.5)
    return rise + (offset if offset <= _LARGEST_OFFSET else 0.0)


def _class_of_quantile(counts: NDArray[np.int64], share: float) -> int:
    return int(np.searchsorted(np.cumsum(counts), share * counts.sum()))


def _speed_of_two_wheelsets(wheels: Sequence[Array], train: Array) -> Array:
    """Return the speed that at least two wheelsets reach, with its sign, so that no single sensor sets it.

    Where the train sensor shows standstill, a third wheelset must reach it, too, if there is one.
    It is the train speed where any wheelset turns with the train.
    """
    stacked = np.stack(wheels)
    sign = np.where(np.nansum(np.nan_to_num(stacked), axis=0) < 0.0, -1.0, 1.0)
    ordered = np.sort(np.where(np.isfinite(stacked), np.abs(stacked), -1.0), axis=0)
    third = ordered[-min(3, len(wheels))]
    creeps = np.abs(train) < _CREEPS
    reached = np.where(creeps & (third >= 0.0), third, ordered[-2])
    with_train = (np.abs(ordered - np.abs(train)) < _TELLING_CHANGE).any(axis=0) & ~creeps
    reached = np.where(with_train, np.abs(train), reached)
    return np.where(reached >= 0.0, sign * reached, np.nan)


class Constant(NamedTuple):
    """A constant-value run of a speed: value (m/s), start (s), and range of the other speed since (m/s)."""

    number: float = np.nan
    since: float = 0.0
    least: float = np.nan
    largest: float = np.nan


class Before(NamedTuple):
    """State of a log before a stretch of it: all that its own rows do not show.

    Args:
        row: number of its first row in the log.
        clock: of that row, without steps, s.
        interval: last one of the recorded clock that was no step, s.
        travelled: distance from the beginning of the log, m.
        train, wheels: constant-value runs of the two speeds that end before it.

    """

    row: int = 0
    clock: float = 0.0
    interval: float = 1.0
    travelled: float = 0.0
    train: Constant = Constant()
    wheels: Constant = Constant()


def reference_speed(clock: Array, train: Array, wheels: Array, before: Before) -> Array:
    """Return the train speed, and that of the wheels where its sensor shows none, zero or one number.

    It is not that of the wheels where these show one number themselves, or spin while the train creeps.
    """
    stuck = (wheels != 0.0) & _is_stuck(clock, wheels, train, before.wheels)
    rolling = np.where(stuck, np.nan, wheels)
    dead = ~np.isfinite(train) | (np.abs(train) < np.minimum(0.5 * np.abs(rolling) - 1.0, _CREEPS))
    dead |= _is_stuck(clock, train, wheels, before.train)
    return np.where(dead & np.isfinite(rolling), rolling, train)


def _is_stuck(clock: Array, speed: Array, other_speed: Array, carried_over: Constant) -> NDArray[np.bool_]:
    """Return the mask of rows in which a speed is stuck: constant while the other one changes or rolls.

    A speed counts as stuck from `STUCK_BEFORE` seconds before the row in which this shows. `carried_over` is
    its constant-value run in the piece before.
    """
    stuck = np.zeros(len(clock), dtype=np.bool_)
    for first, end, since, least, largest in _constant_runs(clock, speed, carried_over):
        least_stuck = _LEAST_STUCK if speed[first] == 0.0 else STUCK_BEFORE
        if clock[end - 1] - since <= least_stuck:
            continue
        lowest = np.fmin.accumulate(np.append(least, other_speed[first:end]))[1:]
        highest = np.fmax.accumulate(np.append(largest, other_speed[first:end]))[1:]
        telling = highest - lowest > _TELLING_CHANGE
        if speed[first] == 0.0:
            telling = np.fmax(np.abs(lowest), np.abs(highest)) > _ROLLS
        detected = telling & (clock[first:end] - since > least_stuck)
        if detected.any():
            before = np.searchsorted(clock, clock[first + int(np.argmax(detected))] - STUCK_BEFORE)
            stuck[max(first, int(before)) : end] = True
    return stuck


def constant_before(
    row: int, clock: Array, speed: Array, other_speed: Array, carried_over: Constant
) -> Constant:
    """Return the state of the constant-value run of `speed` that ends before `row`.

    It carries the run from one piece of a log to the next.

    Args:
        row: number of rows that precede the next piece, at least 1.
        clock: s.
        speed: the speed that may be constant, m/s.
        other_speed: the speed whose range over the run is kept, m/s.
        carried_over: the run in which the first row lies, from the piece before.

    """
    *_, (first, end, since, least, largest) = _constant_runs(clock[:row], speed[:row], carried_over)
    lowest = float(np.fmin(np.fmin.reduce(other_speed[first:end]), least))
    highest = float(np.fmax(np.fmax.reduce(other_speed[first:end]), largest))
    return Constant(float(speed[first]), since, lowest, highest)


def _constant_runs(
    clock: Array, speed: Array, carried_over: Constant
) -> Iterator[tuple[int, int, float, float, float]]:
    """Yield long runs of rows with one value of a speed, and always the first and the last run.

    Each is: first row, row after the last, time since which the value is constant (s), and the least and
    largest other speed in earlier pieces (m/s; NaN without such pieces).
    """
    edges = np.concatenate(([0], np.flatnonzero(np.diff(speed) != 0.0) + 1, [len(speed)]))
    is_long = clock[edges[1:] - 1] - clock[edges[:-1]] > _LEAST_STUCK
    is_long[[0, -1]] = True
    for k in np.flatnonzero(is_long):
        first, end = int(edges[k]), int(edges[k + 1])
        if k == 0 and speed[0] == carried_over.number:
            yield first, end, *carried_over[1:]
        else:
            yield first, end, float(clock[first]), np.nan, np.nan

"""Channels of long files, piece by piece, all over the time of the train speed."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from uictest.core.recording import TIME, beyond, state_kind, usual_interval
from uictest.core.recording.formats import DAY, is_clock, read_pieces
from uictest.recorded.field_data import (
    CHANNEL_UNITS,
    ChannelMap,
    MapError,
    RawChannel,
    at_own_rates,
    resampled,
    select_channels,
)

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
            read = _after(last, read)
            last = float(np.fmax.reduce(read[_SPEED].time, initial=last))
        known = known or list(read)
        believed = {name: _believed(channel) for name, channel in _without_empty_rows(read).items()}
        yield _over_one_time(believed, known, float(channel_map.preparation.raster))


def _after(last: float, channels: dict[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels whose clock, one of a day, runs on from the last time of the piece before, s."""
    first = next(iter(channels[_SPEED].time[np.isfinite(channels[_SPEED].time)]), math.nan)
    days = DAY * np.nan_to_num(np.round((last - first) / DAY))
    axes = {id(channel.time): channel.time + max(days, 0.0) for channel in channels.values()}
    return {name: replace(channel, time=axes[id(channel.time)]) for name, channel in channels.items()}


def _without_empty_rows(channels: dict[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels without rows that show neither a time nor a train speed: lines of empty cells."""
    speed = channels[_SPEED]
    kept = ~(np.isnan(speed.time) & np.isnan(speed.samples))
    if kept.all() or not kept.any():
        return channels
    time = speed.time[kept]
    return {
        name: replace(channel, time=time, samples=channel.samples[kept])
        if channel.time is speed.time
        else channel
        for name, channel in channels.items()
    }


def _believed(channel: RawChannel) -> RawChannel:
    """Return a channel with NaN for implausible samples."""
    implausible = beyond(channel.samples, CHANNEL_UNITS[channel.name]) | np.isinf(channel.samples)
    if not implausible.any():
        return channel
    return replace(channel, samples=np.where(implausible, np.nan, channel.samples))


def _over_one_time(channels: dict[str, RawChannel], known: Collection[str], raster: float) -> Piece:
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
            aligned[name] = replace(channel, time=time, samples=resampled(channel, time, raster))
    return Piece(aligned, intervals)

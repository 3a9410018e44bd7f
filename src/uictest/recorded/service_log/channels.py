"""Channels of long files, piece by piece, all over the time of the train speed."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from uictest.core.recording import TIME, Contents
from uictest.core.recording.formats import read_pieces
from uictest.recorded.field_data import (
    ChannelMap,
    MapError,
    RawChannel,
    resampled,
    select_channels,
    usual_interval,
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

    A later piece with implausible numbers gets channels of NaN: the clock runs on, nothing is believed.

    Raises UnreadableError, MissingExtraError, MapError, OSError.
    """
    sources = channel_map.sources()
    chosen = sources if needed is None else {TIME, _SPEED, *needed}
    names = {alias for name in chosen if name in sources for alias in sources[name].source}
    leading = sources[_SPEED].source if _SPEED in sources else ()
    known: dict[str, RawChannel] = {}
    for contents in read_pieces(path, channel_map.dialect, names, leading):
        try:
            read = known = select_channels(contents, channel_map, math.inf)
        except MapError:
            if not known:
                raise
            read = _plausible(contents, channel_map, known)
        yield _over_one_time(read, list(known), float(channel_map.preparation.raster))


def _plausible(
    contents: Contents, channel_map: ChannelMap, known: dict[str, RawChannel]
) -> dict[str, RawChannel]:
    """Return the channels of a piece that can be read; a train speed that cannot is NaN."""
    read: dict[str, RawChannel] = {}
    for name in sorted(known, key=lambda name: name != _SPEED):
        others = {each.source for other, each in known.items() if other not in (name, _SPEED)}
        try:
            read |= {name: select_channels(_without(contents, others), channel_map, math.inf)[name]}
        except (MapError, KeyError):
            if name == _SPEED:
                contents = _without(contents, set(), zero=known[_SPEED].source)
                standing = select_channels(_without(contents, others), channel_map, math.inf)[_SPEED]
                read[_SPEED] = replace(standing, samples=np.full(len(standing.time), np.nan))
    return read


def _without(contents: Contents, names: Collection[str], zero: str = "") -> Contents:
    """Return the contents without some channels, and with zeros for one."""
    groups = []
    for group in contents.groups:
        kept = {name: samples for name, samples in group.channels.items() if name not in names}
        zeros = {zero: np.zeros(len(group))} if zero in kept else {}
        groups.append(replace(group, channels=kept | zeros))
    return Contents(tuple(groups))


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

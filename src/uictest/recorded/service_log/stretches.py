"""Stops cut out of a log: each a recording of its own with all channels of the map."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uictest.core import files, recording
from uictest.core.recording import BRAKE_COMMAND_TIME, SAMPLE_INTERVALS
from uictest.core.recording.formats import UnreadableError
from uictest.recorded.field_data import CHANNEL_UNITS, ChannelMap
from uictest.recorded.service_log.channels import Piece, pieces_of
from uictest.recorded.service_log.finder import Log, LoggedEvent
from uictest.recorded.service_log.signals import WHEELS, Array

_SIGNED = ("speed", "distance", *WHEELS)


def write_stops(log: Log, channel_map: ChannelMap, folder: Path) -> dict[Path, str]:
    """Write every stop as Parquet, in SI under canonical names; return the files in order, with SHA-256.

    They take the place of earlier stops in the folder at once.

    Raises UnreadableError, MapError, OSError; ForeignFileError where the folder holds something else.
    """
    with files.replaced_folder(folder) as new:
        return {folder / name: digest for name, digest in _written(log, channel_map, new)}


def _written(log: Log, channel_map: ChannelMap, folder: Path) -> Iterator[tuple[str, str]]:
    """Write every stop, and yield the names of the files in order, with their SHA-256."""
    pending: dict[int, list[_Part]] = {}
    lead = float(channel_map.preparation.trigger_lead)
    following = 0
    for first, piece in _pieces(log, channel_map):
        end = first + len(piece)
        for k in range(following, len(log.stops)):
            begin, last = log.stops[k].rows
            if begin >= end:
                break
            pending.setdefault(k, []).append(_part(piece, slice(max(begin - first, 0), last - first)))
            if last <= end:
                name = f"stop-{k + 1:04d}.parquet"
                content = _parquet(pending.pop(k), log.stops[k], lead)
                files.write(folder, name, content)
                yield name, hashlib.sha256(content).hexdigest()
                following = k + 1
        if following == len(log.stops):
            break


class _Part(NamedTuple):
    """Channels of a part of a stop, and the intervals of those that had a time of their own, s."""

    channels: dict[str, Array]
    intervals: dict[str, float]


def _part(piece: Piece, rows: slice) -> _Part:
    channels = {name: channel.samples[rows].copy() for name, channel in piece.channels.items()}
    return _Part({"time": piece.channels["speed"].time[rows].copy(), **channels}, piece.intervals)


def _pieces(log: Log, channel_map: ChannelMap) -> Iterator[tuple[int, Piece]]:
    row = 0
    for path, end in zip(log.files, log.first_rows[1:], strict=True):
        for piece in pieces_of(path, channel_map):
            row += len(piece)
            if row > end:
                break
            yield row - len(piece), piece
        if row != end:
            raise UnreadableError(f"{path}: has changed since its stops were found")


def _joined(parts: list[dict[str, Array]]) -> dict[str, Array]:
    """Return the parts one behind the other; a channel that a part has not is NaN there."""
    names = dict.fromkeys(name for part in parts for name in part)
    blank = [np.full(len(part["time"]), np.nan) for part in parts]
    return {
        name: np.concatenate([part.get(name, none) for part, none in zip(parts, blank, strict=True)])
        for name in names
    }


def _runs_backwards(name: str, channels: dict[str, Array]) -> bool:
    """Return whether a channel counts backwards; pole wheels do not, even where the train runs so."""
    own = "speed" if name == "distance" else name
    return name in _SIGNED and bool(np.nanmedian(np.append(channels[own], 0.0)) < 0.0)


def _parquet(parts: list[_Part], event: LoggedEvent, lead: float) -> bytes:
    """Return a stop as a file; its clock is as recorded, steps included, which a recording could not hold.

    It states the brake command, `lead` before the brake is applied, unless it begins with the brake applied.
    """
    channels = _joined([part.channels for part in parts])
    facts = {
        "source": event.file.name,
        "place": f"sample {event.row + 1}, {event.time:.12g} s, {event.distance:.6g} m",
        "remarks": "; ".join(event.remarks),
    }
    if intervals := {name: each for part in parts for name, each in part.intervals.items()}:
        facts[SAMPLE_INTERVALS] = json.dumps(intervals)
    if not event.begins_braked:
        facts[BRAKE_COMMAND_TIME] = f"{event.time - lead:.6f} s"
    units = {"time": "s", **CHANNEL_UNITS}
    signed = {name: -v if _runs_backwards(name, channels) else v for name, v in channels.items()}
    return recording.channels_bytes(signed, {name: units[name] for name in signed}, facts)

"""The contents of a file before a channel map interprets them, and as a recording."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats import UnreadableError
from uictest.core.recording.recording import TIME, Recording

Samples = NDArray[Any]
"""One-dimensional: 64-bit floats, or texts where a channel holds the names of states."""


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """Channels that were sampled together.

    Args:
        name: name of the group in the file; empty where the format has no groups.
        channels: name in the file -> samples, all equally long, in any order and of any value.
        units: name -> unit as the file writes it; channels without a unit are missing.
        time: the time axis in seconds, if the format has its own; else it is one of the channels.
        first_texts: name of a channel that holds texts among numbers -> place of the first text in the file.

    """

    name: str
    channels: dict[str, Samples]
    units: dict[str, str] = field(default_factory=dict)
    time: NDArray[Any] | None = None
    first_texts: dict[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(next(iter(self.channels.values()))) if self.channels else 0


@dataclass(frozen=True, slots=True, eq=False)
class Contents:
    """The groups of a file and its metadata, as text.

    `skipped` maps items that are not channels (texts, images, structures) to the reason why they are skipped.
    """

    groups: tuple[Group, ...]
    metadata: dict[str, str] = field(default_factory=dict)
    skipped: dict[str, str] = field(default_factory=dict)


def recording_of(contents: Contents, metadata: Mapping[str, str]) -> Recording:
    """Return the contents of a file of one group with a time axis in seconds as a recording.

    `metadata` is added to that of the file. Raises UnreadableError for several rasters, no time, texts, or
    channels without a unit.
    """
    if len(contents.groups) != 1:
        raise UnreadableError(f"{len(contents.groups)} rasters; a recording has one")
    group = contents.groups[0]
    channels = {name: np.asarray(samples) for name, samples in group.channels.items() if name != TIME}
    for name, samples in channels.items():
        if samples.dtype.kind == "U":
            place = f", the first in {group.first_texts[name]}" if name in group.first_texts else ""
            raise UnreadableError(f"channel {name!r} contains texts{place}; a recording contains numbers")
    try:
        return Recording(
            {TIME: _time(group), **channels},
            {TIME: "s", **{name: group.units.get(name, "") for name in channels}},
            dict(chain(contents.metadata.items(), metadata.items())),
        )
    except ValueError as error:
        raise UnreadableError(f"not a recording: {error}") from error


def _time(group: Group) -> np.ndarray:
    if group.time is not None:
        return group.time
    if TIME not in group.channels or group.units.get(TIME) != "s":
        raise UnreadableError(f"no channel {TIME!r} in seconds")
    return group.channels[TIME]

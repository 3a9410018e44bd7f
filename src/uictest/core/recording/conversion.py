"""Conversion of the contents of a file to a recording."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain

import numpy as np

from uictest.core.recording.contents import Contents, Group
from uictest.core.recording.formats import UnreadableError
from uictest.core.recording.recording import TIME, Recording


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

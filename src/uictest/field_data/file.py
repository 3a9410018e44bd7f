"""From a file to the stop recorded in it."""

from __future__ import annotations

import hashlib
from pathlib import Path

from uictest.field_data.channel_map import ChannelMap
from uictest.field_data.prepare import RecordedStop, prepare
from uictest.field_data.raw import select
from uictest.recording.formats import read_contents


def stop_in(path: Path, channel_map: ChannelMap) -> RecordedStop:
    """Read a file and return the stop in it.

    Raises UnreadableError, MissingExtraError, MapError, UnusableError, OSError.
    """
    contents = read_contents(path, channel_map.dialect)
    return prepare(select(contents, channel_map), contents.metadata, channel_map.preparation)


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, read piece by piece. Raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()

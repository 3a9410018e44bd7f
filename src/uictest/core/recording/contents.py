"""The contents of a file before a channel map interprets them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

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

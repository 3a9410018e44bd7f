"""What a measurement file holds, before anybody says what it means."""

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
        channels: name in the file -> samples, all equally long. Nothing is assumed of their order or value.
        units: name -> unit as the file writes it; channels without a unit are left out.
        time: the time axis in seconds, where the format has one of its own; else one of the channels is it.
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
    """The groups of a file and the facts it tells about itself, as text.

    `skipped` maps what is no channel (texts, images, structures) to why it was left out.
    """

    groups: tuple[Group, ...]
    metadata: dict[str, str] = field(default_factory=dict)
    skipped: dict[str, str] = field(default_factory=dict)

"""Limits of reading: larger than any stop needs, smaller than any machine has."""

from __future__ import annotations

import math
from collections.abc import Iterable

from uictest.core.recording.formats.problems import UnreadableError

LARGEST_FILE = 2**30
"""bytes"""

MOST_VALUES = 50_000_000
"""Values of all channels of a file together: 400 MB."""

MOST_CHANNELS = 20_000

READING_SECONDS = 120.0
"""Time after which reading is aborted."""

READING_MEMORY = 6 * 2**30
"""Address space of the process that reads, bytes."""


def check_size(shapes: Iterable[tuple[int, ...]]) -> None:
    """Raise UnreadableError where the channels that a file declares are too many or too long together."""
    sizes = [math.prod(shape) for shape in shapes]
    if len(sizes) > MOST_CHANNELS:
        raise UnreadableError(f"{len(sizes)} channels; at most {MOST_CHANNELS} are read")
    if any(size < 0 for size in sizes) or sum(sizes) > MOST_VALUES:
        raise UnreadableError(f"{sum(sizes)} values; at most {MOST_VALUES} are read")

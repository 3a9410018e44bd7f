"""One share of a sweep, for machines that know nothing of each other."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

_WRITTEN = re.compile(r"([0-9]{1,6})/([0-9]{1,6})")


@dataclass(frozen=True, slots=True)
class Shard:
    """Share `number` (from 1) of `count`."""

    number: int = 1
    count: int = 1

    def of(self, parts: int) -> Sequence[int]:
        """Return the numbers of the parts in this share: every `count`-th, so that shares take alike long."""
        return range(self.number - 1, parts, self.count)


def parse_shard(text: str) -> Shard:
    """Read a share written as `i/n`, 1 <= i <= n. Raises ValueError."""
    match = _WRITTEN.fullmatch(text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise ValueError(f"{text!r} is not a share: write 2/8 for the second of eight")
    return Shard(int(match[1]), int(match[2]))

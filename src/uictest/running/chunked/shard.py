"""One shard of a sweep, for machines that do not communicate."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

_FORM = re.compile(r"([0-9]{1,6})/([0-9]{1,6})")


@dataclass(frozen=True, slots=True)
class Shard:
    """Shard `number` (from 1) of `count`."""

    number: int = 1
    count: int = 1

    def chunk_numbers(self, chunks: int) -> Sequence[int]:
        """Return the numbers of this shard's chunks: every `count`-th, so that shards take alike long."""
        return range(self.number - 1, chunks, self.count)


def parse_shard(text: str) -> Shard:
    """Read a shard written as `i/n`, 1 <= i <= n. Raises ValueError."""
    match = _FORM.fullmatch(text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise ValueError(f"{text!r} is not a shard: write 2/8 for the second of eight")
    return Shard(int(match[1]), int(match[2]))

"""The selected cases of a sweep, their division into chunks, and shards for machines of their own."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.sweeps import Plan
from uictest.running.campaign import mentioned_in, parse

_SMALLEST_CHUNK: Final = 16
_CHUNKING: Final = ((1024, 32), (4096, 64))
"""Most cases in a chunk and the number of chunks to aim at.

What a chunk costs whatever its size counts in a sweep that takes hours, whose chunks may take ten seconds.
"""
_IDS_AT_ONCE: Final = 4096
"""Ids that are made, and in memory, at a time; chosen."""


@dataclass(frozen=True)
class CaseSelection:
    """The selected cases of a plan in order; `selected` holds their indices, None where all are selected."""

    plan: Plan
    selected: NDArray[np.int64] | None = None

    @property
    def size(self) -> int:
        """Number of cases."""
        return self.plan.size if self.selected is None else int(self.selected.size)

    @property
    def chunk_size(self) -> int:
        """Cases in a chunk: seconds of work, and the same on every machine."""
        sizes = (min(largest, self.size // chunks) for largest, chunks in _CHUNKING)
        return max(_SMALLEST_CHUNK, *sizes)

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.size // self.chunk_size)

    def chunk(self, number: int) -> NDArray[np.int64]:
        """Return the indices of the cases in a chunk."""
        first = number * self.chunk_size
        return self.indices(first, min(first + self.chunk_size, self.size))

    def id_blocks(self) -> Iterator[list[str]]:
        """Yield the ids of the cases in order, some thousands at a time."""
        for first in range(0, self.size, _IDS_AT_ONCE):
            yield self.plan.ids(self.indices(first, min(first + _IDS_AT_ONCE, self.size)))

    def indices(self, first: int, end: int) -> NDArray[np.int64]:
        """Return the indices of the cases from place `first` to before place `end`."""
        return np.arange(first, end) if self.selected is None else self.selected[first:end]


def select_cases(plan: Plan, expression: str | None) -> CaseSelection:
    """Return the cases whose id, sweep file or tags match an expression. Raises ExpressionError."""
    if expression is None:
        return CaseSelection(plan)
    matches = parse(expression)
    common_names = (PurePath(plan.file).name, *plan.base.scenario.tags)
    selected: list[NDArray[np.int64]] = []
    for first in range(0, plan.size, _IDS_AT_ONCE):
        indices = np.arange(first, min(first + _IDS_AT_ONCE, plan.size))
        is_selected = [matches(mentioned_in((name, *common_names))) for name in plan.ids(indices)]
        selected.append(indices[np.array(is_selected)])
    return CaseSelection(plan, np.concatenate(selected))


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

"""What a sweep reports while it runs."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path


class SweepObserver:
    """Follows a sweep. This one shows nothing; a display overrides what it shows."""

    def foreign_in_process(self) -> None:
        """Take note that controllers from outside run in this process."""

    def compiling(self) -> AbstractContextManager[None]:
        """Return a context in which the rig is compiled, where it is not yet."""
        return nullcontext()

    def damaged(self, chunk: Path) -> None:
        """Take note of a damaged chunk, which is computed again."""

    def damaged_in_shard(self, chunk: Path) -> None:
        """Take note of a damaged chunk of a shard, which is skipped."""

    def merged(self, chunks: int, shard: Path) -> None:
        """Take note of the chunks that a shard brought."""

    def found(self, cases: int, missing: int) -> None:
        """Take note of how many cases there are, and how many of them are not finished yet."""

    def simulating(self, cases: int, finished: int) -> AbstractContextManager[Callable[[int], None]]:
        """Return a context of the simulation; it lends what is called with the cases of each chunk.

        `finished` of `cases` are finished before.
        """
        return nullcontext(_ignore)

    def waiting(self, address: str) -> None:
        """Take note that a cluster has no workers yet."""

    def searching(self, key: str) -> None:
        """Take note that the frontier along a parameter is being searched."""


def _ignore(cases: int) -> None:
    pass

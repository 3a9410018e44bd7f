"""What a run, a sweep or a validation reports while it runs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Protocol

from uictest import report
from uictest.judging import series
from uictest.running import campaign


class Advance(Protocol):
    """Is called with how many more are finished, and how many more there are than was said before."""

    def __call__(self, finished: int, further: int = 0, /) -> None:
        """Count `finished` more, of a total that grows by `further`."""


class Observer:
    """Follows what runs. This one shows nothing; a display overrides what it shows."""

    def foreign_in_process(self) -> None:
        """Take note that controllers from outside run in this process."""

    def simulating(
        self, count: int, finished: int = 0, unit: str = "cases"
    ) -> AbstractContextManager[Advance]:
        """Return a context of a simulation; it lends what is called with how many more are finished.

        `finished` of `count` are finished before; `unit` says what is counted.
        """
        return nullcontext(lambda finished, further=0: None)

    def case(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Take note of a finished case; `differences` are its quantities that differ from the baseline."""

    def case_of_series(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Take note of a finished case of a series."""

    def series(self, result: series.SeriesResult) -> None:
        """Take note of a series whose last stop is finished."""

    def damaged(self, chunk: Path) -> None:
        """Take note of a damaged chunk of a sweep, which is computed again."""

    def damaged_in_shard(self, chunk: Path) -> None:
        """Take note of a damaged chunk of a shard, which is skipped."""

    def merged(self, chunks: int, shard: Path) -> None:
        """Take note of the chunks that a shard brought."""

    def found(self, cases: int, missing: int) -> None:
        """Take note of how many cases a sweep has, and how many of them are not finished yet."""

    def waiting(self, address: str) -> None:
        """Take note that a cluster has no workers yet."""

    def searching(self, key: str) -> None:
        """Take note that the frontier along a parameter is being searched."""


def available_processors() -> int:
    """Return the number of processors that this process may use, at least 1."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

"""What a run reports while it runs."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext

from uictest import report
from uictest.judging import series
from uictest.plans import scenario
from uictest.running import campaign


class Observer:
    """Follows a run. This one shows nothing; a display overrides what it shows."""

    def simulating(self, cases: Sequence[scenario.Case]) -> AbstractContextManager[Callable[[], None]]:
        """Return a context in which these cases are simulated; it lends what is called after each stop."""
        return nullcontext(_ignore)

    def case(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Take note of a finished case; `differences` are its quantities that differ from the baseline."""

    def case_of_series(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Take note of a finished case of a series."""

    def series(self, result: series.SeriesResult) -> None:
        """Take note of a series whose last stop is finished."""


def _ignore() -> None:
    pass


def available_processors() -> int:
    """Return how many processors this process may use, at least 1."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

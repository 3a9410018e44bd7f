"""Exit codes, and the error for invalid input. A crash never exits with 1, and no exit code is a count."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

from uictest import campaign, series


class ExitCode(IntEnum):
    """The exit codes of every command."""

    MET = 0
    MISSED = 1
    INTERRUPTED = 2
    ERROR = 3
    USAGE = 4
    NOTHING_SELECTED = 5


class InvalidInputError(Exception):
    """Options or files that cannot be used: the command ends with `ExitCode.USAGE`.

    The message is complete, and may have several lines.
    """


def of_batch(batch: campaign.BatchResult) -> ExitCode:
    """Return the exit code of a batch: interruption before error, error before a case not as expected."""
    if batch.interrupted:
        return ExitCode.INTERRUPTED
    if any(result.outcome == "error" for result in batch.results):
        return ExitCode.ERROR
    return ExitCode.MET if all(result.met for result in batch.results) else ExitCode.MISSED


def of_series(results: Sequence[series.SeriesResult]) -> ExitCode:
    """Return the exit code of series: error before one that is not as expected."""
    if any(result.outcome == "error" for result in results):
        return ExitCode.ERROR
    return ExitCode.MET if all(result.met for result in results) else ExitCode.MISSED


def worst(*codes: ExitCode) -> ExitCode:
    """Return the first of interruption, error and a case not as expected that is among the codes."""
    order = (ExitCode.MET, ExitCode.MISSED, ExitCode.ERROR, ExitCode.INTERRUPTED)
    return max(codes, key=order.index)

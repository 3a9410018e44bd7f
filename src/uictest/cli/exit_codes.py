"""Exit codes. A crash never exits with 1, and no exit code is a count."""

from __future__ import annotations

from enum import IntEnum

from uictest import runs


class ExitCode(IntEnum):
    """The exit codes of every command."""

    MET = 0
    MISSED = 1
    INTERRUPTED = 2
    ERROR = 3
    USAGE = 4
    NOTHING_SELECTED = 5


def of_run(run: runs.Published) -> ExitCode:
    """Return the exit code of a run: interruption before error, error before what is not as expected."""
    if run.interrupted:
        return ExitCode.INTERRUPTED
    results, series = run.content.results, run.content.series
    if any(each.outcome == "error" for each in results) or any(each.outcome == "error" for each in series):
        return ExitCode.ERROR
    met = all(each.met for each in results) and all(each.met for each in series)
    return ExitCode.MET if met else ExitCode.MISSED


def worst(*codes: ExitCode) -> ExitCode:
    """Return the first of interruption, error and a case not as expected that is among the codes."""
    order = (ExitCode.MET, ExitCode.MISSED, ExitCode.ERROR, ExitCode.INTERRUPTED)
    return max(codes, key=order.index)

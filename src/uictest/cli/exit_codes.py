"""What the exit code of the process says. A crash is never 1, and a count is never an exit code."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uictest.campaign import BatchResult


class ExitCode(IntEnum):
    """The exit codes of every command."""

    MET = 0
    MISSED = 1
    INTERRUPTED = 2
    ERROR = 3
    USAGE = 4
    NOTHING_SELECTED = 5


def of_campaign(campaign: BatchResult) -> ExitCode:
    """Return the exit code of a campaign: an interruption outweighs an error, an error a missed case."""
    if campaign.interrupted:
        return ExitCode.INTERRUPTED
    if any(result.outcome == "error" for result in campaign.results):
        return ExitCode.ERROR
    return ExitCode.MET if all(result.met for result in campaign.results) else ExitCode.MISSED


def worst(*codes: ExitCode) -> ExitCode:
    """Return the code that weighs most: interruption, then error, then a missed case."""
    order = (ExitCode.MET, ExitCode.MISSED, ExitCode.ERROR, ExitCode.INTERRUPTED)
    return max(codes, key=order.index)

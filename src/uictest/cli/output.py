"""What the program gives back: data on stdout, messages on stderr, and an exit code."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import sys
from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import Final, TextIO

from uictest import runs
from uictest.plans.scenario import Diagnostic
from uictest.report import no_command, printable


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
    if "error" in {*(case.outcome for case in results), *(one.outcome for one in series)}:
        return ExitCode.ERROR
    met = all(map(run.content.expected, results)) and all(one.met for one in series)
    failed = run.content.campaign is not None and run.content.campaign.failed
    return ExitCode.MET if met and not failed else ExitCode.MISSED


def worst(*codes: ExitCode) -> ExitCode:
    """Return the first of interruption, error and a case not as expected that is among the codes."""
    order = (ExitCode.MET, ExitCode.MISSED, ExitCode.ERROR, ExitCode.INTERRUPTED)
    return max(codes, key=order.index)


_losses: list[OSError] = []
"""Why stdout did not accept data."""


def data(text: str) -> bool:
    """Write data to stdout at once, a line feed at its end.

    Returns whether stdout accepted it: if not, the caller can stop. A reader that has gone (`| head`) is no
    error. Any other reason is one, and :func:`lost_data` returns it at the end.
    """
    try:
        sys.stdout.write(f"{text}\n")
        sys.stdout.flush()
    except OSError as error:
        if not isinstance(error, BrokenPipeError):
            _losses.append(error)
        # What is still in the buffer must not raise again at the next flush.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return False
    return True


def append_summary(append: Callable[[], None]) -> None:
    """Append to the step summary of a CI service. What it sums up is written already: a failure is shown."""
    try:
        append()
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")


def terminal_width(stream: TextIO) -> int | None:
    """Return the characters that a line of the terminal holds, None for a stream that is not a terminal."""
    return shutil.get_terminal_size().columns if stream.isatty() else None


_WIDTH: Final = 100
"""Characters of a line where there is no terminal: fits the logs of GitLab, GitHub and Jenkins; chosen."""


def output_width(stream: TextIO) -> int:
    """Return the characters that a line may have: of the terminal, elsewhere 100 or COLUMNS if more."""
    columns = shutil.get_terminal_size((_WIDTH, 24)).columns
    return columns if stream.isatty() else max(columns, _WIDTH)


def lost_data() -> str:
    """Return the reason if stdout did not accept everything since the last call; empty where it did."""
    reasons = [error.strerror or str(error) for error in _losses]
    _losses.clear()
    return f"stdout: {reasons[0]}" if reasons else ""


def message(text: str) -> None:
    """Write a message of one or more lines to stderr, none of which controls a terminal or a CI service."""
    with contextlib.suppress(OSError):
        sys.stderr.write("".join(f"{no_command(printable(line))}\n" for line in text.split("\n")))
        sys.stderr.flush()


def warn_of_implausible(diagnostics: Iterable[Diagnostic]) -> None:
    """Write what of trains is implausible to stderr."""
    for diagnostic in diagnostics:
        message(str(diagnostic._replace(message=f"warning: {diagnostic.message}")))


def use_safe_encoding() -> None:
    """Let both streams escape the characters that they cannot encode."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def coloured(stream: TextIO) -> bool:
    """Return whether to colour a stream: on a terminal, unless NO_COLOR or FORCE_COLOR say otherwise."""
    if os.environ.get("NO_COLOR", "") != "":
        return False
    return os.environ.get("FORCE_COLOR", "") != "" or (stream.isatty() and os.environ.get("TERM") != "dumb")


def interactive(stream: TextIO) -> bool:
    """Return whether a person watches the stream: it is a terminal, and not one of a CI service."""
    return stream.isatty() and os.environ.get("CI", "").lower() in ("", "0", "false")

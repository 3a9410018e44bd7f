"""Progress of stops on stderr: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager
from time import monotonic

from uictest import runs
from uictest.cli.output import coloured, interactive, message

HEARTBEAT = 30.0
"""Seconds between two lines where there is no terminal; chosen."""


@contextlib.contextmanager
def progress(total: int, done: int = 0, *, quiet: bool, unit: str = "cases") -> Iterator[runs.Advance]:
    """Lend a function to call with how many more of `total` cases, or what `unit` says, are finished.

    Its second argument is by how much the total grows; `done` were finished before.
    """
    if quiet:
        yield lambda finished, further=0: None
    elif interactive(sys.stderr):
        with _bar(total, done) as advance:
            yield advance
    else:
        with _heartbeat(total, done, unit) as advance:
            yield advance


@contextlib.contextmanager
def _bar(total: int, done: int) -> Iterator[runs.Advance]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    in_colour = coloured(sys.stderr)
    console = Console(stderr=True, no_color=not in_colour, color_system="auto" if in_colour else None)
    columns = (TextColumn("simulating"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, speed_estimate_period=60.0) as bar:
        task = bar.add_task("simulating", total=total, completed=done)

        def advance(finished: int, further: int = 0, /) -> None:
            nonlocal total
            total += further
            bar.update(task, advance=finished, total=total)

        yield advance


@contextlib.contextmanager
def _heartbeat(total: int, done: int, unit: str) -> Iterator[runs.Advance]:
    """Write a line now and then, also while nothing finishes: a job without output may be ended."""
    before, started, ended = done, monotonic(), threading.Event()

    def beat() -> None:
        while not ended.wait(HEARTBEAT):
            seconds = monotonic() - started
            rate = (done - before) / seconds
            remaining = f", {(total - done) / rate:.0f} s left" if rate else ""
            message(f"uictest: {done} of {total} {unit} after {seconds:.0f} s{remaining}")

    def advance(finished: int, further: int = 0, /) -> None:
        nonlocal done, total
        total += further
        done += finished

    thread = threading.Thread(target=beat, name="heartbeat", daemon=True)
    thread.start()
    try:
        yield advance
    finally:
        ended.set()
        thread.join()


class TerminalObserver(runs.Observer):
    """Shows on stderr how far a simulation is; nothing if `quiet`."""

    def __init__(self, *, quiet: bool = False) -> None:
        self.quiet = quiet

    def foreign_in_process(self) -> None:
        """Announce that controllers from outside can crash this process."""
        if not self.quiet:
            message(
                "uictest: --in-process: controllers from outside are not isolated, a crash ends everything"
            )

    def simulating(
        self, count: int, finished: int = 0, unit: str = "cases"
    ) -> AbstractContextManager[runs.Advance]:
        """Show the progress of the stops."""
        return progress(count, finished, quiet=self.quiet, unit=unit)

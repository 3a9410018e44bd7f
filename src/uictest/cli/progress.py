"""Progress of stops on stderr: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager
from time import monotonic
from typing import TYPE_CHECKING

from uictest import runs
from uictest.cli.output import coloured, interactive, message

if TYPE_CHECKING:
    from rich.console import Console


HEARTBEAT = 30.0  # seconds between two lines where there is no terminal


def error_console() -> Console:
    """Return the console of stderr."""
    from rich.console import Console

    in_colour = coloured(sys.stderr)
    return Console(stderr=True, no_color=not in_colour, color_system="auto" if in_colour else None)


@contextlib.contextmanager
def progress(total: int, *, quiet: bool, unit: str = "cases") -> Iterator[runs.Advance]:
    """Lend a function to call with how many more of `total` cases, or what `unit` says, are finished.

    Its second argument is by how much the total grows.
    """
    if quiet:
        yield lambda finished, further=0: None
    elif interactive(sys.stderr):
        with _bar(total) as advance:
            yield advance
    else:
        with _heartbeat(total, unit) as advance:
            yield advance


@contextlib.contextmanager
def _bar(total: int) -> Iterator[runs.Advance]:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("simulating"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=error_console(), transient=True) as bar:
        task = bar.add_task("simulating", total=total)

        def advance(finished: int, further: int = 0, /) -> None:
            nonlocal total
            total += further
            bar.update(task, advance=finished, total=total)

        yield advance


@contextlib.contextmanager
def _heartbeat(total: int, unit: str) -> Iterator[runs.Advance]:
    done = 0
    ended = threading.Event()
    started = monotonic()

    def beat() -> None:
        while not ended.wait(HEARTBEAT):
            message(f"uictest: {done} of {total} {unit} after {monotonic() - started:.0f} s")

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


@contextlib.contextmanager
def sweep_progress(total: int, done: int, *, quiet: bool) -> Iterator[runs.Advance]:
    """Lend a function that counts finished cases; `done` of `total` were finished before."""
    if quiet:
        yield lambda cases, further=0: None
    elif interactive(sys.stderr):
        with _bar_with_rate(total, done) as advance:
            yield advance
    else:
        yield _SweepHeartbeat(total, done).advance


@contextlib.contextmanager
def _bar_with_rate(total: int, done: int) -> Iterator[runs.Advance]:
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        ProgressColumn,
        Task,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Rate(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text("-" if task.speed is None else f"{task.speed:.0f} cases/s")

    columns = (BarColumn(), MofNCompleteColumn(), Rate(), TimeRemainingColumn())
    console = error_console()
    with Progress(*columns, console=console, transient=True, speed_estimate_period=60.0) as bar:
        task = bar.add_task("simulating", total=total, completed=done)
        yield lambda cases, further=0: bar.advance(task, cases)


class _SweepHeartbeat:
    """A line when a chunk is finished, unless the last line is recent."""

    def __init__(self, total: int, done: int) -> None:
        self._total, self._before, self._done = total, done, 0
        self._started = self._last_line = monotonic()

    def advance(self, cases: int, further: int = 0, /) -> None:
        """Count finished cases, and print a line if the last one is old enough."""
        self._total += further
        self._done += cases
        now = monotonic()
        if now - self._last_line >= HEARTBEAT:
            self._last_line = now
            message(self._line(now - self._started))

    def _line(self, seconds: float) -> str:
        rate = self._done / seconds
        finished = self._before + self._done
        remaining = (self._total - finished) / rate
        return f"uictest: {finished} of {self._total} cases, {rate:.0f} cases/s, {remaining:.0f} s left"


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
        return progress(count, quiet=self.quiet, unit=unit)

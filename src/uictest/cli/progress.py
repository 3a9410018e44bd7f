"""Progress of stops and of a compilation on stderr: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager
from time import monotonic
from typing import TYPE_CHECKING, Final

from uictest import rig, runs
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


_EVERY: Final = 5.0
"""s between two lines where there is no terminal."""


@contextlib.contextmanager
def compilation_shown(*, quiet: bool = False) -> Iterator[None]:
    """Show on stderr what is compiled meanwhile, how much of it is done and how long it may still take.

    Where the cache holds the code nothing is compiled, and nothing shown; nor if `quiet`.
    """
    with contextlib.ExitStack() as shown:
        if quiet:
            watcher: rig.Watcher = _ignore
        else:
            watcher = _Bar(shown) if interactive(sys.stderr) else _Lines()
        shown.enter_context(rig.compilation_watched(watcher))
        yield


def _ignore(title: str, done: float) -> None:
    pass


class _Bar:
    """One bar for each compilation; those that have ended disappear with `shown`."""

    def __init__(self, shown: contextlib.ExitStack) -> None:
        self._shown = shown

    def __call__(self, title: str, done: float) -> None:
        if done == 0.0:
            self._begin(title)
        self._bars.update(self._bar, completed=done)

    def _begin(self, title: str) -> None:
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

        message(_announcement(title))
        columns = (TextColumn("compiling"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
        bars = Progress(*columns, console=error_console(), transient=True)
        self._bars = self._shown.enter_context(bars)
        self._bar = self._bars.add_task("compiling", total=1.0)


class _Lines:
    """A line when a compilation begins, one every few seconds, and one when it has ended."""

    _begun = _told = 0.0

    def __call__(self, title: str, done: float) -> None:
        now = monotonic()
        elapsed = now - self._begun
        if done == 0.0:
            self._begun = self._told = now
            message(_announcement(title))
        elif done == 1.0:
            message(f"uictest: compiled in {elapsed:.0f} s")
        elif now - self._told >= _EVERY:
            self._told = now
            message(f"uictest: {done:.0%} compiled, about {elapsed * (1 - done) / done:.0f} s left")


def _announcement(title: str) -> str:
    return f"uictest: compiling {title}, once per installation..."


class TerminalObserver(runs.Observer):
    """Shows on stderr what is compiled and how far a simulation is; nothing if `quiet`."""

    def __init__(self, *, quiet: bool = False) -> None:
        self.quiet = quiet

    def foreign_in_process(self) -> None:
        """Announce that controllers from outside can crash this process."""
        if not self.quiet:
            message(
                "uictest: --in-process: controllers from outside are not isolated, a crash ends everything"
            )

    def compiling(self) -> AbstractContextManager[None]:
        """Show the compilation of the rig."""
        return compilation_shown(quiet=self.quiet)

    def simulating(
        self, count: int, finished: int = 0, unit: str = "cases"
    ) -> AbstractContextManager[runs.Advance]:
        """Show the progress of the stops."""
        return progress(count, quiet=self.quiet, unit=unit)

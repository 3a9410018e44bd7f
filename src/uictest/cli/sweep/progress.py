"""Progress of a sweep: a bar with rate and remaining time on a terminal, else a line every 30 s."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from time import monotonic

from uictest.cli import progress as steps
from uictest.cli.output import interactive, message

Advance = Callable[[int], None]


@contextlib.contextmanager
def sweep_progress(total: int, done: int, *, quiet: bool) -> Iterator[Advance]:
    """Lend a function that counts finished cases; `done` of `total` were finished before."""
    if quiet:
        yield lambda cases: None
    elif interactive(sys.stderr):
        with _bar(total, done) as advance:
            yield advance
    else:
        yield _Heartbeat(total, done).advance


@contextlib.contextmanager
def _bar(total: int, done: int) -> Iterator[Advance]:
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
    console = steps.error_console()
    with Progress(*columns, console=console, transient=True, speed_estimate_period=60.0) as bar:
        task = bar.add_task("simulating", total=total, completed=done)
        yield lambda cases: bar.advance(task, cases)


class _Heartbeat:
    """A line when a chunk is finished, unless the last line is recent."""

    def __init__(self, total: int, done: int) -> None:
        self._total, self._before, self._done = total, done, 0
        self._started = self._last_line = monotonic()

    def advance(self, cases: int) -> None:
        """Count finished cases, and print a line if the last one is old enough."""
        self._done += cases
        now = monotonic()
        if now - self._last_line >= steps.HEARTBEAT:
            self._last_line = now
            message(self._line(now - self._started))

    def _line(self, seconds: float) -> str:
        rate = self._done / seconds
        finished = self._before + self._done
        remaining = (self._total - finished) / rate
        return f"uictest: {finished} of {self._total} cases, {rate:.0f} cases/s, {remaining:.0f} s left"

"""Progress of stops: a bar on a terminal, a line every 30 s elsewhere."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator
from time import monotonic
from typing import TYPE_CHECKING

from uictest.cli.output import coloured, interactive, message

if TYPE_CHECKING:
    from rich.console import Console

HEARTBEAT = 30.0  # seconds between two lines where there is no terminal

Advance = Callable[[], None]


def error_console(colour: str = "auto") -> Console:
    """Return the console of stderr, with colours as chosen."""
    from rich.console import Console

    in_colour = coloured(colour, sys.stderr)
    return Console(stderr=True, no_color=not in_colour, color_system="auto" if in_colour else None)


@contextlib.contextmanager
def progress(total: int, *, quiet: bool, unit: str = "cases", colour: str = "auto") -> Iterator[Advance]:
    """Lend a function to call after each of `total` cases, or what `unit` says; it shows them on stderr."""
    if quiet:
        yield lambda: None
    elif interactive(sys.stderr):
        with _bar(total, colour) as advance:
            yield advance
    else:
        with _heartbeat(total, unit) as advance:
            yield advance


@contextlib.contextmanager
def _bar(total: int, colour: str) -> Iterator[Advance]:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("simulating"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=error_console(colour), transient=True) as bar:
        task = bar.add_task("simulating", total=total)
        yield lambda: bar.advance(task)


@contextlib.contextmanager
def _heartbeat(total: int, unit: str) -> Iterator[Advance]:
    done: list[None] = []
    ended = threading.Event()
    started = monotonic()

    def beat() -> None:
        while not ended.wait(HEARTBEAT):
            message(f"uictest: {len(done)} of {total} {unit} after {monotonic() - started:.0f} s")

    thread = threading.Thread(target=beat, name="heartbeat", daemon=True)
    thread.start()
    try:
        yield lambda: done.append(None)
    finally:
        ended.set()
        thread.join()


def announce_in_process(*, foreign: bool, quiet: bool = False) -> None:
    """Announce that foreign controllers, if there are any (`foreign`), can crash this process."""
    if foreign and not quiet:
        message("uictest: --in-process: controllers from outside are not isolated, a crash ends everything")

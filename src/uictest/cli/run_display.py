"""A run, simulated or recorded, on a terminal: its progress, its cases, and what follows its reports."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from time import monotonic, perf_counter

from uictest import report, runs
from uictest.cli.options import Format
from uictest.cli.output import append_summary, coloured, data, interactive, message, output_width
from uictest.core import files
from uictest.running import campaign

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


class Display(TerminalObserver):
    """Shows progress and tracebacks on stderr. A subclass says what it shows on stdout."""

    def __init__(self, *, quiet: bool, verbose: bool) -> None:
        super().__init__(quiet=quiet)
        self.verbose = verbose

    def case(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show, with -v, the traceback of a crash."""
        if self.verbose and run.traceback:
            message(run.traceback.rstrip())

    def case_of_series(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case of a series, which only -v does."""
        if self.verbose:
            self.case(run, differences)

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the results; `document` is the text of results.json."""

    def close(self, content: report.RunContent, ending: str, place: Path) -> None:
        """Show how the run ended and where its reports are: on stderr, as stdout is for programs."""
        [line] = report.last_lines(content, ending, sys.maxsize)
        message(f"uictest: {line}; reports in {place}")


class Text(Display):
    """The table of the cases when all are finished, as columns are as wide as their widest cell."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the table, what is close, and what failed."""
        lines = report.run_lines(
            content,
            output_width(sys.stdout),
            coloured=coloured(sys.stdout),
            quiet=self.quiet,
            verbose=self.verbose,
        )
        for line in lines:
            data(report.no_command(line))

    def close(self, content: report.RunContent, ending: str, place: Path) -> None:
        """Show the last line, and where the reports are."""
        width, in_colour = output_width(sys.stdout), coloured(sys.stdout)
        data("")
        for line in report.last_lines(content, ending, width, coloured=in_colour):
            data(report.no_command(line))
        page = place / "index.html"
        shown = f"page: {page}" if page.is_file() else f"reports: {place}"
        data(report.no_command(report.printable(shown)))


class Annotations(Text):
    """Text, and a GitHub annotation for each case and series that is not as expected."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the text, then the annotations."""
        super().end(content, document)
        for line in report.run_annotations(content):
            data(line)


class ResultsDocument(Display):
    """results.json and nothing else."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the document."""
        data(document.rstrip("\n"))


def chosen_display(shown: Format, *, quiet: bool, verbose: bool) -> Display:
    """Return the display for a format, the same on a terminal and elsewhere."""
    kinds = {Format.TEXT: Text, Format.GITHUB: Annotations, Format.JSON: ResultsDocument}
    return kinds[shown](quiet=quiet, verbose=verbose)


def publish_and_show(
    batch: runs.Batch, output: Path, formats: Sequence[str], junit: Path | None, display: Display
) -> runs.Published | None:
    """Run a batch, publish its reports and show them; after an interruption, those of the finished cases.

    `junit` is the file of `--junitxml`. Returns None if no case is finished. Raises OSError if the reports
    cannot be written, and removes those that were.
    """
    started = perf_counter()
    published = runs.publish_batch(batch, output, formats, display)
    if published is None:
        message("uictest: interrupted before the first case was finished; there is nothing to report")
        return None
    content = published.content
    append_summary(lambda: report.append_step_summary(published.publication))
    if junit is not None:
        files.write_to(junit, published.publication.junit())
    display.end(content, published.publication.texts[report.RESULTS])
    if published.index_problem:
        message(f"uictest: {published.index_problem}")
    if display.quiet:
        return published
    for notice in report.notices(content.all_results):
        for line in report.wrapped_sentence(f"uictest: {notice}", output_width(sys.stderr)):
            message(line)
    remaining = len(batch.all_cases) - len(content.all_results)
    not_run = f"; {remaining} not run" if remaining else ""
    interrupted = "; interrupted" if published.interrupted else ""
    display.close(content, f"{interrupted}{not_run}; took {perf_counter() - started:.1f} s", published.place)
    return published

"""A run, simulated or recorded, on a terminal: its progress, its cases, and what follows its reports."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from time import monotonic, perf_counter

from uictest import report, runs
from uictest.cli.options import Format
from uictest.cli.output import append_summary, coloured, data, interactive, message, terminal_width
from uictest.core import files
from uictest.judging import evaluation, series
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
    """Shows progress and tracebacks on stderr. What it shows on stdout a subclass says: this one, nothing."""

    def __init__(self, *, quiet: bool, verbose: bool) -> None:
        super().__init__(quiet=quiet)
        self.verbose = verbose
        self._in_colour = coloured(sys.stdout)

    def case(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case; with -v, the traceback of its crash, too."""
        self.show(run.result, differences)
        if self.verbose and run.traceback:
            message(run.traceback.rstrip())

    def case_of_series(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case of a series, which only -v does."""
        if self.verbose:
            self.case(run, differences)

    def show(self, result: evaluation.CaseResult, differences: Sequence[report.Difference]) -> None:
        """Show one result; `differences` are its quantities out of the tolerance of the baseline."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the rest; `document` is the text of results.json."""


class Lines(Display):
    """One line per case as it finishes; with -v also per criterion, with -q only what does not pass."""

    def show(self, result: evaluation.CaseResult, differences: Sequence[report.Difference]) -> None:
        """Show one result."""
        if self.quiet and result.met and not result.allowed and not differences:
            return
        self._show_result(report.case_word(result, differences), report.case_line(result, differences))
        if self.verbose:
            for line in report.criterion_lines(result):
                data(line)
        for line in (*report.domain_lines(result), *report.firmness_lines(result)):
            data(line)

    def series(self, result: series.SeriesResult) -> None:
        """Show a series, and unless quiet its criteria and the stops that count."""
        if self.quiet and result.met:
            return
        self._show_result(report.result_word(result), report.series_line(result))
        for line in (*report.series_lines(result), *report.firmness_lines(result)):
            data(line)

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the missing cases of the baseline; with -v also the definitions of criteria, and parts."""
        for line in report.missing_lines(content.baseline) if content.baseline else ():
            self._show_result(report.DIFFERS, line)
        if self.verbose:
            for line in _common_lines(_shown_results(content, quiet=self.quiet)):
                data(line)

    def _show_result(self, word: str, line: str) -> None:
        first = report.line_word(word)
        tone = report.tone(word) if self._in_colour else None
        data(f"{report.coloured_text(first, tone)}{line.removeprefix(first)}")


class Annotations(Lines):
    """Lines, and a GitHub annotation below each case that does not pass."""

    def show(self, result: evaluation.CaseResult, differences: Sequence[report.Difference]) -> None:
        """Show one result."""
        super().show(result, differences)
        for line in report.case_annotations(result, differences):
            data(line)

    def series(self, result: series.SeriesResult) -> None:
        """Show a series."""
        super().series(result)
        for line in report.series_annotations(result):
            data(line)

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the rest, and an annotation for each missing case of the baseline."""
        super().end(content, document)
        for line in report.missing_annotations(content.baseline) if content.baseline else ():
            data(line)


class ResultsDocument(Display):
    """results.json and nothing else."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the document."""
        data(document.rstrip("\n"))


class VerdictTable(Display):
    """A table at the end, as columns are as wide as their widest cell, and the reasons of what is not met."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the table and the explanations."""
        for line in self._content_lines(content):
            data(line)

    def _content_lines(self, content: report.RunContent) -> Iterator[str]:
        width = terminal_width(sys.stdout)
        results = _shown_results(content, quiet=self.quiet)
        if results:
            table = replace(report.cases_table(content), rows=results)
            yield from report.table_lines(table, width, coloured=self._in_colour)
        for result in results:
            if self.verbose or not content.passes(result) or result.outcome in report.EXPLAINED:
                yield from report.explanation_lines(
                    content, result, every_criterion=self.verbose, coloured=self._in_colour
                )
            yield from report.domain_lines(result)
            # The explanation of a case that is not met for lack of firmness has said how firm it is.
            if self.verbose or not result.lacks_firmness:
                yield from report.firmness_lines(result)
        judged = [result for result in content.series if not (self.quiet and result.met)]
        if judged:
            yield from report.series_lines_of_terminal(judged, width)
        for of_series in judged:
            yield from report.firmness_lines(of_series)
        close = report.close_lines(() if self.quiet else results, judged)
        if close.sentences:
            yield f"{close.title}:"
            yield from (f"  {line}" for line in close.sentences)
        yield from report.missing_lines(content.baseline) if content.baseline else ()
        if self.verbose:
            yield from _common_lines(results)


def _common_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the definitions of criteria and the parts, once for all cases."""
    yield from report.definition_lines(results)
    yield from report.part_lines(results)


def chosen_display(shown: Format, *, quiet: bool, verbose: bool) -> Display:
    """Return the display for a format; `text` is a table on a terminal and lines elsewhere."""
    kind: type[Display] = VerdictTable if interactive(sys.stdout) else Lines
    if shown is not Format.TEXT:
        kind = ResultsDocument if shown is Format.JSON else Annotations
    return kind(quiet=quiet, verbose=verbose)


def _shown_results(content: report.RunContent, *, quiet: bool) -> list[evaluation.CaseResult]:
    """Return the cases; if `quiet`, those that are not as expected or miss what is only allowed."""
    return [result for result in content.results if not quiet or result.allowed or not content.passes(result)]


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
        message(f"uictest: {notice}")
    ended = "interrupted, " if published.interrupted else ""
    remaining = len(batch.all_cases) - len(content.all_results)
    not_run = f", {remaining} not run" if remaining else ""
    seconds = perf_counter() - started
    message(f"uictest: {ended}{content.tally}{not_run} in {seconds:.1f} s; reports in {published.place}")
    return published

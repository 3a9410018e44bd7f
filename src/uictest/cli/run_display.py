"""A run, simulated or recorded, on stdout while it runs, and what follows its published reports."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter

from uictest import report, runs
from uictest.cli.options import Format
from uictest.cli.output import append_summary, coloured, data, interactive, message
from uictest.cli.progress import TerminalObserver
from uictest.core import files
from uictest.judging import evaluation, series
from uictest.running import campaign

_ANSI = {"good": "\x1b[32m", "bad": "\x1b[1;31m", "odd": "\x1b[1;35m"}
_ANSI_END = "\x1b[0m"


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
        self._show(report.case_word(result, differences), report.case_line(result, differences))
        if self.verbose:
            for line in report.criterion_lines(result):
                data(line)
        for line in (*report.domain_lines(result), *report.firmness_lines(result)):
            data(line)

    def series(self, result: series.SeriesResult) -> None:
        """Show a series, and unless quiet its criteria and the stops that count."""
        if self.quiet and result.met:
            return
        self._show(report.series_word(result), report.series_line(result))
        for line in (*report.series_lines(result), *report.firmness_lines(result)):
            data(line)

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the missing cases of the baseline; with -v also the definitions of criteria, and parts."""
        for line in report.missing_lines(content.baseline) if content.baseline else ():
            self._show(report.DIFFERS, line)
        if self.verbose:
            for line in _common_lines(_shown(content, quiet=self.quiet)):
                data(line)

    def _show(self, word: str, line: str) -> None:
        first = report.line_word(word)
        colour = _ANSI[report.tone(word)]
        data(f"{colour}{first}{_ANSI_END}{line.removeprefix(first)}" if self._in_colour else line)


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
        from rich.console import Console

        console = Console(
            color_system="auto" if self._in_colour else None, force_terminal=self._in_colour, highlight=False
        )
        shown = _shown(content, quiet=self.quiet)
        if shown:
            table, not_shown = report.verdict_table(shown, content.word, console.width)
            console.print(table)
            if not_shown:
                console.print(not_shown, markup=False, style="dim")
        for result in shown:
            if self.verbose or not content.passes(result) or result.outcome in report.EXPLAINED:
                console.print(report.explanation_text(content, result, every_criterion=self.verbose))
            # The explanation of a case that is not met for it has said how firm it is.
            told = result.lacks_firmness and not self.verbose
            firmness = () if told else report.firmness_lines(result)
            for line in (*report.domain_lines(result), *firmness):
                console.print(line, markup=False)
        judged = [each for each in content.series if not (self.quiet and each.met)]
        for line in report.series_table(judged, console.width) if judged else ():
            console.print(line, markup=False)
        for each in judged:
            for line in report.firmness_lines(each):
                console.print(line, markup=False)
        close = report.close_lines(() if self.quiet else shown, judged)
        if close.sentences:
            console.print("\n  ".join((f"{close.title}:", *close.sentences)), markup=False)
        for line in report.missing_lines(content.baseline) if content.baseline else ():
            console.print(line, markup=False)
        if self.verbose:
            for line in _common_lines(shown):
                console.print(line, markup=False)


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


def _shown(content: report.RunContent, *, quiet: bool) -> list[evaluation.CaseResult]:
    return [result for result in content.results if not quiet or _says_something(content, result)]


def _says_something(content: report.RunContent, result: evaluation.CaseResult) -> bool:
    """Return whether a case is shown with --quiet: it is not as expected, or misses what is only allowed."""
    return bool(result.allowed) or not content.passes(result)


def publish_and_show(
    batch: runs.Batch,
    output: Path,
    formats: Sequence[str],
    junit: Path | None,
    display: Display,
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
    append_summary(lambda: report.append_step_summary(content))
    if junit is not None:
        files.write_to(junit, report.junit_text(report.suites_of_run(content)))
    display.end(content, published.document)
    if published.index_problem:
        message(f"uictest: {published.index_problem}")
    if not display.quiet:
        _sum_up(batch, published, perf_counter() - started)
    return published


def _sum_up(batch: runs.Batch, published: runs.Published, seconds: float) -> None:
    content = published.content
    ended = "interrupted, " if published.interrupted else ""
    remaining = len(batch.all_cases) - len(content.all_results)
    not_run = f", {remaining} not run" if remaining else ""
    for notice in report.notices(content.all_results):
        message(f"uictest: {notice}")
    message(f"uictest: {ended}{content.tally}{not_run} in {seconds:.1f} s; reports in {published.place}")

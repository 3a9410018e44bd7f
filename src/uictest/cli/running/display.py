"""Displays of a run on stdout: a table on a terminal, one line per case elsewhere, or a document."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import Protocol

from uictest import report
from uictest.cli.options import Colour, Format
from uictest.cli.output import coloured, data, interactive
from uictest.judging import evaluation, series

_ANSI = {"good": "\x1b[32m", "bad": "\x1b[1;31m", "odd": "\x1b[1;35m"}
_ANSI_END = "\x1b[0m"


class Display(Protocol):
    """Shows results while the batch runs, and the rest at its end."""

    def case(self, result: evaluation.CaseResult, differences: Sequence[report.Difference] = ()) -> None:
        """Show one result; `differences` are its quantities out of the tolerance of the baseline."""

    def series(self, result: series.SeriesResult) -> None:
        """Show a series whose last stop is finished."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the rest; `document` is the text of results.json."""


class Lines:
    """One line per case as it finishes; with -v also per criterion, with -q only what does not pass."""

    def __init__(self, *, colour: bool, quiet: bool, verbose: bool) -> None:
        self._colour = colour
        self._quiet = quiet
        self._verbose = verbose

    def case(self, result: evaluation.CaseResult, differences: Sequence[report.Difference] = ()) -> None:
        """Show one result."""
        if self._quiet and result.met and not differences:
            return
        self._show(report.case_word(result, differences), report.case_line(result, differences))
        if self._verbose:
            for line in report.criterion_lines(result):
                data(line)
        for line in report.domain_lines(result):
            data(line)

    def series(self, result: series.SeriesResult) -> None:
        """Show a series, and unless quiet its criteria and the stops that count."""
        if self._quiet and result.met:
            return
        self._show(report.series_word(result), report.series_line(result))
        for line in report.series_lines(result):
            data(line)

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the missing cases of the baseline; with -v also the definitions of criteria, and parts."""
        for line in report.missing_lines(content.baseline) if content.baseline else ():
            self._show(report.DIFFERS, line)
        if self._verbose:
            for line in _common_lines(_shown(content, quiet=self._quiet)):
                data(line)

    def _show(self, word: str, line: str) -> None:
        first = report.line_word(word)
        colour = _ANSI[report.tone(word)]
        data(f"{colour}{first}{_ANSI_END}{line.removeprefix(first)}" if self._colour else line)


class Annotations(Lines):
    """Lines, and a GitHub annotation below each case that does not pass."""

    def case(self, result: evaluation.CaseResult, differences: Sequence[report.Difference] = ()) -> None:
        """Show one result."""
        super().case(result, differences)
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


class ResultsDocument:
    """results.json and nothing else."""

    def case(self, result: evaluation.CaseResult, differences: Sequence[report.Difference] = ()) -> None:
        """Show nothing before the document is complete."""

    def series(self, result: series.SeriesResult) -> None:
        """Show nothing before the document is complete."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the document."""
        data(document.rstrip("\n"))


class VerdictTable:
    """A table at the end, and below it the reasons of cases that are not as expected."""

    def __init__(self, *, colour: bool, quiet: bool, verbose: bool) -> None:
        self._colour = colour
        self._quiet = quiet
        self._verbose = verbose

    def case(self, result: evaluation.CaseResult, differences: Sequence[report.Difference] = ()) -> None:
        """Show nothing yet: columns are as wide as their widest cell."""

    def series(self, result: series.SeriesResult) -> None:
        """Show nothing yet."""

    def end(self, content: report.RunContent, document: str) -> None:
        """Show the table and the explanations."""
        from rich.console import Console

        console = Console(
            color_system="auto" if self._colour else None, force_terminal=self._colour, highlight=False
        )
        shown = _shown(content, quiet=self._quiet)
        if shown:
            table, not_shown = report.verdict_table(shown, content.word, console.width)
            console.print(table)
            if not_shown:
                console.print(not_shown, markup=False, style="dim")
        for result in shown:
            if self._verbose or not content.passes(result):
                console.print(report.explanation_text(content, result, every_criterion=self._verbose))
            for line in report.domain_lines(result):
                console.print(line, markup=False)
        judged = [each for each in content.series if not (self._quiet and each.met)]
        for line in report.series_table(judged, console.width) if judged else ():
            console.print(line, markup=False)
        for line in report.missing_lines(content.baseline) if content.baseline else ():
            console.print(line, markup=False)
        if self._verbose:
            for line in _common_lines(shown):
                console.print(line, markup=False)


def _common_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the definitions of criteria and the parts, once for all cases."""
    yield from report.definition_lines(results)
    yield from report.part_lines(results)


def chosen_display(shown: Format, colour: Colour, *, quiet: bool, verbose: bool) -> Display:
    """Return the display for a format; `text` is a table on a terminal and lines elsewhere."""
    if shown is Format.JSON:
        return ResultsDocument()
    display: type[Lines | VerdictTable] = Lines
    if shown is Format.GITHUB:
        display = Annotations
    elif interactive(sys.stdout):
        display = VerdictTable
    return display(colour=coloured(colour, sys.stdout), quiet=quiet, verbose=verbose)


def _shown(content: report.RunContent, *, quiet: bool) -> list[evaluation.CaseResult]:
    return [result for result in content.results if not (quiet and content.passes(result))]

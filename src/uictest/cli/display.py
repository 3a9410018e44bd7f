"""What a run shows on stdout: a table on a terminal, one line per case elsewhere, or a document."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, TextIO

from uictest.cli.options import Colour, Format
from uictest.cli.streams import coloured, data
from uictest.report import case_annotations, case_line, criterion_lines, definition_lines, verdict_word

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult

_ANSI = {"met": "\x1b[32m", "MISSED": "\x1b[1;31m", "ERROR": "\x1b[1;35m"}
_ANSI_END = "\x1b[0m"


class Display(Protocol):
    """Shows results while they come in, and what remains to be shown at the end."""

    def case(self, result: CaseResult) -> None:
        """Show one result."""

    def end(self, results: Sequence[CaseResult], document: str) -> None:
        """Show the rest; `document` is the text of results.json."""


class Lines:
    """One line per case as it finishes; with -v also per criterion, with -q only what is not met."""

    def __init__(self, *, colour: bool, quiet: bool, verbose: bool) -> None:
        self._colour = colour
        self._quiet = quiet
        self._verbose = verbose

    def case(self, result: CaseResult) -> None:
        """Show one result."""
        if self._quiet and result.met:
            return
        word = verdict_word(result)
        rest = case_line(result).removeprefix(word)
        data(f"{_ANSI[word]}{word}{_ANSI_END}{rest}" if self._colour else f"{word}{rest}")
        if self._verbose:
            for line in criterion_lines(result):
                data(line)

    def end(self, results: Sequence[CaseResult], document: str) -> None:
        """Show what the criteria were taken to mean, where they are shown."""
        if self._verbose:
            for line in definition_lines([each for each in results if not (self._quiet and each.met)]):
                data(line)


class Annotations(Lines):
    """Lines, and a GitHub annotation below each case that is not met."""

    def case(self, result: CaseResult) -> None:
        """Show one result."""
        super().case(result)
        for line in case_annotations([result]):
            data(line)


class Document:
    """results.json and nothing else."""

    def case(self, result: CaseResult) -> None:
        """Show nothing before the document is complete."""

    def end(self, results: Sequence[CaseResult], document: str) -> None:
        """Show the document."""
        data(document.rstrip("\n"))


class VerdictTable:
    """A table at the end, and below it why cases came out otherwise than expected."""

    def __init__(self, *, colour: bool, quiet: bool, verbose: bool) -> None:
        self._colour = colour
        self._quiet = quiet
        self._verbose = verbose

    def case(self, result: CaseResult) -> None:
        """Show nothing yet: columns are as wide as their widest cell."""

    def end(self, results: Sequence[CaseResult], document: str) -> None:
        """Show the table and the explanations."""
        from rich.console import Console

        from uictest.report import explanation_text, verdict_table

        console = Console(
            color_system="auto" if self._colour else None, force_terminal=self._colour, highlight=False
        )
        shown = [result for result in results if not (self._quiet and result.met)]
        if shown:
            console.print(verdict_table(shown))
        for result in shown:
            if self._verbose or not result.met:
                console.print(explanation_text(result, every_criterion=self._verbose))
        if self._verbose:
            for line in definition_lines(shown):
                console.print(line, markup=False)


def chosen_display(shown: Format, colour: Colour, *, quiet: bool, verbose: bool) -> Display:
    """Return the display for a format; `text` is a table where a person reads and lines elsewhere."""
    if shown is Format.JSON:
        return Document()
    display: type[Lines | VerdictTable] = Lines
    if shown is Format.GITHUB:
        display = Annotations
    elif interactive(sys.stdout):
        display = VerdictTable
    return display(colour=coloured(colour, sys.stdout), quiet=quiet, verbose=verbose)


def interactive(stream: TextIO) -> bool:
    """Return whether a person watches the stream: it is a terminal, and not one of a CI service."""
    return stream.isatty() and os.environ.get("CI", "").lower() in ("", "0", "false")

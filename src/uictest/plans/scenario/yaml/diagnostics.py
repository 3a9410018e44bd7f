"""Diagnostics: the place in a file, what is wrong, and what to write."""

import traceback
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final, NamedTuple

from uictest.plans.scenario.yaml.tree import Node, Place, visible

EXCERPT_WIDTH: Final = 100
_LEAD: Final = 60


class Diagnostic(NamedTuple):
    """One error in one file. Everything a user wrote appears escaped, safe for a terminal.

    ``line`` and ``column`` count from one; ``excerpt`` is the line with a caret line below it. ``trace`` is
    where an error of the program arose that the file brought about; empty for an error of the file.
    """

    file: str
    line: int
    column: int
    key: str
    message: str
    excerpt: str
    hint: str
    trace: str = ""

    def __str__(self) -> str:
        subject = f"{self.key}: " if self.key else ""
        lines = [f"{self.file}:{self.line}:{self.column}: {subject}{self.message}"]
        margin = f"{self.line:>5} | "
        for text in self.excerpt.splitlines():
            lines.append((margin + text).rstrip())
            margin = " " * 5 + " | "
        if self.hint:
            lines.append(f"      = {self.hint}")
        return "\n".join(lines)


class ScenarioErrors(Exception):  # noqa: N818 - it holds many errors, and its name says so
    """Every error found in the files that were read.

    ``salvaged`` is the tree of a file that could be read in spite of them: more errors may be found in it.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic], salvaged: Node | None = None) -> None:
        self.diagnostics = tuple(dict.fromkeys(diagnostics))
        self.salvaged = salvaged
        super().__init__(self.diagnostics)

    def __str__(self) -> str:
        return "\n".join(map(str, self.diagnostics))

    @property
    def traces(self) -> tuple[str, ...]:
        """Where errors of the program arose; empty where all are errors of the files."""
        return tuple(each.trace for each in self.diagnostics if each.trace)


def diagnose(place: Place, message: str, key: str = "", hint: str = "") -> Diagnostic:
    """A diagnostic at ``place`` with an excerpt; ``message`` and ``hint`` must be escaped already."""
    return Diagnostic(
        file=visible(place.document.display),
        line=place.line,
        column=place.column,
        key=visible(key),
        message=message,
        excerpt=_excerpt(place),
        hint=hint,
    )


@contextmanager
def collecting(diagnostics: list[Diagnostic], place: Place) -> Iterator[None]:
    """Append the errors of a file, or of a case in it, at ``place`` those of the program: others go on."""
    try:
        yield
    except ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    except Exception as error:
        message = visible(f"internal error: {type(error).__name__}: {error}")
        trace = visible(traceback.format_exc()).replace("\\x0a", "\n").rstrip()
        diagnostics.append(diagnose(place, message)._replace(trace=trace))


def in_reading_order(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Sorted by file, in the order of their first diagnostics, and by line."""
    file_order = {
        name: number for number, name in enumerate(dict.fromkeys(each.file for each in diagnostics))
    }
    return sorted(diagnostics, key=lambda each: (file_order[each.file], each.line, each.column))


def single_error(place: Place, message: str, key: str = "", hint: str = "") -> ScenarioErrors:
    """One diagnostic as an exception."""
    return ScenarioErrors([diagnose(place, message, key, hint)])


def _excerpt(place: Place) -> str:
    lines = place.document.lines
    if not 1 <= place.line <= len(lines) or not lines[place.line - 1].strip():
        return ""
    line, at = lines[place.line - 1], place.column - 1
    start = max(0, at - _LEAD)
    before, after = line[start:at], line[at : start + EXCERPT_WIDTH]
    shown = _shown(before)
    return f"{shown}{_shown(after)}\n{' ' * _width(shown)}^".rstrip("\n")


def _shown(text: str) -> str:
    return visible(text.replace("\t", " "))


def _width(text: str) -> int:
    return sum(2 if unicodedata.east_asian_width(char) in "WF" else 1 for char in text)

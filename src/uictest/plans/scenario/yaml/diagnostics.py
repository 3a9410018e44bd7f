"""Diagnostics: the place in a file, what is wrong, what to write, and how user text is worded."""

import re
import traceback
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from typing import Final, NamedTuple, TypeVar

COMMAND_LINE: Final = "--set"
"""Display name of values from the command line, in place of a file name."""
# libyaml counts these as line breaks, so excerpts must too.
_LINE_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")


@dataclass(frozen=True, eq=False)
class Document:
    """One text that was read: a file, a library file, or an option of the command line."""

    display: str
    """Name shown in messages."""
    folder: Path
    """Folder that relative paths inside it start from."""
    text: str
    sha256: str = ""

    @cached_property
    def lines(self) -> list[str]:
        """The lines of the text as YAML counts them."""
        return _LINE_BREAK.split(self.text)


class Location(NamedTuple):
    """A position in a document, counted from one."""

    document: Document
    line: int = 1
    column: int = 1


_Item = TypeVar("_Item")
_Result = TypeVar("_Result")
QUOTED_LENGTH: Final = 60
EXAMPLE_LENGTH: Final = 80


def visible(text: str) -> str:
    """``text`` with every character that a terminal would act on, or not show, written as an escape."""
    if text.isprintable():
        return text
    return "".join(char if char.isprintable() else _escape(char) for char in text)


def _escape(char: str) -> str:
    code = ord(char)
    if code <= 0xFF:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def quoted(text: str) -> str:
    """``text`` in single quotes, escaped and cut to a readable length."""
    short = text if len(text) <= QUOTED_LENGTH else text[: QUOTED_LENGTH - 3] + "..."
    return f"'{visible(short)}'"


def short_example(text: str) -> str:
    """Return the text, escaped; empty if it is too long for a hint, since half an example is wrong."""
    return visible(text) if len(text) <= EXAMPLE_LENGTH else ""


def nearest(text: str, valid: Iterable[str]) -> str | None:
    """The valid name that ``text`` was probably meant to be."""
    candidates = list(valid)
    matches = get_close_matches(
        text[:QUOTED_LENGTH].lower(), [name.lower() for name in candidates], n=1, cutoff=0.6
    )
    if not matches:
        return longer_name(text, candidates)
    return next(name for name in candidates if name.lower() == matches[0])


def longer_name(text: str, valid: Iterable[str]) -> str | None:
    """The one valid name of which ``text`` is a whole word: `initial_speed` for `speed`."""
    longer = [name for name in valid if text.lower() in name.lower().split("_")]
    return longer[0] if len(longer) == 1 else None


def suggestion(text: str, valid: Iterable[str]) -> str:
    """A hint that names the nearest valid name, or else lists what is accepted."""
    candidates = sorted(valid)
    guess = nearest(text, candidates)
    if guess is not None:
        return f"did you mean {quoted(guess)}?"
    return "accepted: " + ", ".join(candidates) if candidates else ""


EXCERPT_WIDTH: Final = 100
_LEAD: Final = 60


class Diagnostic(NamedTuple):
    """One error in one file. Everything a user wrote appears escaped, safe for a terminal.

    Attributes:
        file: name of the file as shown to users.
        line: number of the line, from 1.
        column: number of the character in the line, from 1.
        key: dotted key; empty where the error has none.
        message: what is wrong.
        excerpt: the line, and below it a line with a caret.
        hint: what to write instead; may be empty.
        trace: traceback of an error of this program; empty for an error of the file.
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

    def __init__(self, diagnostics: Iterable[Diagnostic], salvaged: object = None) -> None:
        self.diagnostics = tuple(dict.fromkeys(diagnostics))
        self.salvaged = salvaged
        super().__init__(self.diagnostics)

    def __str__(self) -> str:
        return "\n".join(map(str, self.diagnostics))

    @property
    def traces(self) -> tuple[str, ...]:
        """Tracebacks of errors of the program; empty where all are errors of the files."""
        return tuple(each.trace for each in self.diagnostics if each.trace)


def diagnose(location: Location, message: str, key: str = "", hint: str = "") -> Diagnostic:
    """A diagnostic at ``place`` with an excerpt; ``message`` and ``hint`` must be escaped already."""
    return Diagnostic(
        file=visible(location.document.display),
        line=location.line,
        column=location.column,
        key=visible(key),
        message=message,
        excerpt=_excerpt(location),
        hint=hint,
    )


@contextmanager
def collecting(diagnostics: list[Diagnostic], location: Location) -> Iterator[None]:
    """Append the errors of a file, or of a case in it, at ``place`` those of the program: others go on."""
    try:
        yield
    except ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    except Exception as error:
        message = visible(f"internal error: {type(error).__name__}: {error}")
        trace = visible(traceback.format_exc()).replace("\\x0a", "\n").rstrip()
        diagnostics.append(diagnose(location, message)._replace(trace=trace))


def in_reading_order(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Sorted by file, in the order of their first diagnostics, and by line."""
    file_order = {
        name: number for number, name in enumerate(dict.fromkeys(each.file for each in diagnostics))
    }
    return sorted(diagnostics, key=lambda each: (file_order[each.file], each.line, each.column))


def require_none(diagnostics: Iterable[Diagnostic]) -> None:
    """Raise ScenarioErrors with these errors in reading order; with none, do nothing."""
    found = list(dict.fromkeys(diagnostics))
    if found:
        raise ScenarioErrors(in_reading_order(found))


def read_each(read: Callable[[_Item], _Result], items: Iterable[_Item]) -> list[_Result]:
    """Return the results of reading each item. Raises ScenarioErrors with the errors of all items."""
    results: list[_Result] = []
    diagnostics: list[Diagnostic] = []
    for item in items:
        try:
            results.append(read(item))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    require_none(diagnostics)
    return results


def single_error(location: Location, message: str, key: str = "", hint: str = "") -> ScenarioErrors:
    """One diagnostic as an exception."""
    return ScenarioErrors([diagnose(location, message, key, hint)])


def _excerpt(location: Location) -> str:
    lines = location.document.lines
    if not 1 <= location.line <= len(lines) or not lines[location.line - 1].strip():
        return ""
    line, at = lines[location.line - 1], location.column - 1
    start = max(0, at - _LEAD)
    before, after = line[start:at], line[at : start + EXCERPT_WIDTH]
    before_caret = _without_tabs(before)
    width = sum(2 if unicodedata.east_asian_width(char) in "WF" else 1 for char in before_caret)
    return f"{before_caret}{_without_tabs(after)}\n{' ' * width}^"


def _without_tabs(text: str) -> str:
    return visible(text.replace("\t", " "))

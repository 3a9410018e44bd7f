"""What a result says, for people and programs, before it is written in any format.

Tables and sentences, which each format renders and which know no kind of result; the testcases that a CI
server is told of.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, Generic, Literal, NamedTuple, Self, TypeVar

Cell = str | float | int | bool | None
Tone = Literal["good", "bad", "odd"]
"""How a word is coloured. odd: an error of the program or the scenario, not of what was tested."""
Row = TypeVar("Row")
TestcaseStatus = Literal["passed", "failure", "error", "skipped"]


class Data(NamedTuple):
    """The names of columns and the rows under them, for programs; a row may lack columns."""

    columns: Sequence[str]
    rows: Sequence[dict[str, Cell]]

    @classmethod
    def of(cls, rows: Sequence[dict[str, Cell]]) -> Self:
        """Return rows with every column of any of them, in the order of their first use."""
        return cls(list(dict.fromkeys(column for row in rows for column in row)), rows)


@dataclass(frozen=True, slots=True, kw_only=True)
class Column(Generic[Row]):
    """A column of a table for people.

    Args:
        heading: what it is called; a line feed begins its second line, a unit, on a terminal.
        text: what people read of a row; any text, each format guards it.
        rank: where a terminal is too narrow the column of the highest rank is left out first, 0 never.
        right: whether it holds numbers.
        wraps: whether its texts may continue on the next line.
        literal: whether a reader must see each letter of it: a name, an id.
        tone: of the text of a row: a reader must not overlook one that is bad or odd.
    """

    heading: str
    text: Callable[[Row], str]
    rank: int = 0
    right: bool = False
    wraps: bool = False
    literal: bool = False
    tone: Callable[[Row], Tone | None] | None = None


class Table(NamedTuple):
    """Rows under columns; a column in which no row has a text is not shown.

    Args:
        columns: from left to right.
        rows: anything that the columns know.
        title: what the table shows.
        basis: what it rests on, in one sentence.
        more: where the columns and rows are that a format has no room for.
        most: rows that a reader of a summary is given; None: as many as there is room for.
        grouped_by: column whose texts stand above the rows that share them where a terminal is too narrow.
    """

    columns: Sequence[Column[Any]]
    rows: Sequence[Any]
    title: str = ""
    basis: str = ""
    more: str = ""
    grouped_by: Column[Any] | None = None
    most: int | None = None

    @property
    def texts(self) -> list[tuple[Column[Any], list[str]]]:
        """The columns that are shown, with a text for each row."""
        columns = [(each, [each.text(row) for row in self.rows]) for each in self.columns]
        return [(each, texts) for each, texts in columns if any(texts) or not texts]


class Lines(NamedTuple):
    """Sentences, each on a line of its own."""

    sentences: Sequence[str]
    title: str = ""


class Document(NamedTuple):
    """What a result says: its sections in their order; title and `about` stand on a page of its own only.

    `more` says where the sections are that a format has no room for.
    """

    title: str
    sections: Sequence[Table | Lines]
    about: Sequence[str] = ()
    more: str = ""


@dataclass(frozen=True, slots=True)
class Testcase:
    """One testcase.

    Args:
        class_name: under which a server groups it.
        name: its own.
        status: how it came out.
        lines: why; the first is the message, a server may show only that or only all of them.
        kind: of a failure, e.g. `baseline`.
        duration: s; None where it is not known.
        properties: by which tools know it; those without a text are left out.
    """

    __test__ = False  # the name is that of JUnit: no class of tests for pytest

    class_name: str
    name: str
    status: TestcaseStatus
    lines: Sequence[str] = ()
    kind: str = ""
    duration: float | None = None
    properties: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Suite:
    """Testcases that belong together, and what is known of all of them."""

    name: str
    testcases: Sequence[Testcase]
    duration: float | None = None
    properties: Mapping[str, str] = field(default_factory=dict)


def class_name(file: str) -> str:
    """Return the path of a file as servers group by it: `scenarios/dry.yaml` -> `scenarios.dry`."""
    path = PurePosixPath(file).with_suffix("")
    return ".".join(part for part in path.parts if part not in ("/", "..", "."))

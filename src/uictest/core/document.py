"""What a result says, for people and programs, before it is written in any format.

Tables and sentences, which each format renders and which know no kind of result; the testcases that a CI
server is told of.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, Final, Generic, Literal, NamedTuple, Protocol, TypeVar

Cell = str | float | int | bool | None
"""What programs read in a table; None, like NaN, where there is nothing."""
Tone = Literal["good", "bad", "odd"]
"""How a word is coloured. odd: an error of the program or the scenario, not of what was tested."""
Digits = int | Literal["significant"] | None
"""How people read numbers: so many decimals, or four significant digits. None: the column holds texts."""
Row = TypeVar("Row", contravariant=True)
TestcaseStatus = Literal["passed", "failure", "error", "skipped"]


def number_text(value: float | None, digits: Digits = "significant") -> str:
    """Return a number as people read it, `-` where there is none."""
    if value is None or math.isnan(value):
        return "-"
    return f"{value:.4g}" if digits == "significant" or digits is None else f"{value:.{digits}f}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Column(Generic[Row]):
    """A column of a table: what programs read of a row, and what people read.

    Args:
        key: its name for programs, in CSV, XLSX and JSON; empty: only people see the column.
        heading: its name for people; empty: only programs see the column. A line feed begins a second line.
        unit: that people read the numbers in.
        value: what programs read of a row; None: what the row, a mapping, has under the key.
        text: what people read of a row; None: the value, a number with `digits`.
        digits: of numbers as people read them.
        rank: where a terminal is too narrow the column of the highest rank is left out first, 0 never.
        right: whether a column with a `text` of its own holds numbers.
        wraps: whether its texts may continue on the next line.
        literal: whether a reader must see each letter of it: a name, an id.
        tone: of the text of a row: a reader must not overlook one that is bad or odd.
    """

    key: str = ""
    heading: str = ""
    unit: str = ""
    value: Callable[[Row], Cell] | None = None
    text: Callable[[Row], str] | None = None
    digits: Digits = None
    rank: int = 0
    right: bool = False
    wraps: bool = False
    literal: bool = False
    tone: Callable[[Row], Tone | None] | None = None

    @property
    def title(self) -> str:
        """The heading with the unit on a line of its own."""
        return f"{self.heading}\n{self.unit}" if self.unit else self.heading

    @property
    def is_number(self) -> bool:
        """Whether people read numbers in it."""
        return self.right or self.digits is not None

    def cell(self, row: Row) -> Cell:
        """Return what programs read of a row; None where there is nothing."""
        if self.value is not None:
            found = self.value(row)
        elif isinstance(row, Mapping):
            found = row.get(self.key)
        else:
            raise TypeError(f"column {self.key or self.heading!r} does not say what it reads of a row")
        return None if found != found else found

    def cell_text(self, row: Row) -> str:
        """Return what people read of a row; empty where there is nothing."""
        if self.text is not None:
            return self.text(row)
        value = self.cell(row)
        if value is None or isinstance(value, str):
            return value or ""
        if isinstance(value, bool):
            return "yes" if value else "no"
        return str(value) if self.digits is None else number_text(value, self.digits)


_AT_TOP: Final = ("summary", "wheelsets", "criteria")
"""Tables whose files stand at the top of the folder of a result; others are in `tables/`."""


class Rows(Protocol):
    """Rows of a table, which may be read from a file each time that they are iterated over."""

    def __len__(self) -> int:
        """Return their number."""

    def __iter__(self) -> Iterator[Any]:
        """Iterate over them."""


@dataclass(frozen=True, slots=True)
class Table:
    """Rows under columns.

    Args:
        columns: from left to right.
        rows: anything that the columns know.
        title: what the table shows.
        basis: what it rests on, in one sentence.
        name: of its CSV file and its sheet; empty where only people read it.
        all_in: where the columns and rows are that a format has no room for; empty: in the file of its name.
        most: rows that a reader of a summary is given; None: as many as there is room for.
        grouped_by: column whose texts stand above the rows that share them where a terminal is too narrow.
    """

    columns: Sequence[Column[Any]]
    rows: Rows
    title: str = ""
    basis: str = ""
    name: str = ""
    all_in: str = ""
    most: int | None = None
    grouped_by: Column[Any] | None = None

    @property
    def for_people(self) -> list[tuple[Column[Any], list[str]]]:
        """The columns that people see, with a text for each row; not those in which no row has one.

        A number that is not there is `-`.
        """
        columns = []
        for column in self.columns:
            texts = [column.cell_text(row) for row in self.rows] if column.heading else []
            if any(texts) or (column.heading and not len(self.rows)):
                missing = "-" if column.is_number else ""
                columns.append((column, [text or missing for text in texts]))
        return columns

    @property
    def for_programs(self) -> list[Column[Any]]:
        """The columns that programs see."""
        return [column for column in self.columns if column.key]

    @property
    def records(self) -> Iterator[dict[str, Cell]]:
        """Yield the rows for programs: key of a column -> cell."""
        columns = self.for_programs
        return ({column.key: column.cell(row) for column in columns} for row in self.rows)

    @property
    def file(self) -> str:
        """The name of its CSV file below the folder of the result; empty where only people read it."""
        return f"{'' if self.name in _AT_TOP else 'tables/'}{self.name}.csv" if self.name else ""

    @property
    def more(self) -> str:
        """Where the columns and rows are that a format has no room for."""
        return self.all_in or self.file


def table_of(name: str, rows: Sequence[Mapping[str, Cell]], keys: Iterable[str] = ()) -> Table:
    """Return a table for programs alone, with `keys` and then every other key of any row as its columns."""
    known = dict.fromkeys([*keys, *(key for row in rows for key in row)])
    return Table([Column(key=key) for key in known], rows, name=name)


def keyed_columns(
    keys: Iterable[str], cells: Callable[[Any], Mapping[str, Cell]], prefix: str = ""
) -> list[Column[Any]]:
    """Return columns for programs, of which a function gives the cells of a row by their keys."""

    def column(key: str) -> Column[Any]:
        return Column(key=f"{prefix}{key}", value=lambda row: cells(row).get(key))

    return [column(key) for key in keys]


class Lines(NamedTuple):
    """Sentences, each on a line of its own."""

    sentences: Sequence[str]
    title: str = ""


class Block(NamedTuple):
    """Something to act on: what it is, the facts about it, the command that shows it again."""

    heading: str
    lines: Sequence[str]
    command: str = ""
    tone: Tone | None = None


class Blocks(NamedTuple):
    """Blocks below each other."""

    blocks: Sequence[Block]
    title: str = ""


Section = Table | Lines | Blocks
"""A part of a document."""


class Document(NamedTuple):
    """What a result says to people: its sections in their order.

    `about` stands below the title on a page of its own only; `all_in` says where the sections are that a
    format has no room for.
    """

    title: str
    sections: Sequence[Section]
    about: Sequence[str] = ()
    all_in: str = "results.json"


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

"""Tables and sentences that say a result: each format renders them and knows no kind of result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

Cell = str | float | int | bool | None
Row = TypeVar("Row")


@dataclass(frozen=True, slots=True)
class Column(Generic[Row]):
    """A column of a table, told once for people and for programs.

    Args:
        heading: for people; empty: only programs see it. A line feed begins its second line on a terminal.
        text: what people read of a row; any text, each format guards it.
        key: name in files for programs; empty: only people see it.
        value: what programs read of a row; by default the text.
        rank: where a terminal is too narrow the column of the highest rank is left out first, 0 never.
        right: whether it holds numbers.
        wraps: whether its texts may continue on the next line.
        literal: whether a reader must see each letter of it: a name, an id.
    """

    heading: str
    text: Callable[[Row], str]
    key: str = ""
    value: Callable[[Row], Cell] | None = None
    rank: int = 0
    right: bool = False
    wraps: bool = False
    literal: bool = False

    def cell(self, row: Row) -> Cell:
        """Return what programs read of a row."""
        return self.text(row) if self.value is None else self.value(row)


@dataclass(frozen=True, slots=True)
class Table:
    """Rows under columns; `more` says where the columns and rows are that a format has no room for."""

    columns: Sequence[Column[Any]]
    rows: Sequence[Any]
    title: str = ""
    more: str = ""

    @property
    def shown(self) -> list[Column[Any]]:
        """The columns for people."""
        return [each for each in self.columns if each.heading]


@dataclass(frozen=True, slots=True)
class Lines:
    """Sentences, each on a line of its own."""

    sentences: Sequence[str]
    title: str = ""


@dataclass(frozen=True, slots=True)
class Document:
    """What a result says: its sections in their order."""

    title: str
    sections: Sequence[Table | Lines]

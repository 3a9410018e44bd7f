"""What the stops of a log show together: tables of data, which every format of a report renders."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple

from pydantic import ConfigDict, TypeAdapter

from uictest.core.document import Cell, Column, Data, Lines, Table
from uictest.judging import evaluation
from uictest.report.verdict_sentences import number

Place = Literal["first", "detail"]
"""Where a table stands: before the stops, or behind them."""
Digits = int | Literal["significant"] | None
STOPS: Final = "stops"
"""Key of the column that names stops, separated by commas."""
_DIGITS: Final = range(16)
_MOST: Final = 30
"""Rows of a table that a reader of a summary is given."""


class CampaignColumn(NamedTuple):
    """A column: its key for programs, its heading for people, and how many digits of its numbers they see.

    `digits` is None for a column of texts, of which long ones may wrap; `significant` where the rows have
    numbers of different size.
    """

    key: str
    heading: str
    digits: Digits = None
    wraps: bool = False


@dataclass(frozen=True, slots=True)
class CampaignTable:
    """A table over the stops of a log.

    Args:
        name: of its file and its sheet.
        title: what it shows.
        basis: what it rests on, in one sentence.
        place: where it stands.
        columns: of the rows.
        rows: a cell for each column; None where there is none, or a number that is not known.
    """

    name: str
    title: str
    basis: str
    place: Place
    columns: tuple[CampaignColumn, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def __post_init__(self) -> None:
        """Raise ValueError for what no table can show: a document may have been changed by hand."""
        if any(len(row) != len(self.columns) for row in self.rows):
            raise ValueError(f"table {self.name!r}: a row has not one cell for each column")
        if any(isinstance(each.digits, int) and each.digits not in _DIGITS for each in self.columns):
            raise ValueError(f"table {self.name!r}: digits of a column must be 0 to {_DIGITS[-1]}")
        known = tuple(tuple(cell if cell == cell else None for cell in row) for row in self.rows)
        object.__setattr__(self, "rows", known)

    @property
    def data(self) -> Data:
        """The table for programs."""
        keys = [column.key for column in self.columns]
        return Data(keys, [dict(zip(keys, row, strict=True)) for row in self.rows])

    def document(self) -> Table:
        """Return the table for people, without columns that no row has."""
        filled = [k for k in range(len(self.columns)) if any(row[k] is not None for row in self.rows)]
        columns = [_column(self.columns[k], k) for k in filled or range(len(self.columns))]
        more = f"more rows are in `{file_name(self)}.csv`."
        return Table(columns, self.rows, self.title, self.basis, more, most=_MOST)


def _column(column: CampaignColumn, place: int) -> Column[Sequence[Cell]]:
    return Column(
        heading=column.heading,
        text=_text_of(place, column.digits),
        rank=place,
        right=column.digits is not None,
        wraps=column.wraps,
    )


def _text_of(place: int, digits: Digits) -> Callable[[Sequence[Cell]], str]:
    def text(row: Sequence[Cell]) -> str:
        cell = row[place]
        if cell is None or digits is None or isinstance(cell, str):
            return "" if cell is None else str(cell)
        return number(cell) if digits == "significant" else f"{cell:.{digits}f}"

    return text


@dataclass(frozen=True, slots=True)
class Campaign:
    """What the stops of a log show together: in sentences, and in tables."""

    sentences: tuple[str, ...] = ()
    tables: tuple[CampaignTable, ...] = ()

    def at(self, place: Place) -> list[CampaignTable]:
        """Return the tables that stand at a place and have rows."""
        return [table for table in self.tables if table.place == place and table.rows]

    @property
    def sections(self) -> list[Table | Lines]:
        """The sections of a summary."""
        lines = [Lines(self.sentences, "All stops together")] if self.sentences else []
        return [*lines, *(table.document() for place in _PLACES for table in self.at(place))]


_PLACES: Final[tuple[Place, ...]] = ("first", "detail")


def file_name(table: CampaignTable) -> str:
    """Return the name of the file of a table, without `.csv`."""
    return f"campaign_{table.name}"


def campaign_data(campaign: Campaign | None) -> dict[str, Data]:
    """Return the tables for programs that have rows, by the names of their files."""
    return {file_name(each): each.data for each in campaign.tables if each.rows} if campaign else {}


_FORM: Final = TypeAdapter(tuple[Campaign, ...], config=ConfigDict(extra="forbid", defer_build=True))


def campaign_form(campaign: Campaign) -> dict[str, Any]:
    """Return the JSON form of a campaign."""
    form: dict[str, Any] = evaluation.to_json_form(_FORM, (campaign,))[0]
    return form


def read_campaign(document: Mapping[str, Any]) -> Campaign | None:
    """Return the campaign of a document, None without one. Raises ValueError where it is none."""
    content = document.get("campaign")
    return evaluation.from_json_form(_FORM, [content], place="campaign")[0] if content else None

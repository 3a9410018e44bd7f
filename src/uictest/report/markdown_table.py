"""A table in Markdown that keeps to the room there is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

_RULES = {"l": "---", "r": "--:"}
_RESERVE = 200  # bytes kept for the line that says what was left out


@dataclass(frozen=True, slots=True)
class MarkdownTable:
    """A table whose cells are Markdown already.

    Args:
        columns: their headings.
        alignment: a letter for each column: `l` for texts, `r` for figures.
        rows: see `row`.
        rest: what stands behind the number of rows that were left out, e.g. `more cases are in ...`.
        most: rows that a reader is to be given, None for all.

    """

    columns: Sequence[str]
    alignment: str
    rows: Sequence[str]
    rest: str = ""
    most: int | None = None

    def within(self, room: int) -> str:
        """Return the table in at most so many bytes; empty where there is no room for a single row.

        Where rows were left out, a last line says how many.
        """
        head = row(self.columns) + f"|{'|'.join(_RULES[letter] for letter in self.alignment)}|\n"
        shown = list(_fitting(self.rows[: self.most], room - len(head.encode()) - _RESERVE))
        if not shown and self.rows:
            return ""
        left_out = len(self.rows) - len(shown)
        return head + "".join(shown) + (f"\n{left_out} {self.rest}\n" if left_out else "")


def row(cells: Iterable[str]) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(cells)} |\n"


def _fitting(rows: Iterable[str], room: int) -> Iterator[str]:
    for each in rows:
        room -= len(each.encode())
        if room < 0:
            return
        yield each

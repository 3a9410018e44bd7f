"""Tables as HTML that needs no style sheet, for a notebook."""

from __future__ import annotations

from html import escape
from typing import Final

from uictest.core.document import Table, Tone
from uictest.report.words import printable

_COLOURS: Final[dict[Tone, str]] = {"good": "#1a7f37", "bad": "#cf222e", "odd": "#8250df"}


def html_table(table: Table) -> str:
    """Return a table; texts are escaped."""
    columns = table.for_people
    heads = "".join(f"<th>{escape(column.title.replace(chr(10), ', '))}</th>" for column, _ in columns)
    rows = [
        "".join(_cell(texts[number], column.tone(row) if column.tone else None) for column, texts in columns)
        for number, row in enumerate(table.rows)
    ]
    body = "".join(f"<tr>{cells}</tr>" for cells in rows)
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>"


def _cell(text: str, tone: Tone | None) -> str:
    style = f' style="color:{_COLOURS[tone]}"' if tone else ""
    return f"<td{style}>{escape(printable(text))}</td>"

"""One table with every kind of cell, one document, and texts that a reader could take for something else."""

from typing import NamedTuple

from hypothesis import strategies as st

from uictest.core.document import Column, Document, Lines, Table

from ..builders import HOSTILE


class Row(NamedTuple):
    case: str
    distance: float | None
    vents: int
    met: bool
    why: str = ""


ROWS = (
    Row("slide-80[friction=0.10]", 465.254, 7, True),
    Row("wet-80", None, 0, False, "wheelset 2 stands"),
    Row("dry-120", float("nan"), 12, True),
)
COLUMNS = (
    Column(key="id", heading="case", value=lambda row: row.case, literal=True, wraps=True),
    Column(
        heading="verdict",
        text=lambda row: "pass" if row.met else "fail",
        tone=lambda row: "good" if row.met else "bad",
    ),
    Column(key="braking_distance_m", heading="distance", unit="m", value=lambda row: row.distance, digits=1),
    Column(key="share", value=lambda row: 0.1 + 0.2),
    Column(key="vents", heading="vents", value=lambda row: row.vents, digits=0, rank=1),
    Column(key="met", heading="met", value=lambda row: row.met, rank=2),
    Column(heading="energy\nkJ", value=lambda row: 1234567.0 * row.vents, digits="significant", rank=3),
    Column(key="why", heading="why", value=lambda row: row.why, wraps=True, rank=4),
    Column(key="never", heading="remark", value=lambda row: None),
)
TABLE = Table(COLUMNS, ROWS, "Cases", "All of them", name="cells")
DOCUMENT = Document(
    "A run", [TABLE, Lines(["One sentence", "Another"], "Notes"), Lines([]), Table(COLUMNS, ())]
)

ANY_TEXT = st.text(st.characters(codec=None, exclude_categories=[]), max_size=40)
"""Any characters, lone surrogates and control characters, too."""
TEXTS = (
    *(HOSTILE, "", "[red]x[/red]\x1b[2J", "x" * 40_000, "Bremsweg 465 m, größer, 제동 거리"),
    *("=1+1", "+A1", "-A1", "@SUM(A1)", "\t=1", "\r=1", " =1", "\uff1d1", "{=A1}", "-5 A1", "-5 bar+A1"),
    *("-5 bar|x", "-5  bar", "-5 bar\n", "-5 -5", "-bar", "+1 furlong"),
    *("http://example.org", "mailto:a@b", "<script>alert(1)</script>", "<img src=x>", "]]>", "&amp;"),
    *("`|\\``", "[a](javascript:b)", "![c](d)", "~~e~~", "@team #1", "- - -", "1. a"),
    *("::error::x", "##[error]x"),
)
"""Texts that a terminal, a spreadsheet, a browser or a reader of Markdown could take for something else."""


def table_of_texts(texts):
    """A table whose names and texts are these."""
    columns = [
        Column(key="name", heading="name", value=str, literal=True),
        Column(key="text", heading="text", value=str, tone=lambda text: "bad" if len(text) > 20 else None),
    ]
    return Table(columns, texts, name="texts")

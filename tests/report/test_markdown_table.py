from __future__ import annotations

from hypothesis import given, strategies as st
from markdown_it import MarkdownIt

from uictest.report.text_tables import MarkdownTable, code, number_cell, prose, row

_READER = MarkdownIt("commonmark", {"html": True}).enable("table")


def _table(rows: list[str]) -> MarkdownTable:
    return MarkdownTable(("case", "number_cell"), "lr", rows, "more are elsewhere.")


def test_a_table_says_which_columns_are_figures() -> None:
    assert _table([row(["a", "1"])]).within(1000) == "| case | number_cell |\n|---|--:|\n| a | 1 |\n"


def test_rows_without_room_are_counted() -> None:
    lines = _table([row(["é" * 40, str(n)]) for n in range(10)]).within(600).splitlines()
    assert lines[-1] == f"{10 - len(lines[2:-2])} more are elsewhere."


def test_without_rows_a_table_shows_its_columns() -> None:
    assert _table([]).within(1000) == "| case | number_cell |\n|---|--:|\n"


@given(st.lists(st.text(max_size=50)), st.integers(-100, 3000))
def test_a_table_never_takes_more_room_than_there_is(texts: list[str], room: int) -> None:
    rows = [row([text, "1"]) for text in texts]
    if rows:
        assert len(_table(rows).within(room).encode()) <= max(room, 0)


@given(st.text())
def test_a_text_in_a_code_span_is_only_that(text: str) -> None:
    row = f"| a | b |\n|---|---|\n| {code(text)} | x |\n"
    tokens = [token for token in _READER.parse(row) if token.type == "inline"]
    assert len(tokens) == 4
    assert {child.type for child in tokens[2].children or []} <= {"code_inline"}


@given(st.text())
def test_prose_holds_no_markup(text: str) -> None:
    tokens = _READER.parse(f"x{prose(text)}x")
    kinds = {child.type for token in tokens for child in token.children or []}
    assert kinds <= {"text"}


def test_no_figure_is_a_dash() -> None:
    shown = [number_cell(value, ".1f") for value in (1.25, None, float("nan"))]
    assert shown == ["1.2", "–", "–"]  # noqa: RUF001 - a dash on paper

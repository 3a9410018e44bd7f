from __future__ import annotations

from hypothesis import given, strategies as st

from uictest.report.markdown_table import MarkdownTable, row


def _table(rows: list[str]) -> MarkdownTable:
    return MarkdownTable(("case", "figure"), "lr", rows, "more are elsewhere.")


def test_a_table_says_which_columns_are_figures() -> None:
    assert _table([row(["a", "1"])]).within(1000) == "| case | figure |\n|---|--:|\n| a | 1 |\n"


def test_rows_without_room_are_counted() -> None:
    lines = _table([row(["é" * 40, str(n)]) for n in range(10)]).within(600).splitlines()
    assert lines[-1] == f"{10 - len(lines[2:-2])} more are elsewhere."


def test_without_rows_a_table_shows_its_columns() -> None:
    assert _table([]).within(1000) == "| case | figure |\n|---|--:|\n"


@given(st.lists(st.text(max_size=50)), st.integers(-100, 3000))
def test_a_table_never_takes_more_room_than_there_is(texts: list[str], room: int) -> None:
    rows = [row([text, "1"]) for text in texts]
    if rows:
        assert len(_table(rows).within(room).encode()) <= max(room, 0)

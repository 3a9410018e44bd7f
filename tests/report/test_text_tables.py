"""Tables as CSV and Markdown, documents as Markdown: whatever the texts and however little room there is."""

import csv
import io

import pytest
from hypothesis import example, given, settings, strategies as st
from markdown_it import MarkdownIt

from uictest.core.document import Column, Document, Lines, Table
from uictest.report import csv_text
from uictest.report.escaping import csv_cell
from uictest.report.text_tables import code, document_markdown, markdown_table, number_cell, prose

_READER = MarkdownIt("commonmark", {"html": True}).enable("table")
_TEXT = st.text(max_size=50) | st.sampled_from(["`|\\``", "<img src=x>", "[a](javascript:b)", "~~e~~", "#1"])
_NAMES = Column(heading="name", text=str, literal=True)
_TEXTS = Column(heading="text", text=str, tone=lambda text: "bad" if len(text) > 20 else None)


def _document(texts):
    first = texts[0]
    tables = [Table([_NAMES, _TEXTS], texts, first, basis=first, more="more rows are elsewhere.")] * 2
    return Document(first, [*tables, Lines(texts, first)], about=[first], more="more sections elsewhere.")


def _kinds(text):
    """The kinds of everything that a reader of Markdown finds in a text."""
    tokens = _READER.parse(text)
    return {each.type for token in tokens for each in (token, *(token.children or []))}


def _table(rows):
    columns = [
        Column(heading="case", text=lambda row: row[0]),
        Column(heading="number", text=lambda row: row[1], right=True),
    ]
    return Table(columns, rows, more="more are elsewhere.")


@given(st.lists(st.fixed_dictionaries({}, optional={"a": _TEXT, "=b": _TEXT})))
def test_csv_has_each_text_in_its_cell_and_none_that_is_a_formula(rows):
    header, *read = csv.reader(io.StringIO(csv_text(["a", "=b"], rows)))
    assert header == ["a", "'=b"]
    assert read == [[csv_cell(each.get(name, "")) for name in ("a", "=b")] for each in rows]
    assert all(cell.isprintable() for line in read for cell in line)


def test_csv_has_exact_numbers_and_an_empty_cell_where_there_is_none():
    row = {"a": 0.1 + 0.2, "b": float("nan"), "c": None, "d": True, "e": 3}
    assert csv_text("abcdef", [row]) == "a,b,c,d,e,f\n0.30000000000000004,,,true,3,\n"


def test_a_table_says_which_columns_are_figures():
    assert markdown_table(_table([("a", "1")])) == "| case | number |\n|---|--:|\n| a | 1 |\n"


def test_rows_without_room_are_counted():
    lines = markdown_table(_table([("é" * 40, str(n)) for n in range(10)]), 600).splitlines()
    assert lines[-1] == f"{10 - len(lines[2:-2])} more are elsewhere."


def test_without_rows_a_table_shows_its_columns():
    assert markdown_table(_table([])) == "| case | number |\n|---|--:|\n"


@given(st.lists(st.text(max_size=50)), st.integers(-100, 3000))
def test_a_table_never_takes_more_room_than_there_is(texts, room):
    if texts:
        shown = markdown_table(_table([(text, "1") for text in texts]), room)
        assert len(shown.encode()) <= max(room, 0)


@given(st.text())
def test_a_text_in_a_code_span_is_only_that(text):
    row = f"| a | b |\n|---|---|\n| {code(text)} | x |\n"
    tokens = [token for token in _READER.parse(row) if token.type == "inline"]
    assert len(tokens) == 4
    assert {child.type for child in tokens[2].children or []} <= {"code_inline"}


@given(st.text())
def test_prose_holds_no_markup(text):
    tokens = _READER.parse(f"x{prose(text)}x")
    kinds = {child.type for token in tokens for child in token.children or []}
    assert kinds <= {"text"}


@pytest.mark.parametrize("text", ["--", "- a", "+ a", "+", "1. a", "12) a", "3.", " ---", "- - -"])
def test_a_sentence_begins_no_block(text):
    tokens = _READER.parse(f"- {prose(text)}\n")
    assert [each.type for each in tokens].count("list_item_open") == 1
    [inline] = [each for each in tokens if each.type == "inline"]
    assert "".join(child.content for child in inline.children or []) == text.strip()


@given(st.lists(_TEXT, min_size=1, max_size=5))
@example(["--"])
def test_a_document_holds_no_markup_but_its_own(texts):
    kinds = {
        kind.removesuffix("_open").removesuffix("_close")
        for kind in _kinds(document_markdown(_document(texts)))
    }
    own = {"heading", "paragraph", "table", "thead", "tbody", "tr", "th", "td", "bullet_list", "list_item"}
    assert kinds <= own | {"inline", "text", "code_inline", "strong", "softbreak"}


@given(st.integers(1, 100), st.integers(0, 100), st.integers(5_000, 20_000))
@settings(max_examples=30)
def test_a_document_keeps_its_limit_and_counts_what_it_leaves_out(rows, length, limit):
    texts = [f"{n}{'💥`|&<' * length}" for n in range(rows)]
    whole, shown = (document_markdown(_document(texts), most) for most in (None, limit))
    assert len(shown.encode()) <= limit  # which is more than title and sentences above the sections take
    assert shown == whole or "more" in shown.splitlines()[-1] or "more rows are elsewhere." in shown


def test_no_figure_is_a_dash():
    shown = [number_cell(value, ".1f") for value in (1.25, None, float("nan"))]
    assert shown == ["1.2", "–", "–"]  # noqa: RUF001 - a dash on paper

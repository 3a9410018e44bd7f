"""Documents as Markdown: nothing but their own markup, within the limit, and what is left out is counted."""

import pytest
from hypothesis import example, given, settings, strategies as st
from markdown_it import MarkdownIt

from uictest.core.document import Document, Lines, Table
from uictest.report.formats.markdown import code, document_markdown, markdown_table, prose

from .made_up import COLUMNS, DOCUMENT, ROWS, TABLE, TEXTS, table_of_texts

READER = MarkdownIt("commonmark", {"html": True}).enable("table")
ANY = st.text(max_size=50) | st.sampled_from([text for text in TEXTS if len(text) < 100])


def kinds(text):
    """The kinds of everything that a reader of Markdown finds in a text."""
    tokens = READER.parse(text)
    return {each.type for token in tokens for each in (token, *(token.children or []))}


def document_of(texts):
    table = Table(table_of_texts([]).columns, texts, texts[0], basis=texts[0], all_in="x.csv")
    return Document(texts[0], [table, table, Lines(texts, texts[0])], about=[texts[0]])


def test_a_document_is_headings_tables_and_lists():
    assert document_markdown(DOCUMENT, level=2) == (
        "## A run\n\n### Cases\n\nAll of them\n\n"
        "| case | verdict | distance, m | vents | met | energy, kJ | why |\n|---|---|--:|--:|---|--:|---|\n"
        "| `slide-80[friction=0.10]` | pass | 465.3 | 7 | yes | 8.642e+06 |  |\n"
        "| `wet-80` | **fail** | - | 0 | no | 0 | wheelset 2 stands |\n"
        "| `dry-120` | pass | - | 12 | yes | 1.481e+07 |  |\n"
        "\n### Notes\n\n- One sentence\n- Another\n"
    )


def test_rows_without_room_or_beyond_the_most_are_counted_and_a_table_without_any_shows_its_columns():
    many = Table(COLUMNS, ROWS * 10, name="cells")
    *_, last = shown = markdown_table(many, 1500).splitlines()
    assert last == f"{30 - sum(line.startswith('| `') for line in shown)} more in `tables/cells.csv`."
    assert markdown_table(Table(COLUMNS, ROWS, all_in="results.json", most=1)).endswith(
        "2 more in `results.json`.\n"
    )
    assert markdown_table(TABLE, 10) == markdown_table(table_of_texts([""])) == ""
    assert markdown_table(Table(COLUMNS[:2], ())) == "| case | verdict |\n|---|---|\n"


@given(st.integers(1, 100), st.integers(0, 100), st.integers(5_000, 20_000))
@settings(max_examples=30)
def test_a_document_keeps_its_limit_and_counts_what_it_leaves_out(rows, length, limit):
    document = document_of([f"{n}{'💥`|&<' * length}" for n in range(rows)])
    whole, shown = (document_markdown(document, most) for most in (None, limit))
    assert len(shown.encode()) <= limit  # which is more than title and sentences above the sections take
    assert shown == whole or "more in `results.json`" in shown or "more in `x.csv`" in shown


@given(st.lists(st.text(max_size=50), min_size=1), st.integers(-100, 3000))
def test_a_table_never_takes_more_room_than_there_is(texts, room):
    assert len(markdown_table(table_of_texts(texts), room).encode()) <= max(room, 0)


@given(st.lists(ANY, min_size=1, max_size=5))
@example(["--"])
@example([text[:300] for text in TEXTS])
def test_a_document_holds_no_markup_but_its_own_and_nothing_invisible(texts):
    text = document_markdown(document_of(texts))
    own = {"heading", "paragraph", "table", "thead", "tbody", "tr", "th", "td", "bullet_list", "list_item"}
    found = {kind.removesuffix("_open").removesuffix("_close") for kind in kinds(text)}
    assert found <= own | {"inline", "text", "code_inline", "strong", "softbreak"}
    assert text.replace("\n", "").isprintable()


@given(st.text())
def test_a_text_in_a_code_span_is_only_that(text):
    row = f"| a | b |\n|---|---|\n| {code(text)} | x |\n"
    tokens = [token for token in READER.parse(row) if token.type == "inline"]
    assert len(tokens) == 4
    assert {child.type for child in tokens[2].children or []} <= {"code_inline"}


@given(st.text())
def test_prose_holds_no_markup(text):
    assert kinds(f"x{prose(text)}x") <= {"text", "inline", "paragraph_open", "paragraph_close"}


@pytest.mark.parametrize("text", ["--", "- a", "+ a", "+", "1. a", "12) a", "3.", " ---", "- - -"])
def test_a_sentence_begins_no_block(text):
    tokens = READER.parse(f"- {prose(text)}\n")
    assert [token.type for token in tokens].count("list_item_open") == 1
    [inline] = [token for token in tokens if token.type == "inline"]
    assert "".join(child.content for child in inline.children or []) == text.strip()


def test_a_long_text_is_cut():
    assert len(prose("x" * 1000)) == len(code("x" * 1000)) - 2 == 300

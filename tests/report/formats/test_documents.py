"""Documents as Markdown and on a terminal: nothing but their own markup, within the room that there is."""

from dataclasses import replace

import pytest
from hypothesis import example, given, settings, strategies as st
from markdown_it import MarkdownIt

from uictest.core.document import Column, Document, Lines, Table
from uictest.report.formats.markdown import code, document_markdown, markdown_table, prose
from uictest.report.formats.text import aligned_rows, document_lines, table_lines, titled_lines, wrapped_name

from .made_up import ANY_TEXT, COLUMNS, DOCUMENT, ROWS, TABLE, TEXTS, Row, table_of_texts

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
def test_a_text_in_a_code_span_is_only_that_and_prose_holds_no_markup(text):
    row = f"| a | b |\n|---|---|\n| {code(text)} | x |\n"
    tokens = [token for token in READER.parse(row) if token.type == "inline"]
    assert len(tokens) == 4
    assert {child.type for child in tokens[2].children or []} <= {"code_inline"}
    assert kinds(f"x{prose(text)}x") <= {"text", "inline", "paragraph_open", "paragraph_close"}


@pytest.mark.parametrize("text", ["--", "- a", "+ a", "+", "1. a", "12) a", "3.", " ---", "- - -"])
def test_a_sentence_begins_no_block(text):
    tokens = READER.parse(f"- {prose(text)}\n")
    assert [token.type for token in tokens].count("list_item_open") == 1
    [inline] = [token for token in tokens if token.type == "inline"]
    assert "".join(child.content for child in inline.children or []) == text.strip()


def test_a_long_text_is_cut():
    assert len(prose("x" * 1000)) == len(code("x" * 1000)) - 2 == 300


LONG = (
    "a-stop[rail.friction=0.10,brake.command=100 %,controller.slip_threshold=0.80,initial_speed=120 km-h,x=1]"
)
GROUP = Column(heading="group", text=lambda row: row[0], wraps=True)
NAME = Column(heading="name", text=lambda row: row[1], wraps=True)
REMARK = Column(heading="remark\nm", text=lambda _: "of ten, m", rank=1)


def grouped_table(rows, *, grouped=False):
    return Table([GROUP, NAME, REMARK], rows, "title", all_in="x.csv", grouped_by=GROUP if grouped else None)


def test_a_document_has_its_sections_and_its_table_aligned_under_headings_and_titles_where_asked():
    cells = list(table_lines(TABLE, None))
    assert cells == [
        "case                     verdict  distance  vents  met     energy  why",
        "                                         m                     kJ",
        "slide-80[friction=0.10]  pass        465.3      7  yes  8.642e+06",
        "wet-80                   fail            -      0  no           0  wheelset 2 stands",
        "dry-120                  pass            -     12  yes  1.481e+07",
    ]
    assert list(aligned_rows([["a", "bc"], ["abc", "d"]])) == ["a    bc", "abc  d"]
    assert list(document_lines(DOCUMENT, None)) == [*cells, "One sentence", "Another"]
    titled = ["Cases: All of them", *(f"  {line}" for line in cells), "", "One sentence", "Another", ""]
    assert list(titled_lines(DOCUMENT.sections, None)) == titled
    # Tones are colours of the words alone.
    coloured = list(table_lines(TABLE, None, coloured=True))
    assert sum("\x1b[32mpass   \x1b[0m" in line for line in coloured) == 2
    assert sum("\x1b[1;31mfail   \x1b[0m" in line for line in coloured) == 1


@given(
    st.lists(st.tuples(ANY_TEXT, ANY_TEXT), min_size=1, max_size=5),
    st.booleans(),
    st.none() | st.integers(30, 99),
)
@example([("[red]x[/red]\x1b[2J", "a\nb")], True, 40)
def test_whatever_the_texts_no_line_drives_the_terminal_or_leaves_its_width(rows, grouped, width):
    table, sentences = grouped_table(rows, grouped=grouped), Lines([text for row in rows for text in row])
    assert all(line.isprintable() for line in document_lines(Document("", [table, sentences]), width))
    assert all(line.isprintable() for line in titled_lines([table, sentences], width))
    if width is not None:
        shown = [line for line in table_lines(table, width) if not line.startswith("not shown")]
        assert max(map(len, shown)) <= width


@given(st.integers(10, 120), st.lists(st.sampled_from(ROWS), min_size=1))
def test_a_column_of_rank_0_is_never_left_out_and_the_highest_rank_goes_first(width, rows):
    table = Table(
        [replace(column, text=lambda _: "some text") for column in COLUMNS], rows, all_in="cells.csv"
    )
    head, *lines = table_lines(table, width)
    shown = {column.rank for column in COLUMNS if f" {column.heading.split(chr(10))[0]}" in f" {head}"}
    left_out = {column.rank for column in COLUMNS if column.heading} - shown
    assert 0 in shown
    assert not left_out or max(shown) < min(left_out)
    assert ("not shown for" in " ".join(" ".join(lines).split())) == bool(left_out)
    assert left_out or max(map(len, (head, *lines))) <= width


@pytest.mark.parametrize("width", [40, 60, 80, 100, 120, 200])
def test_names_are_whole_in_any_width_and_figures_give_way(width):
    rows = [Row("dry-120", 465.2, 1, True), Row(LONG, 465.2, 1, True, "largest at 12.3 s")]
    lines = list(table_lines(Table(COLUMNS, rows, all_in="cells.csv"), width))
    assert max(map(len, lines)) <= width
    ends = [number for number, line in enumerate(lines) if line.startswith("not shown for lack of room: ")]
    table = lines[: min(ends, default=len(lines))]
    of_case = table[0].index("verdict")
    name = "".join(line[:of_case].strip() for line in table[3:]).replace(" ", "")
    assert name == LONG.replace(" ", "")


@pytest.mark.parametrize("grouped", [True, False])
def test_columns_that_give_way_are_named_once_with_their_place(grouped):
    rows = [("first group", "a-name"), ("first group", "another"), ("second", "a-name")]
    lines = list(table_lines(grouped_table(rows, grouped=grouped), 14))
    text = " ".join(" ".join(lines).split())
    assert text.endswith("not shown for lack of room: remark; x.csv has all")
    # What rows share stands above them once.
    assert sum("second" in line for line in lines) == 1
    assert sum("first" in line for line in lines) == (1 if grouped else 2)


@pytest.mark.parametrize(
    ("name", "width", "lines"),
    [
        ("slide-80[compensation=hysteresis]", 22, ["slide-80[compensation=", "hysteresis]"]),
        ("slide-80[compensation=hysteresis]", 20, ["slide-80", "[compensation=", "hysteresis]"]),
        ("wet-80-command[command=100]", 14, ["wet-80-command", "[command=100]"]),
        ("0123456789", 4, ["0123", "4567", "89"]),
    ],
)
def test_a_name_is_broken_between_its_words_and_a_word_only_where_it_is_longer(name, width, lines):
    assert wrapped_name(name, width) == lines


@given(st.text("ab0[]=,-_ .", max_size=60), st.integers(1, 30))
def test_a_wrapped_name_keeps_every_character_and_the_width(name, width):
    lines = wrapped_name(name, width)
    assert "".join(lines).replace(" ", "") == name.replace(" ", "")
    assert max(map(len, lines)) <= width

"""Documents on a terminal: within the width, names whole, and what is left out is named."""

from dataclasses import replace

import pytest
from hypothesis import example, given, strategies as st

from uictest.core.document import Column, Document, Lines, Table
from uictest.report.formats.text import aligned_rows, document_lines, table_lines, titled_lines, wrapped_name

from .made_up import ANY_TEXT, COLUMNS, DOCUMENT, ROWS, TABLE, Row

LONG = (
    "a-stop[rail.friction=0.10,brake.command=100 %,controller.slip_threshold=0.80,initial_speed=120 km-h,x=1]"
)
GROUP = Column(heading="group", text=lambda row: row[0], wraps=True)
NAME = Column(heading="name", text=lambda row: row[1], wraps=True)
REMARK = Column(heading="remark\nm", text=lambda _: "of ten, m", rank=1)


def grouped_table(rows, *, grouped=False):
    return Table([GROUP, NAME, REMARK], rows, "title", all_in="x.csv", grouped_by=GROUP if grouped else None)


def test_a_table_is_aligned_under_its_headings():
    assert list(table_lines(TABLE, None)) == [
        "case                     verdict  distance  vents  met     energy  why",
        "                                         m                     kJ",
        "slide-80[friction=0.10]  pass        465.3      7  yes  8.642e+06",
        "wet-80                   fail            -      0  no           0  wheelset 2 stands",
        "dry-120                  pass            -     12  yes  1.481e+07",
    ]
    assert list(aligned_rows([["a", "bc"], ["abc", "d"]])) == ["a    bc", "abc  d"]


def test_a_document_has_its_sections_and_titles_where_they_are_asked_for():
    cells = list(table_lines(TABLE, None))
    assert list(document_lines(DOCUMENT, None)) == [*cells, "One sentence", "Another"]
    titled = ["Cases: All of them", *(f"  {line}" for line in cells), "", "One sentence", "Another", ""]
    assert list(titled_lines(DOCUMENT.sections, None)) == titled


def test_tones_are_colours_of_the_words_alone():
    lines = list(table_lines(TABLE, None, coloured=True))
    assert sum("\x1b[32mpass   \x1b[0m" in line for line in lines) == 2
    assert sum("\x1b[1;31mfail   \x1b[0m" in line for line in lines) == 1


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
    head, *_, last = table_lines(table, width)
    shown = {column.rank for column in COLUMNS if f" {column.heading.split(chr(10))[0]}" in f" {head}"}
    left_out = {column.rank for column in COLUMNS if column.heading} - shown
    assert 0 in shown
    assert not left_out or max(shown) < min(left_out)
    assert last.startswith("not shown for lack of room: ") == bool(left_out)
    assert left_out or max(map(len, (head, last))) <= width


@pytest.mark.parametrize("width", [40, 60, 80, 100, 120, 200])
def test_names_are_whole_in_any_width_and_figures_give_way(width):
    rows = [Row("dry-120", 465.2, 1, True), Row(LONG, 465.2, 1, True, "largest at 12.3 s")]
    lines = list(table_lines(Table(COLUMNS, rows, all_in="cells.csv"), width))
    table = [line for line in lines if not line.startswith("not shown")]
    assert max(map(len, table)) <= width
    of_case = table[0].index("verdict")
    name = "".join(line[:of_case].strip() for line in table[3:]).replace(" ", "")
    assert name == LONG.replace(" ", "")


@pytest.mark.parametrize("grouped", [True, False])
def test_columns_that_give_way_are_named_once_with_their_place(grouped):
    rows = [("first group", "a-name"), ("first group", "another"), ("second", "a-name")]
    *lines, last = table_lines(grouped_table(rows, grouped=grouped), 14)
    assert last == "not shown for lack of room: remark; x.csv has all"
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

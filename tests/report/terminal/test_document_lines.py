"""Documents on a terminal: every line is one line, within the width, and says what it leaves out."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.document import Column, Document, Lines, Table
from uictest.report.terminal.table_lines import document_lines, table_lines, titled_lines

_ANY = st.text(st.characters(codec=None, exclude_categories=[]), max_size=30)
_GROUP = Column(heading="group", text=lambda row: row[0], wraps=True)
_NAME = Column(heading="name", text=lambda row: row[1], wraps=True)
_REMARK = Column(heading="remark\nm", text=lambda _: "of ten, m", rank=1)


def _table(rows, *, grouped=False):
    group = _GROUP if grouped else None
    return Table([_GROUP, _NAME, _REMARK], rows, "title", more="see x.csv", grouped_by=group)


@given(
    st.lists(st.tuples(_ANY, _ANY), min_size=1, max_size=5), st.booleans(), st.none() | st.integers(30, 99)
)
def test_whatever_the_texts_no_line_drives_the_terminal_or_leaves_its_width(rows, grouped, width):
    table, sentences = _table(rows, grouped=grouped), Lines([text for row in rows for text in row])
    assert all(line.isprintable() for line in document_lines(Document("", [table, sentences]), width))
    assert all(line.isprintable() for line in titled_lines([table, sentences], width))
    if width is not None:
        shown = [line for line in table_lines(table, width) if not line.startswith("not shown")]
        assert max(map(len, shown)) <= width


@pytest.mark.parametrize("grouped", [True, False])
def test_columns_that_give_way_are_named_once_with_their_place(grouped):
    rows = [("first group", "a-name"), ("first group", "another"), ("second", "a-name")]
    *lines, last = table_lines(_table(rows, grouped=grouped), 14)
    assert last == "not shown for lack of room: remark; see x.csv"
    # What rows share stands above them once.
    assert sum("second" in line for line in lines) == 1
    assert sum("first" in line for line in lines) == (1 if grouped else 2)


def test_a_table_without_rows_is_not_shown():
    assert list(document_lines(Document("", [_table([])]), None)) == []
    assert list(titled_lines([_table([])], None)) == []

"""What a table says to people and to programs, before any format."""

import pytest

from uictest.core.document import Column, Table, keyed_columns, number_text, table_of

from .made_up import COLUMNS, ROWS, TABLE


def test_people_and_programs_read_each_their_own_columns():
    shown = {column.title: texts for column, texts in TABLE.for_people}
    assert shown == {
        "case": [row.case for row in ROWS],
        "verdict": ["pass", "fail", "pass"],
        "distance\nm": ["465.3", "-", "-"],
        "vents": ["7", "0", "12"],
        "met": ["yes", "no", "yes"],
        "energy\nkJ": ["8.642e+06", "0", "1.481e+07"],
        "why": ["", "wheelset 2 stands", ""],
    }
    assert [list(record.values()) for record in TABLE.records] == [
        ["slide-80[friction=0.10]", 465.254, 0.1 + 0.2, 7, True, "", None],
        ["wet-80", None, 0.1 + 0.2, 0, False, "wheelset 2 stands", None],
        ["dry-120", None, 0.1 + 0.2, 12, True, "", None],
    ]


def test_a_table_without_rows_has_every_heading():
    assert len(Table(COLUMNS, ()).for_people) == sum(bool(column.heading) for column in COLUMNS)


@pytest.mark.parametrize(
    ("name", "all_in", "file", "more"),
    [
        ("summary", "", "summary.csv", "summary.csv"),
        ("repeats", "", "tables/repeats.csv", "tables/repeats.csv"),
        ("", "results.json", "", "results.json"),
        ("x", "x.parquet", "tables/x.csv", "x.parquet"),
    ],
)
def test_three_tables_stand_at_the_top_of_a_result_and_the_others_below(name, all_in, file, more):
    table = Table((), (), name=name, all_in=all_in)
    assert (table.file, table.more) == (file, more)


def test_columns_by_key_read_mappings_or_what_a_function_makes_of_a_row():
    table = table_of("t", [{"a": 1}, {"b": "x"}], ["c"])
    assert list(table.records) == [{"c": None, "a": 1, "b": None}, {"c": None, "a": None, "b": "x"}]
    keyed = Table(keyed_columns(["a", "b"], lambda row: {"a": row}, "of."), ["x"])
    assert list(keyed.records) == [{"of.a": "x", "of.b": None}]
    with pytest.raises(TypeError, match="column 'a' does not say what it reads"):
        Column(key="a").cell("a row that is no mapping")


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        *((1.25, 1, "1.2"), (465.2549, "significant", "465.3"), (1e-12, None, "1e-12")),
        *((None, 2, "-"), (float("nan"), "significant", "-"), (float("inf"), 0, "inf")),
    ],
)
def test_a_number_has_its_digits_and_a_missing_one_is_a_dash(value, digits, text):
    assert number_text(value, digits) == text

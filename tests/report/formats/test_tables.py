"""What a table says to people and to programs, and as CSV, HTML and a workbook."""

import csv
import errno
import io
from xml.etree import ElementTree

import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings, strategies as st

from uictest.core.document import Column, Table, keyed_columns, number_text, table_of
from uictest.report.formats.csv import ParquetRows, csv_text
from uictest.report.formats.html import html_table
from uictest.report.formats.text import table_lines
from uictest.report.formats.xlsx import LONGEST_TEXT, MOST_COLUMNS, MOST_ROWS, workbook_bytes
from uictest.report.words import csv_cell, printable

from .made_up import ANY_TEXT, COLUMNS, ROWS, TABLE, TEXTS, table_of_texts


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
    # A table without rows has every heading.
    assert len(Table(COLUMNS, ()).for_people) == sum(bool(column.heading) for column in COLUMNS)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        *((1.25, 1, "1.2"), (465.2549, "significant", "465.3"), (1e-12, None, "1e-12")),
        *((None, 2, "-"), (float("nan"), "significant", "-"), (float("inf"), 0, "inf")),
    ],
)
def test_a_number_has_its_digits_and_a_missing_one_is_a_dash(value, digits, text):
    assert number_text(value, digits) == text


def read(table):
    return list(csv.DictReader(io.StringIO(csv_text(table))))


def test_a_cell_is_exact_and_empty_where_there_is_nothing():
    assert csv_text(TABLE) == (
        "id,braking_distance_m,share,vents,met,why,never\n"
        "slide-80[friction=0.10],465.254,0.30000000000000004,7,true,,\n"
        "wet-80,,0.30000000000000004,0,false,wheelset 2 stands,\n"
        "dry-120,,0.30000000000000004,12,true,,\n"
    )


CELLS = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | ANY_TEXT


@given(st.lists(st.dictionaries(st.sampled_from(["a", "=b", "c d"]), CELLS), max_size=5))
def test_what_is_read_back_is_what_programs_see(rows):
    table = table_of("t", rows, ["a"])
    columns = {csv_cell(column.key): column.key for column in table.for_programs}
    back = read(table)
    assert len(back) == len(rows)
    for found, record in zip(back, table.records, strict=True):
        for heading, key in columns.items():
            text, value = found[heading], record[key]
            if isinstance(value, bool) or value is None:
                assert text == {True: "true", False: "false", None: ""}[value]
            else:
                assert text == csv_cell(value) if isinstance(value, str) else type(value)(text) == value


@pytest.mark.parametrize("text", TEXTS)
def test_no_text_is_a_formula_or_leaves_its_cell(text):
    (row,) = read(table_of_texts([text]))
    assert row["text"] == row["name"] == csv_cell(text)
    assert row["text"].isprintable()


@pytest.mark.parametrize("count", [0, 3, 2500])
def test_rows_of_a_parquet_file_are_counted_read_in_order_and_written_alike(tmp_path, count):
    path = tmp_path / "summary.parquet"
    rows = [
        {"id": f"=case-{k}", "index": k, "met": k > 1, "margin": None if k % 2 else 0.1 * k}
        for k in range(count)
    ]
    schema = pa.schema({"id": pa.string(), "index": pa.int64(), "met": pa.bool_(), "margin": pa.float64()})
    pq.write_table(pa.Table.from_pylist(rows, schema), path)
    table = ParquetRows(path).table("summary")
    assert (len(table.rows), table.file, table.more) == (count, "summary.csv", "summary.parquet")
    assert list(table.records) == rows
    back = read(table)
    assert [row["id"] for row in back] == [f"'=case-{k}" for k in range(count)]
    assert [row["margin"] and float(row["margin"]) for row in back] == [
        "" if row["margin"] is None else row["margin"] for row in rows
    ]


def test_a_damaged_file_has_no_rows(tmp_path):
    (tmp_path / "summary.parquet").write_bytes(b"PAR1 of a kind")
    with pytest.raises(ValueError, match="Parquet"):
        ParquetRows(tmp_path / "summary.parquet").table("summary")


def test_numbers_find_no_room_before_a_name_is_broken():
    """Numbers of rank 0, by which a run fails, are left out too: the last first."""
    names = [Column(key="id", heading="case", value=lambda row: row, literal=True, wraps=True)]
    numbers = [Column(heading=f"number-{n}", value=lambda _: 1.5, right=True) for n in range(9)]
    lines = list(table_lines(Table([*names, *numbers], ["slip[friction=0.06]"]), 60))
    assert any(line.startswith("slip[friction=0.06]  ") for line in lines)
    assert "number-8" in lines[-1]
    assert "number-0" in lines[0]


def test_a_table_has_its_headings_its_rows_and_colours():
    head, body = ElementTree.fromstring(html_table(TABLE))
    headings = [cell.text for cell in head.iter("th")]
    assert headings == ["case", "verdict", "distance, m", "vents", "met", "energy, kJ", "why"]
    rows = [[cell.text or "" for cell in row] for row in body]
    assert rows[1] == ["wet-80", "fail", "-", "0", "no", "0", "wheelset 2 stands"]
    assert len(rows) == len(ROWS)
    assert [row[1].get("style") for row in body] == ["color:#1a7f37", "color:#cf222e", "color:#1a7f37"]


@pytest.mark.parametrize("text", TEXTS)
def test_no_text_is_markup(text):
    _, body = ElementTree.fromstring(html_table(table_of_texts([text])))
    assert [cell.text or "" for row in body for cell in row] == [printable(text)] * 2 if text else True


def sheets_of(*tables, **options):
    return openpyxl.load_workbook(io.BytesIO(workbook_bytes(tables, **options)))


def test_a_sheet_has_the_names_of_the_columns_above_the_rows_and_the_same_bytes_again():
    sheet = sheets_of(TABLE)["cells"]
    assert list(sheet.values) == [
        ("id", "braking_distance_m", "share", "vents", "met", "why", "never"),
        ("slide-80[friction=0.10]", 465.254, pytest.approx(0.3, rel=1e-15), 7, True, "", None),
        ("wet-80", None, pytest.approx(0.3, rel=1e-15), 0, False, "wheelset 2 stands", None),
        ("dry-120", None, pytest.approx(0.3, rel=1e-15), 12, True, "", None),
    ]
    assert (sheet.freeze_panes, sheet.auto_filter.ref) == ("A2", "A1:G4")
    assert workbook_bytes([TABLE]) == workbook_bytes([TABLE])


def test_rows_beyond_those_of_a_sheet_are_counted_without_being_read():
    class Cases:
        def __len__(self):
            return 1000

        def __iter__(self):
            for k in range(1000):
                assert k < 300
                yield {"case": f"case-{k}", "figure": float(k)}

    columns = [Column(key="case"), Column(key="figure")]
    sheet = sheets_of(Table(columns, Cases(), name="cases", all_in="summary.parquet"), most_rows=300)["cases"]
    assert (sheet["A301"].value, sheet["B301"].value) == ("case-299", 299)
    more = "700 more rows, which a sheet cannot hold: summary.parquet has all"
    assert (sheet.max_row, sheet["A302"].value) == (302, more)
    assert sheet.auto_filter.ref == "A1:B301"
    assert 1 + MOST_ROWS + 1 == 2**20  # the names of the columns, the rows, and that line


def test_columns_beyond_those_of_a_sheet_are_counted():
    sheet = sheets_of(table_of("map", [{"0": 1.5}], map(str, range(MOST_COLUMNS + 2))))["map"]
    assert (sheet.max_column, sheet["A2"].value) == (MOST_COLUMNS, 1.5)
    assert sheet["A3"].value == "2 more columns, which a sheet cannot hold: tables/map.csv has all"


def test_every_table_has_a_sheet_of_its_own_whatever_its_name():
    long = "map-minimum_deceleration_of_the_"
    names = [f"{long}first", f"{long}second", "a/b:c", "A/B:c", "'x'"]
    book = sheets_of(*(table_of(name, [{"n": n}]) for n, name in enumerate(names)))
    assert [sheet["A2"].value for sheet in book] == [0, 1, 2, 3, 4]
    assert book.sheetnames == [long[:31], f"{long[:29]}~2", "a_b_c", "A_B_c~2", "_x_"]


@given(st.floats() | st.integers(-(2**53), 2**53))
@settings(max_examples=20)
def test_a_number_stays_one_and_what_is_not_finite_is_text_or_nothing(number):
    [_, (cell, _)] = sheets_of(table_of("t", [{"n": number, "x": "x"}]))["t"].values
    if number != number:
        assert cell is None
    else:
        assert cell == (repr(number) if abs(number) == float("inf") else pytest.approx(number, rel=1e-15))


@given(st.lists(ANY_TEXT | st.sampled_from(TEXTS), min_size=1))
@settings(max_examples=20)
def test_text_stays_text(texts):
    _, *cells = sheets_of(table_of_texts([*texts, *TEXTS]))["texts"]["B"]
    for cell, text in zip(cells, [*texts, *TEXTS], strict=True):
        shown = printable(text)
        assert (cell.value or "") == (
            shown if len(shown) <= LONGEST_TEXT else f"{shown[: LONGEST_TEXT - 1]}…"
        )
        assert cell.data_type == "s" or not cell.value
        assert not cell.hyperlink


def test_a_full_disk_is_an_error_of_the_system(monkeypatch):
    def store(workbook):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("xlsxwriter.Workbook._store_workbook", store)
    with pytest.raises(OSError, match="No space left") as caught:
        workbook_bytes([TABLE])
    assert caught.value.errno == errno.ENOSPC

"""Workbooks: the cells of the CSV files, each as what it is; what a sheet cannot hold is counted."""

import errno
import io

import openpyxl
import pytest
from hypothesis import given, settings, strategies as st

from uictest.core.document import Column, Table, table_of
from uictest.report.formats.xlsx import LONGEST_TEXT, MOST_COLUMNS, MOST_ROWS, workbook_bytes
from uictest.report.words import printable

from .made_up import ANY_TEXT, TABLE, TEXTS, table_of_texts


def read(*tables, **options):
    return openpyxl.load_workbook(io.BytesIO(workbook_bytes(tables, **options)))


def test_a_sheet_has_the_names_of_the_columns_above_the_rows():
    sheet = read(TABLE)["cells"]
    assert list(sheet.values) == [
        ("id", "braking_distance_m", "share", "vents", "met", "why", "never"),
        ("slide-80[friction=0.10]", 465.254, pytest.approx(0.3, rel=1e-15), 7, True, "", None),
        ("wet-80", None, pytest.approx(0.3, rel=1e-15), 0, False, "wheelset 2 stands", None),
        ("dry-120", None, pytest.approx(0.3, rel=1e-15), 12, True, "", None),
    ]
    assert (sheet.freeze_panes, sheet.auto_filter.ref) == ("A2", "A1:G4")


def test_the_same_tables_give_the_same_bytes():
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
    sheet = read(Table(columns, Cases(), name="cases", all_in="summary.parquet"), most_rows=300)["cases"]
    assert (sheet["A301"].value, sheet["B301"].value) == ("case-299", 299)
    more = "700 more rows, which a sheet cannot hold: summary.parquet has all"
    assert (sheet.max_row, sheet["A302"].value) == (302, more)
    assert sheet.auto_filter.ref == "A1:B301"
    assert 1 + MOST_ROWS + 1 == 2**20  # the names of the columns, the rows, and that line


def test_columns_beyond_those_of_a_sheet_are_counted():
    sheet = read(table_of("map", [{"0": 1.5}], map(str, range(MOST_COLUMNS + 2))))["map"]
    assert (sheet.max_column, sheet["A2"].value) == (MOST_COLUMNS, 1.5)
    assert sheet["A3"].value == "2 more columns, which a sheet cannot hold: tables/map.csv has all"


def test_every_table_has_a_sheet_of_its_own_whatever_its_name():
    long = "map-minimum_deceleration_of_the_"
    names = [f"{long}first", f"{long}second", "a/b:c", "A/B:c", "'x'"]
    book = read(*(table_of(name, [{"n": n}]) for n, name in enumerate(names)))
    assert [sheet["A2"].value for sheet in book] == [0, 1, 2, 3, 4]
    assert book.sheetnames == [long[:31], f"{long[:29]}~2", "a_b_c", "A_B_c~2", "_x_"]


@given(st.floats() | st.integers(-(2**53), 2**53))
@settings(max_examples=20)
def test_a_number_stays_one_and_what_is_not_finite_is_text_or_nothing(number):
    [_, (cell, _)] = read(table_of("t", [{"n": number, "x": "x"}]))["t"].values
    if number != number:
        assert cell is None
    else:
        assert cell == (repr(number) if abs(number) == float("inf") else pytest.approx(number, rel=1e-15))


@given(st.lists(ANY_TEXT | st.sampled_from(TEXTS), min_size=1))
@settings(max_examples=20)
def test_text_stays_text(texts):
    _, *cells = read(table_of_texts([*texts, *TEXTS]))["texts"]["B"]
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

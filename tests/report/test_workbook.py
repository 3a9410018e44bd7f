import errno
import io

import openpyxl
import pytest
from hypothesis import given, settings, strategies as st

from uictest.core.document import Data
from uictest.report import CaseDescription, csv_text, write_formats
from uictest.report.escaping import printable
from uictest.report.workbook import LONGEST_TEXT, MOST_ROWS, Rows, workbook_bytes

from .builders import HOSTILE, make_content, make_result, make_verdict
from .workbooks import assert_as_csv, assert_same


def read(tables, **options):
    return openpyxl.load_workbook(io.BytesIO(workbook_bytes(tables, **options)))


def test_a_sheet_has_the_names_of_the_columns_above_the_rows():
    sheet = read({"cases": Data(["id", "met"], [{"id": "a", "met": True}, {"id": "b"}])})["cases"]
    assert list(sheet.values) == [("id", "met"), ("a", True), ("b", None)]
    assert (sheet.freeze_panes, sheet.auto_filter.ref) == ("A2", "A1:B3")


def test_the_same_tables_give_the_same_bytes():
    tables = {"cases": Data(["id"], [{"id": "a"}])}
    assert workbook_bytes(tables) == workbook_bytes(tables)


def test_rows_beyond_those_of_a_sheet_are_counted_without_being_read():
    rows = ({"case": f"case-{k}", "figure": float(k)} for k in range(1000))
    table = Rows(["case", "figure"], rows, 1000, "summary.parquet")
    sheet = read({"cases": table}, most_rows=300)["cases"]
    assert (sheet["A301"].value, sheet["B301"].value) == ("case-299", 299)
    more = "700 more rows, which a sheet cannot hold: summary.parquet has all"
    assert (sheet.max_row, sheet["A302"].value) == (302, more)
    assert sheet.auto_filter.ref == "A1:B301"
    assert next(rows)["case"] == "case-300"


def test_a_sheet_of_the_format_has_room_for_the_names_the_rows_and_the_last_line():
    assert 1 + MOST_ROWS + 1 == 2**20


def test_columns_beyond_those_of_a_sheet_are_counted():
    sheet = read({"map": Data(list(map(str, range(16_386))), [{"0": 1.5}])})["map"]
    assert (sheet.max_column, sheet["A2"].value) == (16_384, 1.5)
    assert sheet["A3"].value == "2 more columns, which a sheet cannot hold: map.csv has all"


def test_every_table_has_a_sheet_of_its_own_whatever_its_name():
    long = "map-minimum_deceleration_of_the_"
    names = [f"{long}first", f"{long}second", "a/b:c", "A/B:c", "'x'"]
    book = read({name: Data(["n"], [{"n": n}]) for n, name in enumerate(names)})
    assert [sheet["A2"].value for sheet in book] == [0, 1, 2, 3, 4]
    assert book.sheetnames == [long[:31], f"{long[:29]}~2", "a_b_c", "A_B_c~2", "_x_"]


@given(number=st.floats() | st.integers(-(2**53), 2**53))
@settings(max_examples=20)
def test_a_number_is_that_of_the_csv_file(number):
    rows = [{"n": number}]
    text = csv_text(["n"], rows).split()[1:] or [""]
    [_, (cell, _)] = read({"t": Data(["n", "x"], [{"n": number, "x": "x"}])})["t"].values
    assert_same(text[0], cell)


_ACTIVE = st.sampled_from(["=1+1", "+1", "-1", "@SUM(A1)", "http://example.org", "mailto:a@b", "12", "{=A1}"])


@given(st.lists(st.text(st.characters(codec=None, exclude_categories=[])) | _ACTIVE, min_size=1))
@settings(max_examples=20)
def test_text_stays_text(texts):
    rows = [{"text": text} for text in [*texts, "x" * 40_000]]
    _, *cells = read({"cases": Data(["text"], rows)})["cases"]["A"]
    assert [cell.value or "" for cell in cells[:-1]] == list(map(printable, texts))
    assert all(cell.data_type == "s" for cell in cells if cell.value)
    assert not any(cell.hyperlink for cell in cells)
    assert cells[-1].value == f"{'x' * (LONGEST_TEXT - 1)}…"


def test_a_full_disk_is_an_error_of_the_system(monkeypatch):
    def store(workbook):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("xlsxwriter.Workbook._store_workbook", store)
    with pytest.raises(OSError, match="No space left") as caught:
        workbook_bytes({"cases": Data(["case"], [])})
    assert caught.value.errno == errno.ENOSPC


@pytest.mark.parametrize("text", ["slip", f"=1+1{HOSTILE}", "http://example.org"])
def test_the_workbook_of_a_run_holds_what_its_csv_files_hold(text, tmp_path):
    verdict = make_verdict(id=text, reason=text, definition={text: text}, requirements=("BR-1",))
    infinite = make_verdict(value=float("inf"), margin=None)
    result = make_result(
        id=text, parameters={text: text}, criteria=(verdict, infinite), reason=text, scenario=text
    )
    crashed = make_result(id="crashed", outcome="error", measures=None, wheelsets=(), criteria=())
    subjects = {text: CaseDescription(text, (text,))}
    write_formats(tmp_path, make_content(result, crashed, name=text, subjects=subjects), ["csv", "xlsx"])
    assert_as_csv(tmp_path, tmp_path / "report.xlsx")
    book = openpyxl.load_workbook(tmp_path / "report.xlsx")
    for cell in (cell for sheet in book for row in sheet for cell in row):
        assert cell.data_type in "sbn"
        assert cell.hyperlink is None

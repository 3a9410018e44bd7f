from __future__ import annotations

import errno
import io

import pytest

from uictest.report.sheet import open_workbook, styles_of, write_table

openpyxl = pytest.importorskip("openpyxl")


@pytest.mark.parametrize("streaming", [True, False])
def test_rows_beyond_the_most_are_not_written(streaming: bool) -> None:
    buffer = io.BytesIO()
    with open_workbook(buffer, streaming=streaming) as workbook:
        sheet = workbook.add_worksheet("Cases")
        rows = ({"case": f"case-{k}", "figure": float(k)} for k in range(1000))
        assert write_table(sheet, ["case", "figure"], rows, styles_of(workbook), most=300) == 300
    sheet = openpyxl.load_workbook(buffer)["Cases"]
    assert (sheet.max_row, sheet["A301"].value, sheet["B301"].value) == (301, "case-299", 299)
    assert sheet.auto_filter.ref == "A1:B301"


def test_header_and_first_column_stand_on_every_printed_page() -> None:
    buffer = io.BytesIO()
    with open_workbook(buffer) as workbook:
        write_table(workbook.add_worksheet("Cases"), ["case"], [{"case": "dry"}], styles_of(workbook))
    sheet = openpyxl.load_workbook(buffer)["Cases"]
    assert (sheet.print_title_rows, sheet.print_title_cols) == ("$1:$1", "$A:$A")
    assert sheet.page_setup.orientation == "landscape"
    assert sheet.freeze_panes == "B2"


@pytest.mark.parametrize("streaming", [True, False])
def test_a_full_disk_is_an_error_of_the_system(streaming: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    def store(workbook: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("xlsxwriter.Workbook._store_workbook", store)
    with (
        pytest.raises(OSError, match="No space left") as caught,
        open_workbook(io.BytesIO(), streaming=streaming) as workbook,
    ):
        workbook.add_worksheet("Cases").write_string(0, 0, "case")
    assert caught.value.errno == errno.ENOSPC

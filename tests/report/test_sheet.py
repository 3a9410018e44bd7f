import errno
import io

import pytest
from hypothesis import given, settings, strategies as st

from uictest.report.escaping import printable
from uictest.report.sheet import LONGEST_TEXT, open_workbook, styles_of, write_table

openpyxl = pytest.importorskip("openpyxl")


@pytest.mark.parametrize("streaming", [True, False])
def test_rows_beyond_the_most_are_not_written(streaming):
    buffer = io.BytesIO()
    with open_workbook(buffer, streaming=streaming) as workbook:
        sheet = workbook.add_worksheet("Cases")
        rows = ({"case": f"case-{k}", "figure": float(k)} for k in range(1000))
        assert write_table(sheet, ["case", "figure"], rows, styles_of(workbook), most=300) == 300
    sheet = openpyxl.load_workbook(buffer)["Cases"]
    assert (sheet.max_row, sheet["A301"].value, sheet["B301"].value) == (301, "case-299", 299)
    assert sheet.auto_filter.ref == "A1:B301"


_ACTIVE = st.sampled_from(["=1+1", "+1", "-1", "@SUM(A1)", "http://example.org", "mailto:a@b", "12", "{=A1}"])


@given(st.lists(st.text(st.characters(codec=None, exclude_categories=[])) | _ACTIVE, min_size=1))
@settings(max_examples=20)
def test_text_stays_text(texts):
    buffer = io.BytesIO()
    with open_workbook(buffer, streaming=True) as workbook:
        rows = [{"text": text} for text in [*texts, "x" * 40_000]]
        write_table(workbook.add_worksheet("Cases"), ["text"], rows, styles_of(workbook))
    (_, *cells) = openpyxl.load_workbook(buffer)["Cases"]["A"]
    assert [cell.value or "" for cell in cells[:-1]] == list(map(printable, texts))
    assert all(cell.data_type == "s" for cell in cells if cell.value)
    assert not any(cell.hyperlink for cell in cells)
    assert cells[-1].value == f"{'x' * (LONGEST_TEXT - 1)}…"


def test_header_and_first_column_stand_on_every_printed_page():
    buffer = io.BytesIO()
    with open_workbook(buffer) as workbook:
        write_table(workbook.add_worksheet("Cases"), ["case"], [{"case": "dry"}], styles_of(workbook))
    sheet = openpyxl.load_workbook(buffer)["Cases"]
    assert (sheet.print_title_rows, sheet.print_title_cols) == ("$1:$1", "$A:$A")
    assert sheet.page_setup.orientation == "landscape"
    assert sheet.freeze_panes == "B2"


@pytest.mark.parametrize("streaming", [True, False])
def test_a_full_disk_is_an_error_of_the_system(streaming, monkeypatch):
    def store(workbook):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("xlsxwriter.Workbook._store_workbook", store)
    with (
        pytest.raises(OSError, match="No space left") as caught,
        open_workbook(io.BytesIO(), streaming=streaming) as workbook,
    ):
        workbook.add_worksheet("Cases").write_string(0, 0, "case")
    assert caught.value.errno == errno.ENOSPC

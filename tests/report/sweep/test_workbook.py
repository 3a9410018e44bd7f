import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from uictest.analysis.summaries.worst import summary_files
from uictest.report import write_sweep_formats, write_sweep_result
from uictest.report.sweep.cases import SummaryRows

from ..builders import HOSTILE
from ..workbooks import assert_as_csv


def cases(text):
    own = {"parameters.rail.friction": "0.1", "reason": text, "braking_distance_m": 465.25}
    rows = ({"id": f"case-{k}", "index": k, "met": k > 1, "outcome": "pass"} for k in range(3))
    return pa.Table.from_pylist([{**row, **own} for row in rows])


@pytest.mark.parametrize("text", ["slip", f"=1+1{HOSTILE}"])
def test_the_workbook_of_a_sweep_holds_what_its_csv_files_hold(make_sweep, text, tmp_path):
    content = make_sweep((), text)
    with summary_files(content.folder) as write:
        write(cases(text))
    write_sweep_result(content.folder, content.result, "study.sweep.yaml")
    write_sweep_formats(tmp_path, content, ["xlsx"])
    assert {"summary.csv", "rates.csv", "trends.csv"} <= {path.name for path in content.folder.iterdir()}
    assert_as_csv(content.folder, tmp_path / "report.xlsx")


def test_the_rows_of_a_summary_are_counted_and_read_in_its_order(make_sweep):
    content = make_sweep()
    with summary_files(content.folder) as write:
        write(cases("x"))
    table = SummaryRows(content.folder).table()
    assert (table.size, table.file) == (3, "summary.parquet")
    assert [row["id"] for row in table.rows] == ["case-0", "case-1", "case-2"]


def test_a_damaged_summary_is_no_summary_and_nothing_stays_behind(make_sweep, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    content = make_sweep()
    (content.folder / "summary.parquet").write_bytes(b"PAR1 of a kind")
    with pytest.raises(ValueError, match="Parquet"):
        write_sweep_formats(content.folder, content, ["xlsx"])
    assert [path.name for path in tmp_path.iterdir()] == ["sweep"]
    assert [path.name for path in content.folder.iterdir()] == ["summary.parquet"]


def test_a_sweep_without_cases_has_a_workbook(make_sweep, tmp_path):
    content = make_sweep()
    pq.write_table(cases("x").slice(0, 0), content.folder / "summary.parquet")
    [workbook] = write_sweep_formats(tmp_path, content, ["xlsx"])
    assert workbook.is_file()

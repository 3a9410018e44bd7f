import io

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from uictest.report.escaping import printable
from uictest.report.sweep.workbook import sweep_workbook_bytes

from ..builders import HOSTILE, make_result

openpyxl = pytest.importorskip("openpyxl")

SHEETS = ["Summary", "Cases", "Maps", "Rates", "Trends"]
SHEETS += ["Frontier", "Sensitivity", "Worst cases", "Provenance"]


def _rows(count, **changes):
    own = {"parameters.rail.friction": "0.1", "reason": "", "braking_distance_m": None}
    cases = ({"index": k, "id": f"case-{k}", "met": k % 3 > 0} for k in range(count))
    return [{**case, "outcome": "pass" if case["met"] else "fail", **own, **changes} for case in cases]


def _read(content, rows, **options):
    pq.write_table(pa.Table.from_pylist(rows), content.folder / "summary.parquet")
    return openpyxl.load_workbook(io.BytesIO(sweep_workbook_bytes(content, **options)))


def _table(sheet):
    header, *rows = ([cell.value for cell in row] for row in sheet.iter_rows())
    rows = rows[1:] if sheet.freeze_panes == "B3" else rows
    return [dict(zip(header, row, strict=True)) for row in rows]


def test_the_sheets_hold_what_the_sweep_found(make_sweep):
    content = make_sweep((make_result(),))
    workbook = _read(content, _rows(4, braking_distance_m=465.25))
    assert workbook.sheetnames == SHEETS
    summary = {row["what"]: row["value"] for row in _table(workbook["Summary"])}
    assert (summary["cases"], summary["met"], summary["outcome fail"]) == (4, 3, 1)
    case = _table(workbook["Cases"])[0]
    assert next(iter(case)) == "id"
    assert (case["id"], case["met"], case["braking distance"]) == ("case-0", "fail", 465.25)
    assert _table(workbook["Rates"])[1]["share met"] == 0.5
    trend = _table(workbook["Trends"])
    assert [(row["value"], row["cases"], row["mean"]) for row in trend] == [("80 %", 2, 2), ("90 %", 1, 4)]
    (flip,) = _table(workbook["Frontier"])
    assert (flip["from"], flip["to"], flip["met_at_from"], flip["flips"]) == ("90 %", "0.11", False, 1)
    (index,) = _table(workbook["Sensitivity"])
    assert (index["first"], index["first_low"], index["total_high"]) == (0.5, 0.4, 0.6)
    worst = _table(workbook["Worst cases"])
    assert [row["case"] for row in worst] == ["lost[90 %]", "dry-120[command=90]"]
    assert [row["braking distance"] for row in worst] == [None, 465.25]
    assert {"what": "versions: uictest", "value": "0.1.0"} in _table(workbook["Provenance"])


def test_each_map_has_a_colour_scale_of_its_own(make_sweep):
    sheet = _read(make_sweep(), _rows(4))["Maps"]
    assert sheet["A1"].value == "share of cases met: brake.90 % down, rail.friction across"
    assert [cell.value for cell in sheet[4]] == ["90 %", 0, 1]
    assert [cell.value for cell in sheet[9]] == ["90 %", None, 3.5]
    scales = {str(each.sqref): each.rules[0].type for each in sheet.conditional_formatting}
    assert scales == {"B3:C4": "colorScale", "B8:C9": "colorScale"}


def test_what_a_sweep_does_not_have_has_no_sheet(make_sweep):
    content = make_sweep(maps=[], missed=[], sensitivities=[], frontier=None, distributions=[], trends=[])
    assert _read(content, _rows(1)).sheetnames == ["Summary", "Cases", "Rates", "Provenance"]


def test_cases_without_room_are_counted_and_those_not_met_are_kept(make_sweep):
    content = make_sweep(cases=12)
    workbook = _read(content, _rows(12), most_cases=5)
    *cases, note = _table(workbook["Cases"])
    assert [case["id"] for case in cases] == ["case-0", "case-3", "case-6", "case-9", "case-1"]
    assert note["id"] == "7 of 12 cases are in summary.csv only; those not met stand first here"
    assert note["id"] in [row["value"] for row in _table(workbook["Summary"])]


def test_text_stays_text_on_every_sheet_and_in_the_charts(make_sweep):
    text = f"=1+1{HOSTILE}"
    shown = printable(text)
    result = make_result(id=text, parameters={text: text}, outcome="fail", reason=text, scenario=text)
    content = make_sweep((result,), text)
    workbook = _read(content, _rows(1, **{text: text, "reason": text}))
    assert workbook.sheetnames == SHEETS
    for cell in (cell for sheet in workbook for row in sheet.iter_rows() for cell in row):
        assert cell.data_type in "sbn"
        assert str(cell.value).isprintable()
    assert _table(workbook["Cases"])[0][shown] == shown
    assert _table(workbook["Worst cases"])[0][shown] == shown
    assert _table(workbook["Frontier"])[0]["note"] == shown


def test_a_damaged_summary_is_no_summary_and_nothing_stays_behind(make_sweep, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    content = make_sweep()
    (content.folder / "summary.parquet").write_bytes(b"PAR1 of a kind")
    with pytest.raises(ValueError, match="Parquet"):
        sweep_workbook_bytes(content)
    assert [path.name for path in tmp_path.iterdir()] == ["sweep"]


def test_the_summary_draws_the_first_trend_in_the_same_bytes_each_time(make_sweep):
    content = make_sweep()
    workbook = _read(content, _rows(4))
    assert sweep_workbook_bytes(content) == sweep_workbook_bytes(content)
    (trend,) = workbook["Summary"]._charts
    means = _cells(workbook, trend.series[0].val.numRef.f)
    assert means == list(content.result.trends[0].mean)


def _cells(workbook, reference):
    """Return the values of cells below each other, e.g. `Trends!$G$2:$G$4`."""
    sheet, _, cells = reference.partition("!")
    return [cell.value for (cell,) in workbook[sheet.strip("'")][cells.replace("$", "")]]

import io

import pytest

from uictest.report import CaseDescription
from uictest.report.escaping import printable
from uictest.report.formats.xlsx import workbook_bytes

from ..builders import HOSTILE, make_content, make_result, make_verdict

openpyxl = pytest.importorskip("openpyxl")


def _read(content):
    return openpyxl.load_workbook(io.BytesIO(workbook_bytes(content)))


def _table(sheet):
    """Return the rows below the headings, and below the units, which freeze with them."""
    header, *rows = ([cell.value for cell in row] for row in sheet.iter_rows())
    rows = rows[1:] if sheet.freeze_panes == "B3" else rows
    return [dict(zip(header, row, strict=True)) for row in rows]


def test_the_sheets_hold_what_the_run_found():
    subject = CaseDescription("A dry stop", ("dry", "stop"))
    infinite = make_verdict(value=float("inf"), margin=None)
    crashed = make_result(id="crashed", outcome="error", measures=None, wheelsets=(), criteria=())
    stop = make_result(criteria=(make_verdict(), infinite))
    workbook = _read(make_content(stop, crashed, subjects={stop.id: subject}))
    assert workbook.sheetnames == ["Cover", "Cases", "Wheelsets", "Criteria", "Provenance"]
    case, without_figures = _table(workbook["Cases"])
    assert without_figures["braking distance"] is None
    assert (case["case"], case["title"], case["tags"]) == ("dry-120[command=90]", "A dry stop", "dry stop")
    assert (case["verdict"], case["braking distance"], case["brake.command"]) == ("pass", 465.25, "90 %")
    assert case["initial adhesion"] is None
    assert [row["wheelset"] for row in _table(workbook["Wheelsets"])] == [1, 2, 3, 4]
    criterion, of_infinity = _table(workbook["Criteria"])
    assert of_infinity["value"] is None
    assert (criterion["lower"], criterion["upper"], criterion["verdict"]) == (440.0, 490.0, "pass")
    assert {"what": "versions: uictest", "value": "0.1.0"} in _table(workbook["Provenance"])


@pytest.mark.parametrize("text", [f"=1+1{HOSTILE}", "http://example.org"])
def test_text_stays_text_on_every_sheet(text):
    verdict = make_verdict(id=text, reason=text, definition={text: text})
    result = make_result(id=text, parameters={text: text}, criteria=(verdict,), reason=text, scenario=text)
    workbook = _read(make_content(result, name=text, subjects={text: CaseDescription(text, (text,))}))
    shown = printable(text)
    for cell in (cell for sheet in workbook for row in sheet.iter_rows() for cell in row):
        assert cell.data_type in "sbn"
        assert cell.hyperlink is None
    (case,) = _table(workbook["Cases"])
    assert (case["case"], case["title"], case[shown]) == (shown, shown, shown)
    for sheet in workbook:
        assert (sheet.page_setup.orientation, sheet.page_setup.paperSize) == ("landscape", 9)
        assert sheet.oddFooter.right.text == "&P / &N"


def test_requirements_are_a_matrix_over_the_cases():
    own = make_verdict(id="own", layer="requirement", status="fail", requirements=("BR-2",))
    results = [
        make_result(id="a", requirements=("BR-1",)),
        make_result(id="b", requirements=("BR-1",), outcome="fail", criteria=(own,)),
        make_result(id="c"),
    ]
    workbook = _read(make_content(*results))
    assert "Requirements" in workbook.sheetnames
    assert _table(workbook["Requirements"]) == [
        {"requirement id": "BR-1", "overall status": "not met", "tested in": 2, "not met in": 1}
        | {"a": "pass", "b": "fail"},
        {"requirement id": "BR-2", "overall status": "not met", "tested in": 1, "not met in": 1}
        | {"a": None, "b": "fail"},
    ]
    coloured = {str(each.sqref) for each in workbook["Requirements"].conditional_formatting}
    assert coloured == {"B2:B3", "E2:F3"}


def test_measures_have_units_and_the_digits_that_are_compared():
    sheet = _read(make_content(make_result()))["Cases"]
    heading, unit, values = sheet.iter_rows(max_row=3)
    shown = {
        name.value: (below.value, cell.number_format)
        for name, below, cell in zip(heading, unit, values, strict=True)
    }
    assert shown["braking distance"] == ("m", "0.0")
    assert shown["mean deceleration"] == ("m/s2", "0.000")
    assert shown["air residual"] == ("", "0.0E+00")
    assert shown["adhesion utilisation"][0] == "%"
    assert shown["case"] == ("", "General")
    assert (sheet.freeze_panes, sheet.auto_filter.ref.partition(":")[0]) == ("B3", "A2")
    assert sheet.print_title_rows == "$1:$2"


def test_the_cover_names_what_is_not_as_expected_and_draws_every_case():
    failed = make_verdict(status="fail", reason="too long", margin=-98.0)
    results = [make_result(id="a"), make_result(id="b", outcome="fail", criteria=(failed,))]
    workbook = _read(make_content(*results))
    cover = [[cell.value for cell in row] for row in workbook["Cover"].iter_rows()]
    (missed,) = [row for row in cover if row[0] == "b"]
    assert missed[1] == "fail"
    assert "too long" in missed[2]
    assert ["pass", 1, None] in cover
    named = [row[0] for row in cover]
    assert set(workbook.sheetnames[1:]) <= set(named)
    references = [each.series[0].val.numRef.f for each in workbook["Cover"]._charts]
    cases = workbook["Cases"]
    columns = {cell.value: cell.column_letter for cell in cases[1]}
    assert references == [
        f"Cases!${columns[name]}$3:${columns[name]}$4" for name in ("braking distance", "narrowest margin")
    ]


def test_charts_hold_what_they_draw_for_programs_that_compute_nothing():
    """The sheets are streamed, so that the library cannot read back what it wrote."""
    charts = _read(make_content(make_result(id="a"), make_result(id="b", measures={})))["Cover"]._charts
    for chart in charts:
        [series] = chart.series
        assert [each.v for each in series.cat.strRef.strCache.pt] == ["a", "b"]
        assert series.val.numRef.numCache.ptCount == 2
    distances = charts[0].series[0].val.numRef.numCache.pt
    assert [float(each.v) for each in distances if each.v] == [465.25]


def test_a_cover_names_so_many_cases_and_counts_the_rest():
    failed = [make_result(id=f"case-{k}", outcome="fail", criteria=()) for k in range(25)]
    cover = [row[0].value for row in _read(make_content(*failed))["Cover"].iter_rows()]
    assert "case-19" in cover
    assert "case-20" not in cover
    assert "and 5 cases more on the sheet Cases" in cover

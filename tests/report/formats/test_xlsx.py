from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from uictest.evaluation import CaseResult, Verdict
from uictest.report import CaseDescription, RunContent
from uictest.report.formats.xlsx import workbook_bytes
from uictest.report.sheet import LONGEST_TEXT

openpyxl = pytest.importorskip("openpyxl")

MakeResult = Callable[..., CaseResult]
MakeVerdict = Callable[..., Verdict]
MakeContent = Callable[..., RunContent]


def _read(content: RunContent) -> Any:
    return openpyxl.load_workbook(io.BytesIO(workbook_bytes(content)))


def _table(sheet: Any) -> list[dict[str, Any]]:
    header, *rows = ([cell.value for cell in row] for row in sheet.iter_rows())
    return [dict(zip(header, row, strict=True)) for row in rows]


def test_the_sheets_hold_what_the_run_found(make_content: MakeContent, make_result: MakeResult) -> None:
    subject = CaseDescription("A dry stop", ("dry", "stop"))
    workbook = _read(make_content(make_result(), subjects={"dry-120[command=90]": subject}))
    assert workbook.sheetnames == ["Cases", "Wheelsets", "Criteria", "Provenance"]
    (case,) = _table(workbook["Cases"])
    assert (case["case"], case["title"], case["tags"]) == ("dry-120[command=90]", "A dry stop", "dry stop")
    assert (case["verdict"], case["braking_distance_m"], case["brake.command"]) == ("pass", 465.25, "90 %")
    assert case["initial_adhesion_g"] is None
    assert [row["wheelset"] for row in _table(workbook["Wheelsets"])] == [1, 2, 3, 4]
    (criterion,) = _table(workbook["Criteria"])
    assert (criterion["lower"], criterion["upper"], criterion["verdict"]) == (440.0, 490.0, "pass")
    assert {"what": "versions: uictest", "value": "0.1.0"} in _table(workbook["Provenance"])


@pytest.mark.parametrize(
    "text", ["=1+1", "+1", "-1", "@SUM(A1)", "http://example.org", "mailto:a@b", "12", "{=A1}"]
)
def test_text_stays_text(
    make_content: MakeContent, make_result: MakeResult, make_verdict: MakeVerdict, text: str
) -> None:
    verdict = make_verdict(id=text, reason=text, definition={text: text})
    result = make_result(id=text, parameters={text: text}, criteria=(verdict,), reason=text, scenario=text)
    content = make_content(result, name=text, subjects={text: CaseDescription(text, (text,))})
    for cell in _cells(_read(content)):
        if isinstance(cell.value, str):
            assert cell.data_type == "s"
            assert cell.hyperlink is None
    (case,) = _table(_read(content)["Cases"])
    assert (case["case"], case["title"], case[text]) == (text, text, text)


def test_hostile_and_endless_texts_leave_a_workbook_that_opens(
    make_content: MakeContent, make_result: MakeResult, hostile: str
) -> None:
    workbook = _read(
        make_content(make_result(id=hostile, reason="x" * 40_000, parameters={hostile: hostile}))
    )
    (case,) = _table(workbook["Cases"])
    assert "<b>&" in case["case"]
    assert "\x1b" not in case["case"]
    assert "\u202e" not in case["case"]
    assert len(case["reason"]) == LONGEST_TEXT


def test_no_number_is_an_empty_cell_and_a_failed_case_a_row(
    make_content: MakeContent, make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    infinite = make_verdict(value=float("inf"), margin=None)
    failed = make_result(id="crashed", outcome="error", measures=None, wheelsets=(), criteria=())
    workbook = _read(make_content(make_result(criteria=(infinite,)), failed))
    assert _table(workbook["Criteria"])[0]["value"] is None
    assert _table(workbook["Cases"])[1]["braking_distance_m"] is None


def _cells(workbook: Any) -> Sequence[Any]:
    return [cell for sheet in workbook for row in sheet.iter_rows() for cell in row]


def test_requirements_are_a_matrix_over_the_cases(
    make_content: MakeContent, make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
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

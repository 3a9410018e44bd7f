from __future__ import annotations

import csv
import io
from collections.abc import Callable

from uictest.core.document import Data
from uictest.judging.evaluation import CaseResult, Verdict
from uictest.report import RunContent, csv_text
from uictest.report.formats.csv import (
    FORMAT,
    criteria_table,
    requirements_table,
    summary_table,
    wheelsets_table,
)

MakeResult = Callable[..., CaseResult]
MakeVerdict = Callable[..., Verdict]


def _rows(table: Data) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(csv_text(*table))))


def test_the_summary_holds_parameters_as_written_and_figures_exactly(make_result: MakeResult) -> None:
    (row,) = _rows(summary_table([make_result()]))
    assert row["id"] == "dry-120[command=90]"
    assert row["parameters.brake.command"] == "90 %"
    assert float(row["energy_residual"]) == 1e-8
    assert (row["expect"], row["outcome"], row["met"]) == ("pass", "pass", "true")


def test_a_figure_that_was_never_reached_is_an_empty_cell(make_result: MakeResult) -> None:
    assert _rows(summary_table([make_result()]))[0]["initial_adhesion_g"] == ""


def test_a_case_that_crashed_is_a_row_without_figures(make_result: MakeResult) -> None:
    crashed = make_result(outcome="error", reason="ValueError: x", measures=None, wheelsets=(), criteria=())
    (row,) = _rows(summary_table([crashed]))
    assert (row["outcome"], row["met"], row["braking_distance_m"]) == ("error", "false", "")
    assert _rows(wheelsets_table([crashed])) == []
    assert _rows(criteria_table([crashed])) == []


def test_cases_with_different_parameters_share_one_header(make_result: MakeResult) -> None:
    results = [make_result(parameters={"a.b": "1"}), make_result(parameters={"c": "2"})]
    assert [(row["parameters.a.b"], row["parameters.c"]) for row in _rows(summary_table(results))] == [
        ("1", ""),
        ("", "2"),
    ]


def test_a_parameter_called_like_a_column_does_not_hide_it(make_result: MakeResult) -> None:
    (row,) = _rows(summary_table([make_result(parameters={"expect": "fail"}, expect="fail")]))
    assert row["parameters.expect"] == row["expect"] == "fail"


def test_wheelsets_are_numbered_from_the_leading_end(make_result: MakeResult) -> None:
    rows = _rows(wheelsets_table([make_result()]))
    assert [(row["wheelset"], row["valve_actuations"]) for row in rows] == [
        ("1", "1"),
        ("2", "2"),
        ("3", "3"),
        ("4", "4"),
    ]


def test_every_criterion_is_a_row_with_its_definition(
    make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    criteria = (make_verdict(), make_verdict(id="slide", value=None, margin=None, status="not_applicable"))
    distance, slide = _rows(criteria_table([make_result(criteria=criteria)]))
    assert (distance["criterion"], distance["value"], distance["margin"]) == (
        "braking-distance",
        "465.25",
        "24.75",
    )
    assert distance["definition"] == "low_speed_cutoff = 30 km/h"
    assert (slide["verdict"], slide["value"]) == ("not_applicable", "")


def test_hostile_text_stays_in_its_cell_and_is_no_formula(make_result: MakeResult, hostile: str) -> None:
    (row,) = _rows(summary_table([make_result(id="=1+1", parameters={"x": hostile}, reason=f"={hostile}")]))
    assert row["id"] == "'=1+1"
    assert row["reason"].startswith("'=")
    assert all(cell.isprintable() for cell in row.values())


def test_requirements_have_a_column_and_a_table_of_their_own(
    make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    verdict = make_verdict(requirements=("BR-2", "BR-1"))
    named = make_result(id="a", test_case="TC-1", requirements=("BR-10", "BR-9"), criteria=(verdict,))
    (row,) = _rows(summary_table([named]))
    assert (row["test_case"], row["requirements"]) == ("TC-1", "BR-10; BR-9")
    assert [row["requirements"] for row in _rows(criteria_table([named]))] == ["BR-2; BR-1"]
    rows = _rows(requirements_table([named]))
    assert [
        (row["requirement"], row["status"], row["id"], row["verdict"], row["criteria"]) for row in rows
    ] == [
        ("BR-1", "met", "a", "pass", "braking-distance"),
        ("BR-2", "met", "a", "pass", "braking-distance"),
        ("BR-9", "met", "a", "pass", ""),
        ("BR-10", "met", "a", "pass", ""),
    ]


def test_without_requirements_there_is_no_table_of_them(
    make_result: MakeResult, make_content: Callable[..., RunContent]
) -> None:
    assert set(FORMAT.files(make_content(make_result()))) == {"summary.csv", "wheelsets.csv", "criteria.csv"}

import csv
import io

from uictest.report import csv_text
from uictest.report.formats.csv import (
    FORMAT,
    criteria_table,
    requirements_table,
    summary_table,
    wheelsets_table,
)

from ..builders import make_content, make_result, make_verdict


def _rows(table):
    return list(csv.DictReader(io.StringIO(csv_text(*table))))


def test_the_summary_holds_parameters_as_written_and_figures_exactly():
    (row,) = _rows(summary_table([make_result(parameters={"brake.command": "90 %", "expect": "fail"})]))
    assert row["id"] == "dry-120[command=90]"
    assert row["parameters.brake.command"] == "90 %"
    assert float(row["energy_residual"]) == 1e-8
    assert row["initial_adhesion_g"] == ""
    # A parameter that is called like a column does not hide it.
    assert (row["parameters.expect"], row["expect"]) == ("fail", "pass")
    assert (row["outcome"], row["met"]) == ("pass", "true")


def test_a_case_that_crashed_is_a_row_without_figures():
    crashed = make_result(outcome="error", reason="ValueError: x", measures=None, wheelsets=(), criteria=())
    (row,) = _rows(summary_table([crashed]))
    assert (row["outcome"], row["met"], row["braking_distance_m"]) == ("error", "false", "")
    assert _rows(wheelsets_table([crashed])) == []
    assert _rows(criteria_table([crashed])) == []


def test_cases_with_different_parameters_share_one_header():
    results = [make_result(parameters={"a.b": "1"}), make_result(parameters={"c": "2"})]
    rows = _rows(summary_table(results))
    assert [(row["parameters.a.b"], row["parameters.c"]) for row in rows] == [("1", ""), ("", "2")]


def test_wheelsets_are_numbered_from_the_leading_end():
    rows = _rows(wheelsets_table([make_result()]))
    assert [(row["wheelset"], row["valve_actuations"]) for row in rows] == [(n, n) for n in "1234"]


def test_every_criterion_is_a_row_with_its_definition():
    criteria = (make_verdict(), make_verdict(id="slide", value=None, margin=None, status="not_applicable"))
    distance, slide = _rows(criteria_table([make_result(criteria=criteria)]))
    told = [distance[name] for name in ("criterion", "value", "margin", "definition")]
    assert told == ["braking-distance", "465.25", "24.75", "low_speed_cutoff = 30 km/h"]
    assert (slide["verdict"], slide["value"]) == ("not_applicable", "")


def test_requirements_have_a_column_and_a_table_of_their_own():
    verdict = make_verdict(requirements=("BR-2", "BR-1"))
    named = make_result(id="a", test_case="TC-1", requirements=("BR-10", "BR-9"), criteria=(verdict,))
    (row,) = _rows(summary_table([named]))
    assert (row["test_case"], row["requirements"]) == ("TC-1", "BR-10; BR-9")
    assert [row["requirements"] for row in _rows(criteria_table([named]))] == ["BR-2; BR-1"]
    rows = _rows(requirements_table([named]))
    criteria = {"BR-1": "braking-distance", "BR-2": "braking-distance", "BR-9": "", "BR-10": ""}
    assert {row["requirement"]: row["criteria"] for row in rows} == criteria
    assert {(row["status"], row["id"], row["verdict"]) for row in rows} == {("met", "a", "pass")}
    assert [row["requirement"] for row in rows] == list(criteria)
    assert set(FORMAT.files(make_content(make_result()))) == {"summary.csv", "wheelsets.csv", "criteria.csv"}

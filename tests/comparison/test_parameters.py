import dataclasses

import pytest

from uictest.analysis.comparison import (
    ParameterChange,
    ParameterOfRun,
    Tolerances,
    compare_runs,
    comparison_document,
    comparison_html,
)
from uictest.analysis.comparison.parameters import change_text
from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report import document_lines

from .conftest import make_run


def controller(slip, name="threshold"):
    parameter = Parameter("controller.slip_threshold", slip / 3.6, "m/s", f"{slip:g} km/h", "user")
    return EffectivePart("controller", "controller", name, "threshold", (parameter,))


def run_with(run, part):
    (result,) = run.results
    return dataclasses.replace(run, results=[dataclasses.replace(result, parts={"controller": part})])


def compared(make_run, first, second, **changes):
    return compare_runs(run_with(make_run(), first), run_with(make_run(**changes), second), Tolerances())


def test_the_parameter_that_changed_is_named():
    found = compared(make_run, controller(4), controller(3), braking_distance_m=470.0)
    assert found.parameters == [
        ParameterChange(
            "controller.slip_threshold",
            ParameterOfRun(4 / 3.6, "m/s", "4 km/h"),
            ParameterOfRun(3 / 3.6, "m/s", "3 km/h"),
            ("dry-120",),
        )
    ]
    assert "parameter controller.slip_threshold: 4 km/h -> 3 km/h (in dry-120)" in document_lines(
        comparison_document(found), None
    )
    assert found.to_dict()["parameters"][0]["second"] == "3 km/h"
    html = comparison_html(found)
    assert '<td data-label="A">4 km/h</td><td data-label="B">3 km/h</td>' in html
    assert "var uPlot=" not in html  # nothing is drawn


def test_a_changed_parameter_is_an_explanation_told_once_and_no_difference():
    found = compared(make_run, controller(4), controller(3))
    assert (found.agrees, list(found.notes)) == (True, [])
    assert compared(make_run, controller(4), controller(4)).parameters == []


def test_another_part_is_named_as_well_as_its_parameters():
    found = compared(make_run, controller(4), controller(3, "mine"))
    assert [change_text(change) for change in found.parameters] == [
        "controller: threshold -> mine",
        "controller.slip_threshold: 4 km/h -> 3 km/h",
    ]


def told_by(make_run, version, stated=""):
    facts = {"library": "wsp.so"} | ({"version": stated} if stated else {})
    rows = tuple(Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    run = run_with(make_run(), EffectivePart("controller", "controller", "wsp", None, rows))
    return dataclasses.replace(
        run, results=[dataclasses.replace(result, controller_version=version) for result in run.results]
    )


@pytest.mark.parametrize(
    ("first", "second", "changes"),
    [
        (("1.2",), ("1.3",), ["controller.version: 1.2 -> 1.3"]),
        (("1.2",), ("1.2",), []),
        (("1.2",), ("",), []),  # the second stop ended in an error
        (("1.2",), ("1.3", "1.3"), ["controller.version: 1.2 -> 1.3"]),
        (("1.2", "1.2"), ("1.3", "1.2"), ["controller.told_version: none -> 1.3"]),
    ],
)
def test_another_version_that_a_controller_tells_is_named(first, second, changes):
    found = compare_runs(told_by(make_run, *first), told_by(make_run, *second), Tolerances())
    assert found.agrees
    assert [change_text(change) for change in found.parameters] == changes

"""Two runs side by side."""

import dataclasses
from dataclasses import replace

import pytest

from uictest.analysis.comparison import Baseline, Scope, Tolerance, Tolerances, compare_runs
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.report import RunContent
from uictest.report.page import page_html
from uictest.report.run_folder import baseline_form, read_baseline_comparison
from uictest.report.traces.trace import trace_of

from ..report.builders import make_content, make_recording, make_result, make_verdict
from .conftest import make_run

DEFAULT = Tolerances()


def test_a_run_and_itself_do_not_differ():
    found = compare_runs(make_run(), make_run(), DEFAULT)
    assert (found.agrees, list(found.differences), list(found.notes)) == (True, [], [])
    assert found.compared == 1 + 1 + len(STOP_COLUMNS) + 2 * len(WHEELSET_COLUMNS)


def test_a_figure_that_moved_is_named_with_both_values_and_agrees_within_its_tolerance():
    found = compare_runs(make_run(), make_run(braking_distance_m=470.0), DEFAULT)
    (difference,) = found.beyond
    assert (difference.case, difference.quantity) == ("dry-120", "braking_distance_m")
    assert (difference.first, difference.second, difference.unit) == (465.0, 470.0, "m")
    assert (difference.deviation, difference.allowed) == (5.0, pytest.approx(0.47))
    within = compare_runs(make_run(), make_run(braking_distance_m=470.0), Tolerances.read(["braking_*=5"]))
    assert (within.agrees, [each.within for each in within.differences]) == (True, [True])


@pytest.mark.parametrize(
    ("changes", "quantity"),
    [
        ({"outcome": "invalid"}, "outcome"),
        ({"verdict": "fail"}, "criterion braking-distance"),
        ({"initial_adhesion_g": 0.1}, "initial_adhesion_g"),
        ({"braking_time_s": float("nan")}, "braking_time_s"),
    ],
)
def test_no_tolerance_lets_a_verdict_or_a_missing_figure_pass(changes, quantity):
    found = compare_runs(make_run(), make_run(**changes), Tolerances.read(["100000"]))
    assert [difference.quantity for difference in found.beyond] == [quantity]


def test_a_case_on_one_side_only_is_a_difference_on_either_side():
    found = compare_runs(make_run(), make_run(case_id="other"), DEFAULT)
    shown = [(each.case, each.quantity, each.first, each.second) for each in found.beyond]
    assert shown == [("dry-120", "case", "pass", "missing"), ("other", "case", "missing", "pass")]


def test_what_went_in_differently_is_noted_and_no_difference():
    other = make_run()
    manifest = dataclasses.replace(other.manifest, seed=1, inputs={"dry.yaml": "b" * 64})
    found = compare_runs(make_run(), RunContent("run", other.results, manifest), DEFAULT)
    assert found.agrees
    assert found.notes == ["seed: 0 -> 1", "inputs: dry.yaml: aaaaaaaaaaaa... -> bbbbbbbbbbbb..."]


NOW = make_result(id="dry", criteria=(make_verdict(value=465.25), make_verdict(id="slide", unit="%")))


def _compared(*accepted):
    """A drawn case, compared with what was accepted of it."""
    kept = {"dry": replace(NOW, criteria=accepted)}
    baseline = Baseline(
        "kept",
        "00",
        RunContent("kept", list(kept.values())),
        kept,
        {},
        Scope(frozenset()),
        Tolerances.read(()),
    )
    run = make_content(NOW, make_result(id="added"), traces={"dry": trace_of(make_recording())})
    return replace(run, baseline=baseline.compare(run))


def test_the_table_of_criteria_of_a_stop_has_the_accepted_values():
    content = _compared(make_verdict(value=460.5), make_verdict(id="slide", unit="%", value=None))
    assert content.baseline is not None
    assert content.baseline.values == {"dry": {"braking-distance": 460.5}}
    page = page_html(content)
    assert page.count("<small>baseline 460.5 m</small>") == page.count("<small>baseline ") == 1
    assert read_baseline_comparison({"baseline": baseline_form(content.baseline)}) == content.baseline


def test_a_value_in_another_unit_is_not_set_beside():
    content = _compared(make_verdict(value=0.4605, unit="km"), make_verdict(id="slide", unit="%", value=7.0))
    assert content.baseline is not None
    assert content.baseline.values == {"dry": {"slide": 7.0}}


def test_without_a_baseline_the_table_has_no_accepted_values():
    assert "<small>baseline " not in page_html(replace(_compared(make_verdict()), baseline=None))


@pytest.mark.parametrize(
    ("texts", "quantity", "expected"),
    [
        ([], "anything", Tolerance(1e-6, 1e-3)),
        (["1 %"], "anything", Tolerance(1e-6, 0.01)),
        (["1e-3"], "anything", Tolerance(1e-3, 0.0)),
        (["0.5", "1%", "0.2"], "anything", Tolerance(0.2, 0.01)),
        (["slide_*=0.02", "1%"], "slide_3", Tolerance(0.02, 0.0)),
        (["slide_*=0.02", "slide_3=5%"], "slide_3", Tolerance(1e-6, 0.05)),
        (["slide_*=0.02", "slide_3=5%", "slide_*=1%"], "slide_3", Tolerance(0.02, 0.01)),
        (["slide_*=0.02", "slide_3=5%"], "slide_4", Tolerance(0.02, 0.0)),
    ],
)
def test_the_last_pattern_that_fits_counts(texts, quantity, expected):
    assert Tolerances.read(texts).of(quantity) == expected


@pytest.mark.parametrize("text", ["", "x", "-1", "1 m", "a=", "a=b", "nan", "inf", "1..2", "=1", "1e999"])
def test_what_is_no_tolerance_is_named(text):
    with pytest.raises(ValueError, match="is not a tolerance"):
        Tolerances.read([text])


def test_the_larger_allowance_counts():
    assert Tolerance(0.5, 0.01).allowed(10.0) == 0.5
    assert Tolerance(0.5, 0.01).allowed(100.0) == 1.0
    assert Tolerance(0.5, 0.01).allowed(float("nan")) == 0.5

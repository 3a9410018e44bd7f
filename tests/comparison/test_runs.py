import dataclasses

import pytest

from uictest.analysis.comparison import Tolerances, compare_runs
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.report import RunContent

DEFAULT = Tolerances()


def test_a_run_and_itself_do_not_differ(make_run):
    found = compare_runs(make_run(), make_run(), DEFAULT)
    assert (found.agrees, list(found.differences), list(found.notes)) == (True, [], [])
    assert found.compared == 1 + 1 + len(STOP_COLUMNS) + 2 * len(WHEELSET_COLUMNS)


def test_a_figure_that_moved_is_named_with_both_values_and_agrees_within_its_tolerance(make_run):
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
def test_no_tolerance_lets_a_verdict_or_a_missing_figure_pass(make_run, changes, quantity):
    found = compare_runs(make_run(), make_run(**changes), Tolerances.read(["100000"]))
    assert [difference.quantity for difference in found.beyond] == [quantity]


def test_a_case_on_one_side_only_is_a_difference_on_either_side(make_run):
    found = compare_runs(make_run(), make_run(case_id="other"), DEFAULT)
    shown = [(each.case, each.quantity, each.first, each.second) for each in found.beyond]
    assert shown == [("dry-120", "case", "pass", "missing"), ("other", "case", "missing", "pass")]


def test_what_went_in_differently_is_noted_and_no_difference(make_run):
    other = make_run()
    manifest = dataclasses.replace(other.manifest, seed=1, inputs={"dry.yaml": "b" * 64})
    found = compare_runs(make_run(), RunContent("run", other.results, manifest), DEFAULT)
    assert found.agrees
    assert found.notes == ["seed: 0 -> 1", "inputs: dry.yaml: aaaaaaaaaaaa... -> bbbbbbbbbbbb..."]

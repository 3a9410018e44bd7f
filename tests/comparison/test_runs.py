from __future__ import annotations

import dataclasses
from collections.abc import Callable

import pytest

from uictest.analysis.comparison import Tolerances, compare_runs
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.report import RunContent

MakeRun = Callable[..., RunContent]
DEFAULT = Tolerances()


def test_a_run_and_itself_do_not_differ(make_run: MakeRun) -> None:
    found = compare_runs(make_run(), make_run(), DEFAULT)
    assert found.agrees
    assert (list(found.differences), list(found.notes)) == ([], [])
    assert found.compared == 1 + 1 + len(STOP_COLUMNS) + 2 * len(WHEELSET_COLUMNS)


def test_a_figure_that_moved_is_named_with_both_values(make_run: MakeRun) -> None:
    found = compare_runs(make_run(), make_run(braking_distance_m=470.0, friction="0.297"), DEFAULT)
    (difference,) = found.beyond
    assert (difference.case, difference.quantity) == ("dry-120", "braking_distance_m")
    assert (difference.first, difference.second, difference.unit) == (465.0, 470.0, "m")
    assert (difference.deviation, difference.allowed) == (5.0, pytest.approx(0.47))
    assert found.notes == ["dry-120: friction: 0.3 -> 0.297"]


def test_within_tolerance_is_a_difference_and_agrees(make_run: MakeRun) -> None:
    found = compare_runs(make_run(), make_run(braking_distance_m=470.0), Tolerances.read(["braking_*=5"]))
    assert found.agrees
    assert [difference.within for difference in found.differences] == [True]


@pytest.mark.parametrize(
    ("changes", "quantity"),
    [
        ({"outcome": "invalid"}, "outcome"),
        ({"verdict": "fail"}, "criterion braking-distance"),
        ({"initial_adhesion_g": 0.1}, "initial_adhesion_g"),
        ({"braking_time_s": float("nan")}, "braking_time_s"),
    ],
)
def test_no_tolerance_lets_a_verdict_or_a_missing_figure_pass(
    make_run: MakeRun, changes: dict[str, object], quantity: str
) -> None:
    found = compare_runs(make_run(), make_run(**changes), Tolerances.read(["100000"]))
    assert [difference.quantity for difference in found.beyond] == [quantity]


def test_a_case_on_one_side_only_is_a_difference_on_either_side(make_run: MakeRun) -> None:
    found = compare_runs(make_run(), make_run(case_id="other"), DEFAULT)
    shown = [(each.case, each.quantity, each.first, each.second) for each in found.beyond]
    assert shown == [("dry-120", "case", "pass", "missing"), ("other", "case", "missing", "pass")]


def test_what_went_in_differently_is_noted_and_no_difference(make_run: MakeRun) -> None:
    other = make_run()
    manifest = dataclasses.replace(other.manifest, seed=1, inputs={"dry.yaml": "b" * 64})
    found = compare_runs(make_run(), RunContent("run", other.results, manifest), DEFAULT)
    assert found.agrees
    assert found.notes == ["seed: 0 -> 1", "inputs: dry.yaml: aaaaaaaaaaaa... -> bbbbbbbbbbbb..."]

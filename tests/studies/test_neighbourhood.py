import numpy as np
import pytest

from studies import stop_runner
from studies.neighbourhood import (
    BANDS,
    PAPER,
    SEEDS,
    SETTINGS,
    counts,
    friction_sweep,
    in_bands,
    in_order,
    mean_counts,
    neighbourhood,
)
from studies.stop_runner import StopRunner, constant_friction
from uictest.plans.scenario import COMPENSATION_SETTINGS


@pytest.fixture(autouse=True)
def cases_as_stops(monkeypatch):
    """Let every stop come out as its case."""

    def judged(cases, jobs):
        return cases

    monkeypatch.setattr(stop_runner, "_judged", judged)


def test_every_setting_of_the_compensation_is_compared():
    assert tuple(COMPENSATION_SETTINGS) == SETTINGS


def test_nine_points_hold_the_repeats_with_their_friction_command_and_rig():
    points = neighbourhood(StopRunner())
    assert len({point.title for point in points}) == 9
    for point in points:
        assert set(point.stops) == {*COMPENSATION_SETTINGS, "four-caliper"}
        for name, cases in point.stops.items():
            assert len(cases) == len(SEEDS)
            scenarios = [case.scenario for case in cases]
            assert {each.rail.friction for each in scenarios} == {constant_friction(point.case)}
            assert {each.brake.command.text for each in scenarios} == {point.command}
            assert name in {scenarios[0].rig.compensation, scenarios[0].rig.topology}


def test_the_sweep_is_130_stops_about_the_friction_of_the_slide_test():
    sweep = friction_sweep(StopRunner())
    calibrated = constant_friction(StopRunner().cases("slide-80")[0])
    steps = [(constant_friction(point.case) - calibrated) * 1000.0 for point in sweep]
    assert steps == pytest.approx(range(-6, 7))
    assert sum(len(point.stops["none"]) for point in sweep) == 130
    assert {point.command for point in sweep} == {"100 %"}


def array(*values):
    return np.array(values, dtype=float)


def test_the_caliper_is_counted_on_the_rig_with_both_models_without_module_1(stop):
    stops = {
        "none": [stop(9, 21, 20, 22)],
        "full": [stop(11, 12, 10, 14)],
        "thermal": [stop(8, 13, 10, 14)],
        "four-caliper": [stop(7, 11, 10, 14)],
    }
    counted = {key: values.tolist() for key, values in counts(stops).items()}
    assert counted == {"caliper": [11], "none": [21], "full": [12], "thermal": [13], "reference": [11]}
    assert mean_counts([stop(99, 10, 11, 12), stop(99, 20, 20, 20)]).tolist() == [11.0, 20.0]


@pytest.mark.parametrize(
    ("caliper", "full", "none", "expected"),
    [
        (11.0, 11.0, 21.0, True),
        (11.0, 15.0, 21.0, True),
        (11.0, 16.0, 20.8, False),  # not clearly above full
        (18.0, 15.0, 20.0, False),  # none is nearer
        (0.0, 0.0, 0.0, False),
    ],
)
def test_the_order_is_that_of_the_paper(caliper, full, none, expected):
    assert in_order(array(caliper), array(full), array(none)).tolist() == [expected]


def test_all_three_counts_must_lie_in_their_bands_as_those_of_the_paper_do():
    counted = {"caliper": array(11, 11, 12), "none": array(21, 21, 23), "full": array(11, 13, 10)}
    assert in_bands(counted).tolist() == [True, False, True]
    assert PAPER == {"caliper": 11, "none": 21, "full": 11}
    assert in_bands({key: array(PAPER[key]) for key in BANDS}).all()

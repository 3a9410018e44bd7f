"""The stops of a case judged together, on records made by hand."""

import numpy as np
import pytest

from uictest.judging.evaluation import SimulatedRepeat, error_result, evaluate, evaluate_repeats
from uictest.plans.scenario import ShareOfStops

ALL, MEDIAN = "all", "median"


@pytest.fixture
def repeated(criterion, profile, scenario, case, stop, wheelsets):
    """Judge stops of these braking distances (m), None for one that ended in an error, by 440 .. 490 m."""

    def judged(distances, rule=ALL, expect="pass", **of_criterion):
        tested = criterion(**{"lower": "440 m", "upper": "490 m", **of_criterion})
        resolved = scenario(profile(tested), expect=expect)
        resolved.outcome_of_repeats = rule
        together = case(resolved)

        def simulated(seed, distance):
            if distance is None:
                return SimulatedRepeat(seed, error_result(together, "made up"))
            records = stop(braking_distance=distance), wheelsets(0.1 * seed, 0.2, 0.3, 0.4)
            return SimulatedRepeat(seed, evaluate(together, *records, 1.5, detail="status"), *records)

        repeats = [simulated(seed, distance) for seed, distance in enumerate(distances, start=5)]
        return evaluate_repeats(together, repeats)

    return judged


def test_a_verdict_that_turns_is_shown_as_such_and_under_the_median_as_well(repeated):
    result = repeated([450.0, 500.0, 470.0])
    assert (result.outcome, result.met) == ("invalid", False)
    (verdict,) = result.criteria
    assert (verdict.status, verdict.value, verdict.steady) == ("fail", 470.0, False)
    counts = verdict.over_stops
    assert (counts.passed, counts.failed, counts.lowest, counts.highest) == (2, 1, 450.0, 500.0)
    assert verdict.definition["bound"] == "440 .. 490 m"
    assert [stop.seed for stop in result.repeats.stops] == [5, 6, 7]
    assert [stop.outcome for stop in result.repeats.stops] == ["pass", "invalid", "pass"]
    result = repeated([450.0, 500.0, 470.0], MEDIAN)
    assert (result.outcome, result.reason) == ("pass", "")
    assert not result.criteria[0].steady
    # The figures of a stop whose rig is wrong are in every median.
    result = repeated([450.0, 500.0, 470.0], MEDIAN, layer="rig")
    assert (result.outcome, result.criteria[0].status) == ("invalid", "fail")
    assert "seed 6: " in result.criteria[0].reason


def test_measures_are_medians_over_the_stops_and_one_stop_is_judged_as_a_case_with_one(repeated):
    result = repeated([450.0, 480.0, 470.0, 460.0])
    assert result.measures["braking_distance_m"] == 465.0
    assert [wheelset["maximum_slide"] for wheelset in result.wheelsets] == pytest.approx(
        [0.65, 0.2, 0.3, 0.4]
    )
    assert result.duration == 6.0
    # The same value, margin, status and definitions; what is added are the counts.
    (verdict,) = repeated([450.0]).criteria
    assert (verdict.value, verdict.margin, verdict.status) == (450.0, 10.0, "pass")
    assert verdict.steady


def test_an_error_in_one_stop_makes_the_case_one_and_keeps_the_others(repeated):
    for rule in (ALL, MEDIAN):
        result = repeated([450.0, None, 470.0], rule)
        assert result.outcome == "error"
        assert result.reason == "error in 1 of 3 stops (seed 6), with seed 6: made up"
        assert result.measures["braking_distance_m"] == 460.0
        assert result.criteria[0].over_stops.passed == 2
    nothing = repeated([None, None])
    assert (nothing.outcome, nothing.criteria, nothing.measures, nothing.wheelsets) == ("error", (), None, ())


def test_an_expected_invalid_needs_every_stop_and_a_share_is_stated_in_the_scenario(repeated):
    assert repeated([500.0, 510.0], expect="invalid").met
    assert repeated([500.0, 450.0], expect="invalid").outcome == "pass"
    assert not repeated([500.0, 450.0], expect="invalid").met
    rule = ShareOfStops.model_validate({"at_least": "60 %"})
    result = repeated([450.0, 500.0, 470.0], rule)
    assert (result.outcome, result.repeats.rule, result.repeats.required_share) == ("pass", "at_least", 0.6)
    assert repeated([450.0, 500.0, 510.0], rule).outcome == "invalid"


def test_definitions_run_through_their_range_in_all_stops_at_once(
    criterion, profile, scenario, case, sliding_stop, wheelsets
):
    """One stop brakes hard for a second (its mean over T s is 0.08 g at T = 3), the other from the fourth
    second on (at T = 4.5): both keep 0.08 g from 3 to 4.5 s only.
    """
    phase = {"first_phase_duration": {"value": "4 s", "range": ["2 s", "5 s"]}}
    tested = criterion("initial_adhesion", upper="0.08 g", definition=phase)
    resolved = scenario(profile(tested), condition="wet")
    resolved.outcome_of_repeats = ALL
    together = case(resolved)
    hard_first, hard_last = [0.12, *[0.06] * 9], [*[0.06] * 3, *[0.12] * 7]
    repeats = []
    for seed, decelerations in enumerate((hard_first, hard_last)):
        speed = 33.0 - 9.80665 * np.concatenate([[0.0], np.cumsum(decelerations)])
        records = sliding_stop(speed_after_sliding=speed), wheelsets(0.2, 0.2, 0.2, 0.2)
        repeats.append(SimulatedRepeat(seed, evaluate(together, *records, detail="status"), *records))
    (verdict,) = evaluate_repeats(together, repeats).criteria
    assert verdict.status == "pass"
    assert verdict.value == pytest.approx((0.075 + 0.075) / 2)
    (sensitivity,) = verdict.sensitivity
    assert [(each.status, each.first, each.last) for each in sensitivity.intervals] == [
        ("fail", 2.0, pytest.approx(3.0, abs=1e-5)),
        ("pass", pytest.approx(3.0, abs=1e-5), pytest.approx(4.5, abs=1e-5)),
        ("fail", pytest.approx(4.5, abs=1e-5), 5.0),
    ]

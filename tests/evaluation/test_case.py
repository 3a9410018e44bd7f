import math

import numpy as np
import pytest

from uictest.judging.evaluation import CaseResult, error_result, evaluate, evaluate_simulated
from uictest.plans.scenario import expectation_of

G = 9.80665


@pytest.fixture
def slip_test(shipped, scenario, case):
    return case(scenario(shipped("uic-541-05-appendix-b"), condition="wet"))


def test_a_case_is_judged_and_its_figures_are_in_the_units_of_the_interface(
    slip_test, sliding_stop, wheelsets
):
    records = wheelsets(
        0.9, 0.9, 0.9, 0.9, valve_actuations=11, maximum_clamping_force=41e3, air_vented=0.01185
    )
    result = evaluate(slip_test, sliding_stop(0.07 * G, braking_distance=900.0), records, duration=0.25)
    assert (result.outcome, str(result.expect), result.met, result.reason) == ("pass", "pass", True, "")
    assert result.scenario == "scenarios/slip-120.yaml"
    figures = result.measures
    assert figures["initial_adhesion_g"] == pytest.approx(0.07)
    assert figures["mean_deceleration_mps2"] == pytest.approx((120 / 3.6) ** 2 / 1800)
    assert figures["reservoir_minimum_bar"] == pytest.approx(7.2)
    assert figures["air_consumed_nl"] == pytest.approx(100.0)
    assert figures["air_residual"] == -3e-14
    assert figures["air_energy_residual"] == 2e-13
    first = result.wheelsets[0]
    assert (first["maximum_slide"], first["valve_actuations"]) == (0.9, 11)
    assert first["maximum_clamping_force_n"] == 41e3
    assert first["air_vented_nl"] == pytest.approx(10.0)


def test_the_figure_takes_the_first_phase_that_the_criterion_defines(
    criterion, profile, scenario, case, sliding_stop, wheelsets
):
    speed = [30.0, 29.0, *[20.0] * 9]
    phase = {"first_phase_duration": {"value": "1 s", "range": ["1 s", "2 s"]}}
    slippery = profile(criterion("initial_adhesion", upper="0.2 g", definition=phase))
    result = evaluate(case(scenario(slippery)), sliding_stop(speed_after_sliding=speed), wheelsets(0.5))
    assert result.measures["initial_adhesion_g"] * G == pytest.approx(1.0)
    assert result.criteria[0].value == result.measures["initial_adhesion_g"]


def test_a_stop_that_is_not_slippery_enough_is_invalid_and_a_figure_never_reached_is_nan(
    slip_test, sliding_stop, wheelsets, stop
):
    result = evaluate(slip_test, sliding_stop(0.09 * G), wheelsets(0.9, 0.9, 0.9, 0.9))
    assert (result.outcome, result.met) == ("invalid", False)
    assert result.reason == "initial-adhesion: 0.09 g misses < 0.08 g by 0.01 g"
    figures = evaluate(slip_test, stop(), wheelsets(0.0)).measures
    assert math.isnan(figures["initial_adhesion_g"])


@pytest.mark.parametrize(
    ("changes", "slides", "outcome", "what"),
    [
        ({}, (0.1, 0.1, 0.1, 0.1), "pass", ""),
        ({"energy_residual": -0.002}, (0.1,), "invalid", "energy-balance"),
        ({"air_residual": np.nan}, (0.1,), "invalid", "air-balance: nan never keeps < 1e-09"),
        ({"air_energy_residual": -1e-9}, (0.1,), "invalid", "air-energy-balance: 1e-09 misses < 1e-09"),
        (
            {"stopped": 0.0, "end_speed": 3.0},
            (0.1,),
            "inconclusive",
            "standstill: no standstill; the simulation ended after 60 s at 10.8 km/h",
        ),
    ],
)
def test_our_own_profile_judges_any_stop(
    shipped, scenario, case, stop, wheelsets, changes, slides, outcome, what
):
    profiles = shipped("uictest-stop"), shipped("uictest-rig")
    result = evaluate(case(scenario(*profiles)), stop(**changes), wheelsets(*slides))
    assert result.outcome == outcome
    assert what in result.reason


@pytest.mark.parametrize(
    ("misfit", "statuses", "outcome"),
    [(0.9, "pass", "pass"), (1.1, "fail", "invalid"), (math.nan, "inconclusive", "pass")],
)
def test_a_check_of_the_rig_makes_a_stop_invalid_and_decides_nothing_else(
    shipped, scenario, case, stop, wheelsets, monkeypatch, misfit, statuses, outcome
):
    """What is not known leaves the outcome alone; without any other criterion there is no judgement."""
    monkeypatch.setattr("uictest.plans.scenario.misfits", lambda scenario: ["the lever ratio is 3"])
    stopped = stop(compensation_misfit=misfit)
    result = evaluate(
        case(scenario(shipped("uictest-stop"), shipped("uictest-rig"))), stopped, wheelsets(0.0)
    )
    fits = next(each for each in result.criteria if each.id == "compensation-fits")
    assert (result.outcome, fits.layer, fits.status) == (outcome, "rig", statuses)
    said = (
        "compensation-fits: the lever ratio is 3;"
        " write `rig.compensation_model: identify` or `rig.topology: four-caliper`"
    )
    assert result.reason == (said if outcome == "invalid" else "")
    alone = evaluate(case(scenario(shipped("uictest-rig"))), stopped, wheelsets(0.0))
    assert alone.outcome == ("invalid" if outcome == "invalid" else "skipped")


def test_a_wheelset_that_stands_still_too_long_fails(shipped, scenario, case, stop, wheelsets):
    records = wheelsets(1.0, 1.0, 1.0, 1.0, longest_lock=[0.2, 0.0, 6.5, 0.1])
    result = evaluate(case(scenario(shipped("uictest-stop"))), stop(), records)
    assert result.outcome == "fail"
    kept = "3 of 4 wheelsets within the limit of 1 s (4 needed)"
    assert result.reason == f"locked-wheels: {kept}: 0.2, 0, 6.5, 0.1 s"
    assert next(each for each in result.criteria if each.id == "locked-wheels").missed_by == (3,)


def test_a_crashed_simulation_is_an_error_with_its_reason(slip_test):
    result = error_result(slip_test, "diverged at 3.2 s", duration=0.1)
    assert (result.outcome, result.met, result.reason) == ("error", False, "diverged at 3.2 s")
    assert result.measures is None


@pytest.mark.parametrize(
    ("outcome", "expect", "met"),
    [
        ("pass", "pass", True),
        ("fail", "pass", False),
        ("fail", "fail", True),
        ("invalid", "invalid", True),
        ("invalid", "fail", False),
        ("skipped", "pass", False),
        ("skipped", "skipped", True),
        ("pass", "skipped", False),
        ("skipped", "fail", False),
        ("inconclusive", "pass", False),
        ("inconclusive", "fail", False),
        ("inconclusive", "invalid", False),
        ("error", "fail", False),
    ],
)
def test_an_expectation_is_met_by_its_own_outcome(outcome, expect, met):
    assert CaseResult("a", "a.yaml", {}, expectation_of(expect), outcome).met is met


@pytest.fixture
def sound_test(shipped, scenario, case):
    return case(scenario(shipped("uictest-stop"), condition="dry"))


def test_a_stop_with_finite_measures_is_judged_and_a_wheelset_without_is_an_error_and_named(
    sound_test, stop, wheelsets
):
    # The minimum deceleration is NaN where the stop ended before the brake was developed.
    undeveloped = stop(minimum_deceleration=math.nan)
    result = evaluate_simulated(sound_test, undeveloped, wheelsets(0.0, 0.0, 0.0, 0.0))
    assert result.outcome == "pass"
    result = evaluate_simulated(sound_test, stop(), wheelsets(0.0, math.nan, 0.0, 0.0))
    assert result.outcome == "error"
    assert "no finite maximum_slide_2" in result.reason


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(
    "name", ["air_residual", "air_energy_residual", "energy_residual", "air_consumed", "end_distance"]
)
def test_a_measure_of_the_stop_that_is_no_number_is_an_error_not_a_verdict(
    sound_test, stop, wheelsets, name, value
):
    result = evaluate_simulated(sound_test, stop(**{name: value}), wheelsets(0.0, 0.0, 0.0, 0.0), 2.5)
    assert (result.outcome, result.criteria, result.duration) == ("error", (), 2.5)
    assert f"no finite {name}" in result.reason


def test_a_stop_that_takes_no_air_has_no_balances_of_the_air(sound_test, stop, wheelsets):
    measures = stop(air_consumed=0.0, air_residual=math.nan, air_energy_residual=math.nan, end_time=0.086)
    result = evaluate_simulated(sound_test, measures, wheelsets(0.0, 0.0, 0.0, 0.0))
    assert result.outcome == "error"
    assert "ended after 0.086 s, before the brake took any air" in result.reason

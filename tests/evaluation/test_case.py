"""From the measures of a stop to the result of its case."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from uictest.controllers import ResponseTimes
from uictest.judging.evaluation import (
    CaseResult,
    SimulatedRepeat,
    cases_document,
    error_result,
    evaluate,
    evaluate_repeats,
    evaluate_simulated,
    result_document,
    results_of,
)
from uictest.plans.scenario import applies_to, expectation_of, load

from ..measures.catalogue.conftest import sliding_stop, stop, wheelsets
from .conftest import case, criterion, profile, scenario, shipped

G = 9.80665


@pytest.fixture
def slip_test():
    return case(scenario(shipped("uic-541-05-appendix-b"), condition="wet"))


def test_a_case_is_judged_and_its_figures_are_in_the_units_of_the_interface(slip_test):
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


def test_the_figure_takes_the_first_phase_that_the_criterion_defines():
    speed = [30.0, 29.0, *[20.0] * 9]
    phase = {"first_phase_duration": {"value": "1 s", "range": ["1 s", "2 s"]}}
    slippery = profile(criterion("initial_adhesion", upper="0.2 g", definition=phase))
    result = evaluate(case(scenario(slippery)), sliding_stop(speed_after_sliding=speed), wheelsets(0.5))
    assert result.measures["initial_adhesion_g"] * G == pytest.approx(1.0)
    assert result.criteria[0].value == result.measures["initial_adhesion_g"]


def test_a_stop_that_is_not_slippery_enough_is_invalid_and_a_figure_never_reached_is_nan(slip_test):
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
def test_our_own_profile_judges_any_stop(changes, slides, outcome, what):
    profiles = shipped("uictest-stop"), shipped("uictest-rig")
    result = evaluate(case(scenario(*profiles)), stop(**changes), wheelsets(*slides))
    assert result.outcome == outcome
    assert what in result.reason


@pytest.mark.parametrize(
    ("misfit", "statuses", "outcome"),
    [(0.9, "pass", "pass"), (1.1, "fail", "invalid"), (math.nan, "inconclusive", "pass")],
)
def test_a_check_of_the_rig_makes_a_stop_invalid_and_decides_nothing_else(
    monkeypatch, misfit, statuses, outcome
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


def test_a_wheelset_that_stands_still_too_long_fails():
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
def sound_test():
    return case(scenario(shipped("uictest-stop"), condition="dry"))


def test_a_stop_is_an_error_whose_wheelset_has_no_finite_measure_or_that_takes_no_air(sound_test):
    # The minimum deceleration is NaN where the stop ended before the brake was developed.
    undeveloped = stop(minimum_deceleration=math.nan)
    result = evaluate_simulated(sound_test, undeveloped, wheelsets(0.0, 0.0, 0.0, 0.0))
    assert result.outcome == "pass"
    result = evaluate_simulated(sound_test, stop(), wheelsets(0.0, math.nan, 0.0, 0.0))
    assert result.outcome == "error"
    assert "no finite maximum_slide_2" in result.reason
    measures = stop(air_consumed=0.0, air_residual=math.nan, air_energy_residual=math.nan, end_time=0.086)
    result = evaluate_simulated(sound_test, measures, wheelsets(0.0, 0.0, 0.0, 0.0))
    assert result.outcome == "error"
    assert "ended after 0.086 s, before the brake took any air" in result.reason


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(
    "name", ["air_residual", "air_energy_residual", "energy_residual", "air_consumed", "end_distance"]
)
def test_a_measure_of_the_stop_that_is_no_number_is_an_error_not_a_verdict(sound_test, name, value):
    result = evaluate_simulated(sound_test, stop(**{name: value}), wheelsets(0.0, 0.0, 0.0, 0.0), 2.5)
    assert (result.outcome, result.criteria, result.duration) == ("error", (), 2.5)
    assert f"no finite {name}" in result.reason


IN_TIME = ResponseTimes(1770, 0.01, 0, 0.0012, 700, 0.0003)
LATE = replace(IN_TIME, missed_deadlines=3, longest_answer_s=0.0314)


def judged(times, limit="500 m"):
    """Judge a stop of 465 m by one requirement on its distance."""
    judged_as = case(scenario(profile(criterion(layer="requirement", upper=limit))))
    return evaluate_simulated(judged_as, stop(), wheelsets(), response_times=times)


def test_a_missed_deadline_makes_a_stop_invalid_before_a_failed_requirement_and_says_how_late():
    result = judged(LATE)
    assert result.outcome == "invalid"
    assert result.reason == (
        "real-time: 3 of 1770 answers came after the end of their cycle of 10 ms; the longest took 31.4 ms"
        " (cycle 700)"
    )
    assert (result.criteria[-1].value, result.criteria[-1].upper) == (3.0, 0.0)
    assert judged(None, "400 m").outcome == "fail"
    assert judged(LATE, "400 m").outcome == "invalid"
    assert judged(replace(IN_TIME, missed_deadlines=1)).outcome == "invalid"


def test_the_document_has_response_times_in_real_time_only_and_they_are_read_back():
    with_clock, without = cases_document([judged(LATE), judged(None)])
    assert with_clock["response_times"] == {
        "answers": 1770,
        "cycle_time_s": 0.01,
        "missed_deadlines": 3,
        "longest_answer_s": 0.0314,
        "longest_answer_cycle": 700,
        "start_jitter_s": 0.0003,
    }
    assert set(with_clock) - set(without) == {"response_times"}
    result = judged(LATE)
    document = json.loads(json.dumps(result_document([result])))
    assert results_of(document)[0].response_times == LATE
    with_clock, without = cases_document([replace(judged(IN_TIME), response_times=None), judged(None)])
    assert with_clock == without
    assert with_clock["outcome"] == "pass"


TEXT = """\
schema: uictest/scenario/1
name: stop
initial_speed: 120 km/h
requirements: [BR-1]
test_case: WSP-TC-7
criteria:
  name: own
  criteria:
    - {id: short, layer: requirement, measure: braking_distance, upper: 900 m, requirements: [BR-2, BR-1]}
    - id: slow
      layer: requirement
      measure: braking_distance
      upper: 900 m
      applies: {initial_speed: {value: 80 km/h, tolerance: 4 km/h}}
      requirements: [BR-3]
"""


@pytest.fixture
def named(tmp_path):
    """A stop from 120 km/h that names requirements, and so do two criteria, one of them for 80 km/h."""
    (tmp_path / "stop.yaml").write_text(TEXT)
    (case,) = load([tmp_path])
    return case


def test_a_result_has_the_ids_of_the_case_and_one_that_was_not_judged_hides_no_requirement(named):
    result = evaluate(named, stop(), wheelsets(0.0, 0.0, 0.0, 0.0))
    assert (result.requirements, result.test_case) == (("BR-1",), "WSP-TC-7")
    of_criteria = [verdict.requirements for verdict in result.criteria if verdict.layer != "rig"]
    assert of_criteria == [("BR-2", "BR-1"), ("BR-3",)]
    (profile,) = named.scenario.criteria
    assert [applies_to(criterion, named.scenario) for criterion in profile.criteria] == [True, False]
    assert error_result(named, "diverged").requirements == ("BR-1", "BR-2", "BR-3")
    records = stop(), wheelsets(0.0, 0.0, 0.0, 0.0)
    sound = SimulatedRepeat(0, evaluate(named, *records, detail="status"), *records)
    assert evaluate_repeats(named, [sound, sound]).requirements == ("BR-1",)
    failed = SimulatedRepeat(1, error_result(named, "diverged"))
    assert evaluate_repeats(named, [sound, failed]).requirements == ("BR-1", "BR-2", "BR-3")

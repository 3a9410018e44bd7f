"""A simulated stop whose measures are no numbers."""

import math

import pytest

from uictest.evaluation import evaluate_simulated


@pytest.fixture
def slip_test(shipped, scenario, case):
    return case(scenario(shipped("uictest-stop"), condition="dry"))


def test_a_stop_with_finite_measures_is_judged(slip_test, stop, wheelsets) -> None:
    # The minimum deceleration is NaN where the stop ended before the brake was developed.
    result = evaluate_simulated(slip_test, stop(minimum_deceleration=math.nan), wheelsets(0.0, 0.0, 0.0, 0.0))

    assert result.outcome == "pass"


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["air_residual", "energy_residual", "air_consumed", "end_distance"])
def test_a_measure_of_the_stop_that_is_no_number_is_an_error_not_a_verdict(
    slip_test, stop, wheelsets, name: str, value: float
) -> None:
    result = evaluate_simulated(slip_test, stop(**{name: value}), wheelsets(0.0, 0.0, 0.0, 0.0), 2.5)

    assert (result.outcome, result.criteria, result.duration) == ("error", (), 2.5)
    assert f"no finite {name}" in result.reason


def test_a_measure_of_a_wheelset_that_is_no_number_is_an_error_and_named(slip_test, stop, wheelsets) -> None:
    result = evaluate_simulated(slip_test, stop(), wheelsets(0.0, math.nan, 0.0, 0.0))

    assert result.outcome == "error"
    assert "no finite maximum_slide_2" in result.reason


def test_a_stop_that_takes_no_air_has_no_air_balance(slip_test, stop, wheelsets) -> None:
    measures = stop(air_consumed=0.0, air_residual=math.nan, end_time=0.086)

    result = evaluate_simulated(slip_test, measures, wheelsets(0.0, 0.0, 0.0, 0.0))

    assert result.outcome == "error"
    assert "ended after 0.086 s, before the brake took any air" in result.reason

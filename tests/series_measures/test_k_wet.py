"""K_wet against the figures of UNISIG SUBSET-040, 4.4.1.5."""

import math

import pytest
from hypothesis import given, strategies

from uictest.core.series_measures import SERIES_MEASURES, CountedStop, SpeedStops

K_WET = SERIES_MEASURES["k_wet"]
INCREASE = SERIES_MEASURES["deceleration_distance_extension"]


def stop(deceleration_distance):
    whole = {"corrected_distance_m": 500.0, "braking_distance_m": 500.0}
    return CountedStop(whole | {"deceleration_distance_m": deceleration_distance}, (), passed=True)


def speed(dry, wet):
    return SpeedStops(30.0, tuple(map(stop, dry)), tuple(map(stop, wet)))


def value(measure, *speeds):
    estimate = measure.of_series(speeds, 0.95).estimate
    return float(estimate.value)


@pytest.mark.parametrize(
    ("increase", "k_wet"), [(0.0, 1.0), (10.0, 0.909), (15.0, 0.870), (20.0, 0.833), (25.0, 0.800)]
)
def test_a_pair_of_stops_gives_the_published_factor(increase, k_wet):
    pair = speed([400.0], [400.0 * (1.0 + increase / 100.0)])
    assert value(INCREASE, pair) == pytest.approx(increase)
    assert value(K_WET, pair) == pytest.approx(k_wet, abs=5e-4)


def test_the_factor_is_that_of_the_mean_increase_and_its_interval_goes_through_the_formula():
    # Increases of 10 and 30 %: 100/120, not the mean of 0.909 and 0.769.
    assert value(K_WET, speed([398.0, 402.0], [440.0, 520.0])) == pytest.approx(100.0 / 120.0)
    slow, fast = speed([180.0], [198.0]), speed([400.0], [500.0])
    for order in ((slow, fast), (fast, slow)):
        assert value(K_WET, *order) == pytest.approx(0.8)
        assert value(INCREASE, *order) == pytest.approx(25.0)
    stops = speed([399.0, 401.0], [440.0, 460.0, 480.0])
    increase, factor = (each.of_series([stops], 0.95).estimate for each in (INCREASE, K_WET))
    assert (factor.low, factor.high) == pytest.approx(
        (100 / (100 + increase.high), 100 / (100 + increase.low))
    )


@given(strategies.lists(strategies.floats(300.0, 900.0), min_size=1, max_size=20))
def test_factor_and_increase_say_the_same(wet):
    stops = speed([400.0], wet)
    assert value(K_WET, stops) == pytest.approx(100.0 / (100.0 + value(INCREASE, stops)))


def test_without_a_dry_stop_or_with_an_interval_below_zero_there_is_none():
    assert K_WET.of_series([speed([], [500.0])], 0.95).estimate is None
    # Increases of 60 and 140 %: 100 -+ 508 %, whose ends would be K_wet of -0.32 and 0.14 about 0.5.
    factor = K_WET.of_series([speed([399.0, 401.0], [640.0, 960.0])], 0.95).estimate
    assert factor.value == pytest.approx(0.5)
    assert math.isnan(factor.low)
    assert math.isnan(factor.high)

"""Estimates, K_wet, and every measure of a series."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.series_measures import SERIES_MEASURES, CountedStop, SpeedStops
from uictest.core.series_measures.measure import largest_of, mean_of, median_of, share_of, smallest_of
from uictest.core.units import KINDS


def make_stop(distance=460.0, *, passed=True, locked=0.0, **columns):
    """A stop with a braking distance, a deceleration distance 60 m shorter, and whatever else is given."""
    own = {"braking_distance_m": distance, "corrected_distance_m": distance}
    measures = own | {"deceleration_distance_m": distance - 60.0} | columns
    wheelsets = tuple({"locked_time_s": time} for time in (0.0, locked, 0.0, 0.0))
    return CountedStop(measures, wheelsets, passed)


def make_speed(dry, wet, speed=120.0 / 3.6):
    """Dry and wet stops by their braking distances."""
    return SpeedStops(speed, tuple(map(make_stop, dry)), tuple(map(make_stop, wet)))


def test_the_interval_of_the_median_has_known_ranks_and_holds_it_in_samples():
    # P(at most 1 of 10 fair draws) = 11/1024 on each side: 97.9 %; the third to the eighth give 89 %.
    estimate = median_of([float(n) for n in range(1, 11)], 0.95)
    assert (estimate.value, estimate.low, estimate.high) == (5.5, 2.0, 9.0)
    assert math.isnan(median_of([1.0, 2.0, 3.0, 4.0, 5.0], 0.95).low)
    assert (median_of([6.0, 1.0, 2.0, 3.0, 4.0, 5.0], 0.95).low) == 1.0
    draws = np.random.default_rng(3).exponential(1.0, (2000, 25))
    estimates = [median_of(list(row), 0.95) for row in draws]
    held = sum(each.low <= math.log(2.0) <= each.high for each in estimates)
    assert held / 2000 >= 0.945


def test_a_share_has_the_interval_of_clopper_and_pearson():
    estimate = share_of([1.0] * 6 + [0.0] * 4, 0.95)
    # The published example of six of ten.
    assert (estimate.value, estimate.low, estimate.high) == pytest.approx((60.0, 26.24, 87.84), abs=5e-3)


@given(strategies.lists(strategies.floats(-1e6, 1e6), min_size=1, max_size=40))
def test_every_value_lies_within_the_spread_and_its_interval(values):
    for statistic in (median_of, mean_of, largest_of, smallest_of):
        estimate = statistic(values, 0.95)
        air = 1e-9 * max(map(abs, values))
        assert estimate.smallest - air <= estimate.value <= estimate.largest + air
        assert not estimate.value < estimate.low - air
        assert not estimate.value > estimate.high + air


def test_the_largest_of_59_covers_95_percent_of_all_stops_and_a_falling_function_turns_intervals():
    estimate = mean_of([1.0, 2.0, 3.0], 0.95).mapped(lambda value: -value)
    assert estimate.low < estimate.value == -2.0 < estimate.high
    assert (estimate.smallest, estimate.largest) == (-3.0, -1.0)
    assert largest_of([0.0] * 59, 0.95).covered >= 0.95
    assert largest_of([0.0] * 58, 0.95).covered < 0.95
    assert math.isnan(largest_of([1.0, 2.0], 0.95).low)


K_WET = SERIES_MEASURES["k_wet"]
INCREASE = SERIES_MEASURES["deceleration_distance_extension"]


def speed(dry, wet):
    """Dry and wet stops by their deceleration distances."""
    dry, wet = (tuple(make_stop(deceleration_distance_m=each) for each in of) for of in (dry, wet))
    return SpeedStops(30.0, dry, wet)


def value(measure, *speeds):
    return float(measure.of_series(speeds, 0.95).estimate.value)


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


@pytest.mark.parametrize("name", SERIES_MEASURES)
def test_a_measure_has_a_unit_of_its_kind_and_reads_columns_that_results_have(name):
    measure = SERIES_MEASURES[name]
    kind = KINDS[measure.kind]
    assert measure.unit in kind.units or (kind.bare and measure.unit == "1")
    wheelsets = (dict.fromkeys(WHEELSET_COLUMNS, 1.0),) * 4
    stop = CountedStop(dict.fromkeys(STOP_COLUMNS, 1.0), wheelsets, passed=True)
    assert measure.of_series([SpeedStops(30.0, (stop,), (stop,))], 0.95).estimate.stops == 1


def test_the_value_of_a_series_is_that_of_its_worst_speed_and_a_share_of_all_stops():
    speeds = [make_speed([200.0], [220.0, 230.0, 240.0]), make_speed([460.0], [480.0, 490.0, 500.0])]
    extension = SERIES_MEASURES["stopping_distance_extension"].of_series(speeds, 0.95).estimate
    assert extension.value == pytest.approx(15.0)
    assert extension.stops == 3
    speeds = [
        SpeedStops(20.0, (), tuple(make_stop(passed=passed) for passed in (True, True, True))),
        SpeedStops(30.0, (), (make_stop(passed=False),)),
    ]
    share = SERIES_MEASURES["passing_share"].of_series(speeds, 0.95).estimate
    assert (share.value, share.stops) == (75.0, 4)


def test_no_measure_pools_stops_on_different_rails():
    """On the cleaned rail 9 of 10 pass, from both speeds; on the other one 1 of 2: pooled it were 83 %."""
    kept, lost = make_stop(passed=True), make_stop(passed=False)
    speeds = [
        SpeedStops(20.0, (), (kept,) * 5, "cleaned"),
        SpeedStops(30.0, (), (kept,) * 4 + (lost,), "cleaned"),
        SpeedStops(30.0, (), (kept, lost), "uncleaned"),
    ]
    share = SERIES_MEASURES["passing_share"]
    worst = share.of_series(speeds, 0.95).estimate
    assert (worst.value, worst.stops) == (50.0, 2)
    assert value(share, *speeds[:2]) == 90.0
    for measure in SERIES_MEASURES.values():
        assert all(len({each.rail for each in group}) == 1 for group in measure.groups(speeds))


def test_the_most_locked_wheelset_and_the_smallest_margin_speak_for_stops():
    speed = SpeedStops(30.0, (), tuple(make_stop(locked=time) for time in (0.2, 3.0, 0.4)))
    locked = [SERIES_MEASURES[f"{name}_locked_time"] for name in ("median", "worst")]
    assert [value(measure, speed) for measure in locked] == [0.4, 3.0]
    speed = SpeedStops(30.0, (), tuple(make_stop(reservoir_margin_bar=bar) for bar in (1.2, 0.4, 0.9)))
    assert value(SERIES_MEASURES["worst_reservoir_margin"], speed) == 0.4
    stop = make_stop(deceleration_bogie_1_mps2=1.1, deceleration_bogie_2_mps2=0.9)
    imbalance = value(SERIES_MEASURES["median_bogie_imbalance"], SpeedStops(30.0, (), (stop,)))
    assert imbalance == pytest.approx(20.0)


def test_a_stop_or_a_speed_without_the_number_leaves_the_measure_open():
    speed = SpeedStops(30.0, (), (make_stop(reservoir_margin_bar=1.0), make_stop()))
    margin = SERIES_MEASURES["worst_reservoir_margin"].of_series([speed], 0.95)
    assert margin.estimate is None
    assert margin.unavailable_reason == "1 of 2 wet stops have no such number"
    speeds = [make_speed([460.0], [480.0]), make_speed([], [230.0])]
    assert SERIES_MEASURES["k_wet"].of_series(speeds, 0.95).estimate is None


def test_a_relation_to_the_dry_stop_is_made_speed_by_speed_of_figures_of_single_stops():
    # 240 m from the lower speed is 120 % of its dry stop, though far below the dry stop from the higher one.
    speeds = [make_speed([198.0, 202.0], [240.0]), make_speed([460.0], [506.0])]
    relation = SERIES_MEASURES["worst_braking_distance"].percent_of_dry(speeds, 0.95).estimate
    assert relation.value == pytest.approx(120.0)
    with pytest.raises(ValueError, match="passing_share"):
        SERIES_MEASURES["passing_share"].percent_of_dry([make_speed([1.0], [1.0])], 0.95)

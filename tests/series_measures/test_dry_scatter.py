"""How often intervals over scattered dry stops hold what stops were drawn from, and how wide they are."""

import math
from itertools import product

import numpy as np
import pytest

from uictest.core.series_measures import SERIES_MEASURES, CountedStop, SpeedStops

DRY = 400.0
"""m, the mean that dry stops are drawn about."""

_DISTANCES = ("deceleration_distance_m", "corrected_distance_m", "braking_distance_m")


def drawn(draw, dry, wet, dry_scatter, wet_scatter, ratio):
    """Return the stops of one campaign: normal draws, the scatter in % of each mean."""

    def stops(count, mean, scatter):
        return tuple(
            CountedStop(dict.fromkeys(_DISTANCES, own), (), passed=True)
            for own in draw.normal(mean, mean * scatter / 100.0, count)
        )

    return SpeedStops(30.0, stops(dry, DRY, dry_scatter), stops(wet, DRY * ratio, wet_scatter))


def holds(name, truth, campaigns):
    """Return which intervals of a measure hold the truth, and how wide they are; of those that are."""
    estimates = [SERIES_MEASURES[name].of_series([each], 0.95).estimate for each in campaigns]
    known = [each for each in estimates if math.isfinite(each.low)]
    return [each.low <= truth <= each.high for each in known], [each.high - each.low for each in known]


def few_misses(held):
    return np.mean(held) >= 0.94 - 3.0 * math.sqrt(0.94 * 0.06 / len(held))


def hold_of(dry, wet, scatters, ratio, count):
    draw = np.random.default_rng([dry, wet, *scatters, round(100 * ratio)])
    campaigns = [drawn(draw, dry, wet, *scatters, ratio) for _ in range(count)]
    held, _ = holds("k_wet", 1.0 / ratio, campaigns)
    assert few_misses(held), (np.mean(held), dry, wet, scatters, ratio)
    increases, widths = holds("deceleration_distance_extension", 100.0 * (ratio - 1.0), campaigns)
    assert increases == held or dry == 2, "K_wet has no interval where that of the distances reaches zero"
    if wet > 5:
        medians, _ = holds("stopping_distance_extension", 100.0 * (ratio - 1.0), campaigns)
        assert few_misses(medians), (np.mean(medians), dry, wet, scatters, ratio)
    if dry >= 5:
        # With both scatters known; Student's t of five values takes 1.42 times as much.
        error = ratio * math.hypot(scatters[0] / math.sqrt(dry), scatters[1] / math.sqrt(wet))
        assert np.median(widths) < 1.45 * 2.0 * 1.96 * error


@pytest.mark.parametrize("dry", [2, 3, 5, 10])
@pytest.mark.parametrize("wet", [5, 30])
def test_the_interval_of_k_wet_holds_the_truth_and_is_not_too_wide(dry, wet):
    for scatters, ratio in product([(4, 4), (6, 2)], [1.05, 1.3]):
        hold_of(dry, wet, scatters, ratio, 250)


@pytest.mark.slow
@pytest.mark.parametrize("dry", range(2, 11))
def test_so_it_does_for_every_number_of_stops_and_every_scatter(dry):
    scatters = list(product([2, 4, 6], repeat=2))
    for wet, of_both, ratio in product([5, 8, 12, 20, 30], scatters, [1.05, 1.15, 1.3]):
        hold_of(dry, wet, of_both, ratio, 500)


def test_the_share_below_the_largest_extension_holds_beside_dry_stops_that_scatter():
    draw = np.random.default_rng(8)
    measure, held = SERIES_MEASURES["worst_stopping_distance_extension"], []
    for _ in range(1000):
        estimate = measure.of_series([drawn(draw, 5, 12, 4.0, 4.0, 1.2)], 0.95).estimate
        error = (1.0 + estimate.high / 100.0 - 1.2) / (1.2 * 0.04)
        held.append(0.5 * math.erfc(-error / math.sqrt(2.0)) >= estimate.covered)
        assert estimate.low < estimate.value < estimate.high
    assert few_misses(held)


@pytest.mark.parametrize(
    "name", ["k_wet", "stopping_distance_extension", "worst_stopping_distance_extension"]
)
def test_one_dry_stop_shows_no_scatter_nor_do_few_equal_ones_and_many_scatter_by_nothing(name):
    draw = np.random.default_rng(9)
    few_stops = drawn(draw, 1, 8, 4.0, 4.0, 1.2)
    measure = SERIES_MEASURES[name]
    for count in (1, 2, 4):
        few = measure.of_series([SpeedStops(30.0, few_stops.dry * count, few_stops.wet)], 0.95).estimate
        assert all(map(math.isnan, (few.low, few.high, few.covered)))
        assert not few.dry_scatter
    exact = measure.of_series([SpeedStops(30.0, few_stops.dry * 5, few_stops.wet)], 0.95).estimate
    assert exact.value == pytest.approx(few.value)
    assert exact.dry_scatter
    if name == "stopping_distance_extension":
        # Of eight values the smallest and the largest: 1 - 2 / 2^8 is 99.2 %, the next ones have 93 %.
        assert (exact.low, exact.high) == pytest.approx((exact.smallest, exact.largest))


def test_figures_in_percent_of_the_dry_stop_have_the_same_interval():
    campaign = drawn(np.random.default_rng(10), 4, 9, 3.0, 3.0, 1.2)
    percent = SERIES_MEASURES["median_braking_distance"].percent_of_dry([campaign], 0.95).estimate
    increase = SERIES_MEASURES["stopping_distance_extension"].of_series([campaign], 0.95).estimate
    assert (percent.low, percent.high) == pytest.approx((100.0 + increase.low, 100.0 + increase.high))
    assert percent.dry_stops == increase.dry_stops == 4


def stops(name, values):
    of_all = dict.fromkeys(_DISTANCES, 500.0)
    return tuple(CountedStop(of_all | {name: value}, (), passed=True) for value in values)


@pytest.mark.parametrize("dry", [(0.0, 0.0), (-1.0, -2.0), (math.inf, 4.0), (math.nan, 4.0)])
def test_a_share_of_what_is_not_above_zero_is_none(dry):
    """A reservoir margin of -0.4 bar would be four times that of -0.1 bar, and pass a lower limit."""
    margins = (stops("reservoir_margin_bar", values) for values in (dry, (-4.0, 2.0)))
    value = SERIES_MEASURES["worst_reservoir_margin"].percent_of_dry([SpeedStops(30.0, *margins)], 0.95)
    assert value.unavailable_reason == "the dry stops have no such number above zero"


def test_k_wet_of_no_distance_is_none():
    def of(wet):
        distances = (stops("deceleration_distance_m", values) for values in ((400.0, 410.0), wet))
        return SERIES_MEASURES["k_wet"].of_speed(SpeedStops(30.0, *distances), 0.95)

    assert of((0.0, 0.0)).unavailable_reason == "the wet stops have no such number above zero"
    assert of((0.0, 810.0)).estimate.value == pytest.approx(1.0)

"""Every measure of a series: its declaration, and what it makes of stops."""

import pytest

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.series_measures import SERIES_MEASURES, CountedStop, SpeedStops
from uictest.core.units import KINDS


@pytest.mark.parametrize("name", SERIES_MEASURES)
def test_a_measure_has_a_unit_of_its_kind(name):
    measure = SERIES_MEASURES[name]
    kind = KINDS[measure.kind]
    assert measure.unit in kind.units or (kind.bare and measure.unit == "1")


@pytest.mark.parametrize("name", SERIES_MEASURES)
def test_a_measure_reads_columns_that_results_have(name):
    stop = CountedStop(
        dict.fromkeys(STOP_COLUMNS, 1.0), (dict.fromkeys(WHEELSET_COLUMNS, 1.0),) * 4, passed=True
    )
    value = SERIES_MEASURES[name].of_series([SpeedStops(30.0, (stop,), (stop,))], 0.95)
    assert value.estimate.stops == 1


def test_the_value_of_a_series_is_that_of_its_worst_speed_and_a_share_of_all_stops(make_speed, make_stop):
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


def test_no_measure_pools_stops_on_different_rails(make_stop):
    """On the cleaned rail 9 of 10 pass, from both speeds; on the other one 1 of 2: pooled it were 83 %."""
    kept, lost = make_stop(passed=True), make_stop(passed=False)
    speeds = [
        SpeedStops(20.0, (), (kept,) * 5, "cleaned"),
        SpeedStops(30.0, (), (kept,) * 4 + (lost,), "cleaned"),
        SpeedStops(30.0, (), (kept, lost), "uncleaned"),
    ]
    share = SERIES_MEASURES["passing_share"]
    value = share.of_series(speeds, 0.95).estimate
    assert (value.value, value.stops) == (50.0, 2)
    assert share.of_series(speeds[:2], 0.95).estimate.value == 90.0
    for measure in SERIES_MEASURES.values():
        assert all(len({each.rail for each in group}) == 1 for group in measure.groups(speeds))


def test_the_most_locked_wheelset_and_the_smallest_margin_speak_for_stops(make_stop):
    speed = SpeedStops(30.0, (), tuple(make_stop(locked=time) for time in (0.2, 3.0, 0.4)))
    median, worst = (
        SERIES_MEASURES[f"{name}_locked_time"].of_series([speed], 0.95).estimate
        for name in ("median", "worst")
    )
    assert (median.value, worst.value) == (0.4, 3.0)
    speed = SpeedStops(30.0, (), tuple(make_stop(reservoir_margin_bar=bar) for bar in (1.2, 0.4, 0.9)))
    worst = SERIES_MEASURES["worst_reservoir_margin"].of_series([speed], 0.95).estimate
    assert worst.value == 0.4
    stop = make_stop(deceleration_bogie_1_mps2=1.1, deceleration_bogie_2_mps2=0.9)
    value = SERIES_MEASURES["median_bogie_imbalance"].of_series([SpeedStops(30.0, (), (stop,))], 0.95)
    assert value.estimate.value == pytest.approx(20.0)


def test_a_stop_or_a_speed_without_the_number_leaves_the_measure_open(make_stop, make_speed):
    speed = SpeedStops(30.0, (), (make_stop(reservoir_margin_bar=1.0), make_stop()))
    value = SERIES_MEASURES["worst_reservoir_margin"].of_series([speed], 0.95)
    assert value.estimate is None
    assert value.unavailable_reason == "1 of 2 wet stops have no such number"
    speeds = [make_speed([460.0], [480.0]), make_speed([], [230.0])]
    assert SERIES_MEASURES["k_wet"].of_series(speeds, 0.95).estimate is None


def test_a_relation_to_the_dry_stop_is_made_speed_by_speed_of_figures_of_single_stops(make_speed):
    # 240 m from the lower speed is 120 % of its dry stop, though far below the dry stop from the higher one.
    speeds = [make_speed([198.0, 202.0], [240.0]), make_speed([460.0], [506.0])]
    relation = SERIES_MEASURES["worst_braking_distance"].percent_of_dry(speeds, 0.95).estimate
    assert relation.value == pytest.approx(120.0)
    with pytest.raises(ValueError, match="passing_share"):
        SERIES_MEASURES["passing_share"].percent_of_dry([make_speed([1.0], [1.0])], 0.95)

"""Groups of stops with known truth: means, outliers, K_wet."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

import uictest
from tests.service_log import logs
from uictest.analysis.logged_stops.stop_groups import LoggedStop, dry_table, outliers_of, references
from uictest.analysis.logged_stops.wet_stops import extensions, series_table, wet_series
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS

KMH = 1.0 / 3.6
CASE, *_ = uictest.load(logs.SCENARIO)


def stop(number, speed, distance, *, dry=True):
    measures = {"braking_distance_m": distance}
    result = CaseResult(f"stop-{number:04d}", "s.yaml", {}, PASS, "pass", measures=measures)
    return LoggedStop(result, speed, dry, CASE)


def distances(deceleration, speeds):
    return [(speed * KMH) ** 2 / (2.0 * deceleration) for speed in speeds]


@given(st.lists(st.floats(117.1, 122.9), min_size=2, max_size=10), st.floats(0.5, 1.5))
def test_stops_of_one_deceleration_have_one_distance(speeds, deceleration):
    stops = [
        stop(k, *pair) for k, pair in enumerate(zip(speeds, distances(deceleration, speeds), strict=True))
    ]
    (row,) = dry_table(stops).table.rows
    assert row["mean_m"] == pytest.approx((120.0 * KMH) ** 2 / (2.0 * deceleration), rel=1e-9)
    assert row["deviation_percent"] == pytest.approx(0.0, abs=1e-5)


def test_speeds_between_two_groups_are_in_none():
    assert stop(1, 115.0, 400.0).nominal is None
    assert [
        row["speed_kmh"] for row in dry_table([stop(1, 115.0, 400.0), stop(2, 82.0, 200.0)]).table.rows
    ] == [80.0]


@pytest.mark.parametrize("factor", [0.8, 1.3])
def test_an_outlier_is_named_and_hides_no_other(factor):
    lengths = [500.0, 505.0, 495.0, 500.0 * factor, 502.0, 500.0 * factor * factor]
    group = [stop(k, 120.0, length) for k, length in enumerate(lengths)]
    assert set(outliers_of(group)) == {"stop-0003", "stop-0005"}


def test_of_two_stops_apart_neither_is_accepted():
    stops = [stop(1, 100.0, 398.6), stop(2, 100.0, 563.9)]
    (row,) = dry_table(stops).table.rows
    assert row["accepted"] == "0 of 2"
    assert references(stops) == {}


def test_an_outlier_is_no_reference_of_wet_stops():
    dry = [stop(k, 100.0, length) for k, length in enumerate((400.0, 396.0, 404.0, 667.0))]
    assert extensions([*dry, stop(9, 100.0, 500.0, dry=False)]) == pytest.approx({"stop-0009": 25.0})


@pytest.mark.parametrize("halves", [(400.0, 667.0), (667.0, 400.0)])
def test_of_dry_stops_that_fall_into_halves_none_is_a_reference(halves):
    lengths = [length * share for length in halves for share in (0.99, 1.0, 1.01)]
    group = [stop(k, 100.0, length) for k, length in enumerate(lengths)]
    assert set(outliers_of(group)) == {each.result.id for each in group}
    assert references(group) == {}


def test_mean_and_interval_of_dry_stops_are_those_of_the_reference():
    dry = [stop(k, 100.0, length) for k, length in enumerate((400.0, 396.0, 404.0, 667.0))]
    (row,) = dry_table(dry).table.rows
    assert row["mean_m"] == pytest.approx(400.0)
    assert row["high_m"] < 420.0
    assert (row["accepted"], row["stops"]) == ("3 of 4", "stop-0003")


@pytest.mark.parametrize("sign", ["valve_actuations", "locked_time_s"])
def test_a_dry_stop_with_a_wheelset_vented_or_locked_is_no_reference(sign):
    sliding = stop(1, 100.0, 400.0)
    sliding = replace(sliding, result=replace(sliding.result, wheelsets=({sign: 0.0}, {sign: 2.0})))
    rolling = stop(2, 100.0, 300.0)
    wet = stop(9, 100.0, 360.0, dry=False)
    assert extensions([sliding, rolling, wet]) == pytest.approx({"stop-0009": 20.0})
    assert extensions([sliding, wet]) == {}


def test_stops_within_15_percent_are_all_accepted():
    assert outliers_of([stop(k, 120.0, 500.0 * f) for k, f in enumerate((0.95, 1.0, 1.05, 0.97, 1.1))]) == []


def test_the_extension_is_that_over_the_dry_stops_of_the_same_speed():
    stops = [stop(1, 120.0, 500.0), stop(2, 80.0, 230.0), stop(3, 120.0, 600.0, dry=False)]
    assert extensions([*stops, stop(4, 100.0, 400.0, dry=False)]) == pytest.approx({"stop-0003": 20.0})


@pytest.fixture(name="k_wet", scope="module")
def _k_wet():
    """Return the row of K_wet of a log: normal draws of one scatter (%), from 78.5 to 81.5 km/h."""
    (dry,) = uictest.load(logs.SCENARIO, set={"rail": logs.DRY})
    (wet,) = uictest.load(logs.SCENARIO)

    def row(draw, dry_stops, wet_stops, scatter, ratio):
        stops = []
        for k in range(dry_stops + wet_stops):
            is_dry, speed = k < dry_stops, draw.uniform(78.5, 81.5)
            share = draw.normal(1.0, scatter / 100.0) * (1.0 if is_dry else ratio)
            length = share * 220.0 * (speed / 80.0) ** 2
            own = stop(k, speed, length, dry=is_dry)
            measures = dict(own.result.measures, deceleration_distance_m=length)
            result = replace(own.result, measures=measures)
            stops.append(replace(own, result=result, case=dry if is_dry else wet))
        return next(row for row in series_table(wet_series(stops)).table.rows if row["measure"] == "k_wet")

    return row


def held_by_logs(k_wet, dry, wet, scatter, count):
    draw = np.random.default_rng([dry, wet, scatter])
    rows = [k_wet(draw, dry, wet, scatter, 1.2) for _ in range(count)]
    known = [row for row in rows if row["low"] is not None]
    assert len(known) > 0.9 * count
    return np.mean([row["low"] <= 1.0 / 1.2 <= row["high"] for row in known])


def test_k_wet_of_a_log_has_an_interval_that_holds_it(k_wet):
    """Dry stops taken as known would hold it in every second log."""
    assert held_by_logs(k_wet, 3, 20, 3, 80) >= 0.94 - 3.0 * np.sqrt(0.94 * 0.06 / 80)


@pytest.mark.slow
@pytest.mark.parametrize("dry", [2, 3, 6, 10])
@pytest.mark.parametrize("scatter", [2, 4, 5])
def test_so_it_has_whatever_the_number_of_stops(k_wet, dry, scatter):
    for wet in (5, 12, 30):
        held = held_by_logs(k_wet, dry, wet, scatter, 300)
        assert held >= 0.94 - 3.0 * np.sqrt(0.94 * 0.06 / 300), (held, wet)


def test_k_wet_of_a_log_with_one_dry_stop_has_no_interval_and_says_why(k_wet):
    row = k_wet(np.random.default_rng(1), 1, 6, 3.0, 1.2)
    assert row["value"] == pytest.approx(1.0 / 1.2, rel=0.1)
    assert row["low"] is None
    assert row["remark"] == "no 95 % interval: one dry stop shows no scatter"

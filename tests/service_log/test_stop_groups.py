"""Groups of stops with known truth: means, outliers, K_wet, and the friction under noisy stops."""

import random
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, strategies as st
from pyarrow import parquet
from scipy.stats import binom

import uictest
from tests.service_log import logs
from uictest.analysis.logged_stops.stop_groups import (
    LoggedStop,
    dry_table,
    friction_of,
    outliers_of,
    references,
)
from uictest.analysis.logged_stops.wet_stops import extensions, series_table, wet_series
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS
from uictest.recorded import fitting
from uictest.recorded.field_data import load_map, stop_in
from uictest.recorded.service_log import find_stops, write_stops

KMH = 1.0 / 3.6
CASE, *_ = uictest.load(logs.SCENARIO)


def stop(number, speed, distance, *, dry=True):
    result = CaseResult(
        f"stop-{number:04d}", "s.yaml", {}, PASS, "pass", measures={"braking_distance_m": distance}
    )
    return LoggedStop(result, speed, dry, CASE)


def group_of(speed, lengths):
    return [stop(k, speed, length) for k, length in enumerate(lengths)]


@given(st.lists(st.floats(117.1, 122.9), min_size=2, max_size=10), st.floats(0.5, 1.5))
def test_stops_of_one_deceleration_have_one_distance(speeds, deceleration):
    stops = [stop(k, speed, (speed * KMH) ** 2 / (2.0 * deceleration)) for k, speed in enumerate(speeds)]
    (row,) = dry_table(stops).table.rows
    assert row["mean_m"] == pytest.approx((120.0 * KMH) ** 2 / (2.0 * deceleration), rel=1e-9)
    assert row["deviation_percent"] == pytest.approx(0.0, abs=1e-5)


def test_speeds_between_two_groups_are_in_none():
    assert [stop(1, speed, 400.0).nominal for speed in (115.0, 117.0, 123.0, 123.1)] == [
        *(None, 120.0, 120.0, None)
    ]
    (row,) = dry_table([stop(1, 115.0, 400.0), stop(2, 82.0, 200.0)]).table.rows
    assert (row["speed_kmh"], row["accepted"]) == (80.0, "one stop alone")


@pytest.mark.parametrize(
    ("lengths", "outliers"),
    [
        ([475.0, 500.0, 525.0, 485.0, 550.0], []),  # within 15 %
        ([500.0, 505.0, 495.0, 400.0, 502.0, 320.0], [3, 5]),
        ([500.0, 505.0, 495.0, 650.0, 502.0, 845.0], [3, 5]),
        ([396.0, 400.0, 404.0, 660.0, 667.0, 674.0], [0, 1, 2, 3, 4, 5]),
        ([660.0, 667.0, 674.0, 396.0, 400.0, 404.0], [0, 1, 2, 3, 4, 5]),
        ([398.6, 563.9], [0, 1]),
    ],
)
def test_an_outlier_is_named_and_hides_no_other_and_of_stops_in_halves_none_is_accepted(lengths, outliers):
    group = group_of(120.0, lengths)
    assert set(outliers_of(group)) == {f"stop-{k:04d}" for k in outliers}
    (row,) = dry_table(group).table.rows
    assert row["accepted"] == f"{len(lengths) - len(outliers)} of {len(lengths)}"
    assert (references(group) == {}) == (len(outliers) == len(lengths))


def test_an_outlier_is_in_neither_the_mean_nor_the_reference_of_wet_stops():
    dry = group_of(100.0, (400.0, 396.0, 404.0, 667.0))
    assert extensions([*dry, stop(9, 100.0, 500.0, dry=False)]) == pytest.approx({"stop-0009": 25.0})
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


MAP = load_map("uictest")[0]
EVERY = 2
"""Of the samples of a log 100 times a second: 50 Hz."""
FORCES = {"forces": (), "speeds alone": ("clamping_force",)}
"""What is not recorded."""


def conditions(seed, count):
    draw = random.Random(seed)
    return [
        (round(draw.uniform(0.05, 0.13), 3), draw.uniform(60.0, 120.0), draw.randrange(10**6))
        for _ in range(count)
    ]


def found_stops(stops, folder, noise, without):
    """Write a log of 50 Hz with white noise on all speeds, m/s, and return the stops that are found in it."""
    table = parquet.read_table(logs.write_log(stops, folder / "log.parquet"))
    dice, names = (
        np.random.default_rng(len(stops)),
        [n for n in table.schema.names if not n.startswith(without)],
    )
    columns = {name: table[name].to_numpy()[::EVERY] for name in names}
    for name in ("speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4))):
        columns[name] = columns[name] + dice.normal(0.0, noise, len(columns[name]))
    schema = pa.schema([table.schema.field(name) for name in names])
    parquet.write_table(pa.table(list(columns.values()), schema=schema), folder / "log.parquet")
    log = find_stops([folder / "log.parquet"], MAP)
    return [stop_in(path, MAP) for path in write_stops(log, MAP, folder / "stops")]


@pytest.fixture(scope="module")
def simulated():
    """Return simulated stops of known friction, each once."""
    kept = {}

    def make(rails):
        for rail in rails:
            kept.setdefault(rail, logs.simulated(logs.wet(rail[0]), *rail[1:]))
        return [kept[rail] for rail in rails]

    return make


def scenario():
    case, *_ = uictest.load(logs.SCENARIO, set={"rail": {"condition": "wet"}, "criteria": "uictest-stop"})
    return case.scenario


def study(simulated, folder, rails, noise, without):
    """Return the errors and half widths of `log` as shares of the friction; those of `fit` are the same."""
    stops = found_stops(simulated(rails), folder, noise, without or ("-",))
    errors, widths = [], []
    for (friction, *_), stop in zip(rails, stops, strict=True):
        seen = friction_of(stop, scenario())
        assert seen.standing == "found", seen.remark
        [estimate] = fitting.fit_stop(stop, scenario()).friction
        assert (estimate.value, estimate.half_width) == (seen.value, seen.half_width)
        errors.append(seen.value / friction - 1.0)
        widths.append(seen.half_width / friction)
    return np.array(errors), np.array(widths)


@pytest.mark.parametrize(("lacking", "largest"), [("forces", 0.002), ("speeds alone", 0.03)])
def test_ordinary_noise_hides_no_friction(simulated, tmp_path, lacking, largest):
    errors, widths = study(simulated, tmp_path, conditions(41, 4), 0.02, FORCES[lacking])
    assert np.abs(errors).max() < largest
    assert (np.abs(errors) < 2.0 * widths).all()
    assert widths.max() < largest


@pytest.mark.slow
@pytest.mark.parametrize("lacking", FORCES)
@pytest.mark.parametrize("noise", [0.004, 0.02, 0.05])
def test_intervals_hold_the_truth_as_often_as_they_say(simulated, tmp_path, noise, lacking):
    """At least so many of 51 that 95 % of all are not refuted at 0.1 %, and none of them for nothing."""
    errors, widths = study(simulated, tmp_path, conditions(42, 51), noise, FORCES[lacking])
    held = int((np.abs(errors) <= widths).sum())
    assert held >= binom.ppf(0.001, len(errors), 0.95)
    assert widths.max() < (0.002 if lacking == "forces" else 0.1)


@pytest.mark.parametrize("lacking", FORCES)
def test_noise_does_not_pass_for_one_friction(tmp_path, lacking):
    """A rail that sliding cleans is still told at ordinary noise."""
    stop = logs.simulated(logs.wet(0.06, "wet-cleaning"), 100.0, 5)
    [recorded] = found_stops([stop], tmp_path, 0.02, FORCES[lacking] or ("-",))
    assert friction_of(recorded, scenario()).standing == "not one"


def test_noise_that_may_hide_a_variation_is_told(tmp_path):
    [recorded] = found_stops([logs.simulated(logs.wet(0.06), 80.0, 5)], tmp_path, 0.1, ("clamping_force",))
    seen = friction_of(recorded, scenario())
    assert seen.standing == "found"
    assert "noise may hide that it varies" in seen.remark

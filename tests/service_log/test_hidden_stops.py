"""Stops hidden in the record of a day: all are found, and none is invented."""

import numpy as np
import pytest

from tests.service_log import days
from tests.service_log.test_found_stops import written
from uictest.recorded.field_data import load_map, stop_in
from uictest.recorded.service_log import find_stops, write_stops

MAP = load_map("uictest")[0]
LATE = 1.0
"""s after the command in which the pressure shows it at the latest; chosen."""


def assert_found(log, brakings, rate):
    for events, expected in (
        (log.stops, [each for each in brakings if not each.reason]),
        (log.passed_over, [each for each in brakings if each.reason]),
    ):
        rows = [event.row for event in events]
        assert len(rows) == len(expected), compared(events, expected, rate)
        for event, braking in zip(events, expected, strict=True):
            assert 0 <= event.row - braking.row <= LATE * rate, (event, braking)
            assert braking.reason in event.reason, (event, braking)


def compared(events, expected, rate):
    """Say which are missing, and which were invented."""
    rows, truth = np.array([each.row for each in events]), np.array([each.row for each in expected])
    invented = [event for event in events if not np.any(np.abs(truth - event.row) <= LATE * rate)]
    missing = [each for each in expected if not np.any(np.abs(rows - each.row) <= LATE * rate)]
    return f"missing: {missing}\ninvented: {invented}"


@pytest.mark.parametrize("seed", range(4))
def test_all_stops_of_a_morning_are_found_and_none_invented(tmp_path, seed):
    columns, brakings = days.recorded(days.scenes(seed, 20, 20))
    log = find_stops([written(columns, tmp_path / "log.parquet")], MAP)
    assert_found(log, brakings, 20)
    stops = [each for each in brakings if not each.reason]
    files = write_stops(log, MAP, tmp_path / "stops")
    for braking, path in zip(stops, files, strict=True):
        if braking.clean:
            assert stop_in(path, MAP).standstill[1] == pytest.approx(braking.distance, rel=0.01, abs=2.0)


@pytest.mark.parametrize("suffix", ["csv", "mf4", "tdms"])
def test_every_format_shows_them(tmp_path, suffix):
    columns, brakings = days.recorded(days.scenes(9, 5, 10))
    assert_found(find_stops([written(columns, tmp_path / f"log.{suffix}")], MAP), brakings, 10)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["csv", "parquet", "mf4", "tdms"])
def test_200_stops_of_a_day_at_100_hz_are_found_and_none_invented(tmp_path, suffix):
    columns, brakings = days.recorded(days.scenes(1, 200, 100, hours=24.0))
    assert len(columns["time"]) > 20 * 3600 * 100
    log = find_stops([written(columns, tmp_path / f"log.{suffix}")], MAP)
    assert len(log.stops) == 200
    assert_found(log, brakings, 100)

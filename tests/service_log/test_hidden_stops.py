"""Stops hidden in the record of a day: all are found wherever its pieces begin, and none is invented."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests.service_log import days
from tests.service_log.test_found_stops import written
from uictest.recorded.field_data import load_map, stop_in
from uictest.recorded.service_log import find_stops, stops, write_stops
from uictest.recorded.service_log.signals import Rows

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


STEP = 0.1


def random_rows(seed):
    """Return rows at random: speeds and brake know nothing of each other, and defects may lie anywhere."""
    draw = np.random.default_rng(seed)
    rows = int(draw.integers(2000, 9000))
    time = STEP * np.arange(rows)
    knots = np.concatenate(([0.0], np.sort(draw.uniform(0.0, time[-1], draw.integers(5, 40))), time[-1:]))
    speeds = np.where(draw.random(len(knots)) < 0.35, 0.0, draw.uniform(0.0, 40.0, len(knots)))
    speed = np.interp(time, knots, speeds)
    wheels = speed + draw.normal(0.0, 0.02, rows)
    train = speed + draw.normal(0.0, 0.02, rows) * (speed != 0.0)
    braked, begin = np.zeros(rows), 0
    while begin < rows:
        begin += 1 + int(draw.exponential(draw.choice([3, 30, 300])))
        end = begin + 1 + int(draw.exponential(draw.choice([0.5, 30, 300, 3000])))
        braked[begin:end], begin = 1.0, end
    kept = np.ones(rows, dtype=np.bool_)
    for _ in range(draw.integers(0, 6)):
        first = int(draw.integers(0, rows))
        part = slice(first, first + 1 + int(draw.exponential(400)))
        defect = draw.integers(7)
        if defect < 3:
            train[part] = (np.nan, 0.0, train[first])[defect]
        elif defect == 3:
            wheels[part] = np.nan
        elif defect == 4:
            time[first:] += draw.choice([-500.0, 4000.0, -0.05, 70.0, 3.0, 1e6])
        elif defect == 5:
            braked[part] = np.nan
        else:
            kept[part] = False
    return Rows(time[kept], train[kept], wheels[kept], braked[kept])


def found(rows, cuts):
    """Return the events of rows that come in pieces, as texts, and how many rows were held at most."""
    search, held, events = stops._Finder(stops.FinderSettings(), 1.0 / 3.6), [0], []
    search.begin(Path("log"))
    for begin, end in zip([0, *cuts], [*cuts, len(rows.time)], strict=True):
        events += search.add(Rows(*(samples[begin:end] for samples in rows)))
        held.append(len(search._held.time))
    return [repr(event) for event in (*events, *search.rest())], max(held)


@pytest.mark.parametrize("longest", [120.0, 3600.0])
@given(st.integers(0, 10**6), st.integers(20, 1500))
def test_pieces_of_any_length_give_the_same_events(longest, seed, length):
    rows = random_rows(seed)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stops._Finder, "LONGEST", longest)
        cuts = range(length, len(rows.time), length)
        assert found(rows, cuts)[0] == found(rows, [])[0]


def test_a_brake_signal_that_is_stuck_is_said_and_does_not_fill_the_memory():
    """Two hours of running; then the train stops, its signal is mended, and it stops and goes on."""
    running = np.full(round(7200.0 / STEP), 30.0)
    stop = np.concatenate((np.linspace(30.0, 0.0, 300), np.zeros(300), np.linspace(0.0, 30.0, 300)))
    speed = np.concatenate((running, stop, running[:600], stop))
    braked = np.ones(len(speed))
    braked[-1500:-900] = 0.0
    rows = Rows(STEP * np.arange(len(speed)), speed, np.full(len(speed), np.nan), braked)
    events, held = found(rows, range(500, len(speed), 500))
    assert len(events) == 3
    assert "longer than 60 min without standstill: the brake signal may be stuck" in events[0]
    assert "reason=''" in events[1]
    assert "runs again with the brake still applied" in events[2]
    assert held < 3700.0 / STEP


def test_a_stuck_signal_is_gone_through_once_and_short_applications_do_not_fill_the_memory(monkeypatch):
    seen = []

    class Counted(stops.Course):
        def __init__(self, rows, *others):
            seen.append(len(rows.time))
            super().__init__(rows, *others)

    rows = 50_000
    time, running = STEP * np.arange(rows), np.full(rows, 30.0)
    events, held = found(
        Rows(time, running, running, 1.0 * (np.arange(rows) % 50 < 20)), range(200, rows, 200)
    )
    assert len(events) == rows // 50
    assert held < 700
    monkeypatch.setattr(stops, "Course", Counted)
    found(Rows(time, running, running, np.ones(rows)), range(100, rows, 100))
    assert sum(seen) < 6 * rows

"""A log put together of pieces of known kind: every stop is found, and none is invented."""

import json
import re

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, settings, strategies as st
from pyarrow import csv, parquet

from uictest.cli.entry import execute
from uictest.core.recording.formats import UnreadableError
from uictest.recorded.field_data import MapError, load_map, stop_in
from uictest.recorded.service_log import find_stops, write_stops

STEP = 0.1
MAP = load_map("uictest")[0]


def ramp(begin, end, seconds):
    return np.linspace(begin, end, round(seconds / STEP), endpoint=False)


def application(speed, end, seconds):
    """Return 10 s of running, then a braked ramp, then 10 s at its end with the brake released."""
    course = np.concatenate((np.full(100, speed), ramp(speed, end, seconds), np.full(100, end)))
    return course, np.concatenate((np.zeros(100), np.ones(round(seconds / STEP)), np.zeros(len(course))))[
        : len(course)
    ]


def backwards():
    speed, brake = application(15.0, 0.0, 15.0)
    return -speed, brake


PIECES = {
    "stop": lambda: application(30.0, 0.0, 30.0),
    "backwards": backwards,
    "shunting": lambda: application(4.0, 0.0, 4.0),
    "released": lambda: application(30.0, 12.0, 18.0),
    "drag": lambda: application(20.0, 20.0, 60.0),
    "parked": lambda: application(0.0, 0.0, 30.0),
}
REASONS = {"shunting": "below", "released": "released at", "drag": "drag", "parked": "without motion"}


def table(kinds, seed=0):
    courses = [PIECES[kind]() for kind in kinds]
    speed, brake = (np.concatenate(column) for column in zip(*courses, strict=True))
    noise = np.random.default_rng(seed).normal(0.0, 0.02, len(speed)) * (speed != 0.0)
    columns = {"time": STEP * np.arange(len(speed)), "speed": speed + noise, "brake_command": brake}
    return columns | {f"wheel_speed_{n}": speed + noise for n in (1, 2, 3, 4)}


UNITS = {"time": "s", "brake_command": "1"}


def written(columns, path):
    names = [f"{name} [{UNITS.get(name, 'm/s')}]" for name in columns]
    if path.suffix == ".csv":
        csv.write_csv(pa.table(list(columns.values()), names=names), path)
        return path
    fields = [pa.field(name, pa.float64(), metadata={"unit": UNITS.get(name, "m/s")}) for name in columns]
    parquet.write_table(pa.table(list(columns.values()), schema=pa.schema(fields)), path)
    return path


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(sorted(PIECES)), min_size=1, max_size=12), st.integers(0, 99))
def test_every_stop_is_found_and_none_invented(tmp_path_factory, kinds, seed):
    path = written(table(kinds, seed), tmp_path_factory.mktemp("log") / "log.parquet")
    log = find_stops([path], MAP)
    assert len(log.stops) == kinds.count("stop") + kinds.count("backwards")
    expected = [REASONS[kind] for kind in kinds if kind in REASONS]
    assert len(log.passed_over) == len(expected)
    assert all(text in event.reason for text, event in zip(expected, log.passed_over, strict=True))


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_both_formats_give_the_same_places(tmp_path, suffix):
    log = find_stops([written(table(["stop", "drag", "stop"]), tmp_path / f"log.{suffix}")], MAP)
    assert [event.row for event in log.stops] == [100, 500 + 800 + 100]
    assert [event.time for event in log.stops] == pytest.approx([10.0, 140.0])
    assert log.stops[0].distance == pytest.approx(300.0, rel=0.01)


@pytest.mark.parametrize("step", [-500.0, 4000.0])
def test_a_step_of_the_clock_within_a_stop_hides_it_not(tmp_path, step):
    columns = table(["stop", "stop"])
    columns["time"][200:] += step
    log = find_stops([written(columns, tmp_path / "log.parquet")], MAP)
    assert len(log.stops) == 2
    assert "the clock steps" in log.stops[0].remarks[0]


def test_an_interruption_while_braking_is_no_stop(tmp_path):
    columns = {name: np.delete(samples, slice(200, 420)) for name, samples in table(["stop"]).items()}
    columns["time"][200:] += 3600.0
    log = find_stops([written(columns, tmp_path / "log.parquet")], MAP)
    assert not log.stops
    assert "interrupted" in log.passed_over[0].reason


@pytest.mark.parametrize("dead", [np.nan, 0.0, 30.0])
def test_a_dead_train_speed_hides_no_stop(tmp_path, dead):
    columns = table(["stop", "stop"])
    columns["speed"][150:] = dead
    assert len(find_stops([written(columns, tmp_path / "log.parquet")], MAP).stops) == 2


def test_files_are_one_log_and_a_stop_may_lie_in_two(tmp_path):
    columns = table(["stop", "released", "stop"])
    cut = 250
    parts = [{k: v[:cut] for k, v in columns.items()}, {k: v[cut:] for k, v in columns.items()}]
    paths = [written(part, tmp_path / f"{k}.parquet") for k, part in enumerate(parts)]
    log = find_stops(paths, MAP)
    assert [event.file for event in log.stops] == paths
    first = write_stops(log, MAP, tmp_path / "stops")[0]
    assert stop_in(first, MAP).standstill == pytest.approx((30.0, 450.0), rel=0.02)


def test_a_stop_running_backwards_is_exported_with_positive_speed(tmp_path):
    log = find_stops([written(table(["backwards"]), tmp_path / "log.parquet")], MAP)
    assert stop_in(write_stops(log, MAP, tmp_path / "stops")[0], MAP).recording["speed"][0] > 14.0


def test_what_cannot_be_read_is_said_with_its_file(tmp_path):
    columns = table(["stop"])
    del columns["brake_command"]
    with pytest.raises(MapError, match=r"log\.csv: nothing shows when the brake"):
        find_stops([written(columns, tmp_path / "log.csv")], MAP)
    (tmp_path / "bad.csv").write_text("time [s],speed [m/s]\n1,2\n3,x\n", "utf-8")
    with pytest.raises((MapError, UnreadableError), match=r"bad\.csv: "):
        find_stops([tmp_path / "bad.csv"], MAP)


def test_the_command_judges_each_stop_and_lists_the_rest(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    written(table(["stop", "drag", "stop"]), tmp_path / "day.csv")
    conditions = ("rail.condition=dry", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop")
    stated = [word for condition in conditions for word in ("--set", condition)]
    code = execute(["log", "day.csv", "--recordings", "stops", *stated])
    shown = capsys.readouterr()
    assert code in (0, 1)
    assert re.search(r"passed over: day.csv at 60 s \(sample 601, \d+ m\): drag", shown.err)
    rows = (tmp_path / "reports/latest/stops.csv").read_text("utf-8").splitlines()
    assert [row.partition(",")[0] for row in rows] == ["stop", "stop-0001", "stop-0002", ""]
    results = json.loads((tmp_path / "reports/latest/results.json").read_text("utf-8"))
    assert [case["id"] for case in results["cases"]] == ["stop-0001", "stop-0002"]
    assert execute(["evaluate", "stops/stop-0001.parquet", *stated]) == code

"""Sensors that contradict each other, clocks that cannot be right, files with the same rows."""

import os

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

from tests.service_log.test_found_stops import MAP, STATED, STEP, UNITS, table, written
from tests.service_log.test_odd_logs import KINDS, PLACES, found
from uictest.cli.entry import execute
from uictest.core.recording.formats import UnreadableError, tdms
from uictest.recorded import service_log
from uictest.recorded.field_data import MapError, UnusableError, stop_in
from uictest.recorded.service_log import find_stops, write_stops

BEGIN = 1.75e9


def braking(speed, end=0.0):
    """Return 10 s at a speed, and 30 s down to another one with the brake applied, then released."""
    course = np.concatenate((np.full(100, speed), np.linspace(speed, end, 300), np.full(200, end)))
    noise = np.random.default_rng(1).normal(0.0, 0.01, len(course)) * (course != 0.0)
    brake = np.concatenate((np.zeros(100), np.ones(400), np.zeros(100)))
    return {"time": STEP * np.arange(600), "speed": course + noise, "brake_command": brake}


@pytest.mark.parametrize(("speed", "noise"), [(100.0 / 3.6, 0.0), (655.35 / 3.6, 0.0), (11.0, 0.3)])
def test_two_wheel_sensors_that_show_one_number_or_noise_hide_no_stop(tmp_path, speed, noise):
    columns, draw = table(KINDS), np.random.default_rng(3)
    columns |= {f"wheel_speed_{n}": speed + draw.normal(0.0, noise, len(columns["time"])) for n in (3, 4)}
    assert found(columns, tmp_path / "log.parquet")[1] == PLACES


def test_wheels_that_spin_make_no_stop_of_a_slow_train(tmp_path):
    columns = braking(14.0 / 3.6)
    columns |= {f"wheel_speed_{n}": np.where(columns["speed"] > 3.0, 12.5, 0.0) for n in (1, 2, 3, 4)}
    _, places, reasons = found(columns, tmp_path / "log.parquet")
    assert places == []
    assert reasons[0].startswith("from 14.")


def test_a_speed_that_is_zero_infinite_or_lost_for_a_while_ends_no_stop(tmp_path):
    path, columns = tmp_path / "log.parquet", braking(30.0)
    columns["speed"][180:190], columns["speed"][190:210] = np.nan, 0.0
    log, places, _ = found(columns, path)
    assert places == [100]
    assert log.stops[0].rows[1] > 400, "standstill, not the zeros"
    columns = braking(30.0)
    columns["speed"][50] = np.inf
    assert found(columns, path)[0].stops[0].distance == pytest.approx(300.0, rel=0.02)
    for lost in (0.0, np.nan):
        columns = braking(30.0)
        columns["speed"][columns["speed"] < 5.0] = lost
        (reason,) = found(columns, path)[2]
        assert reason.startswith("the speed is lost at 18.")
    columns = braking(30.0)
    columns |= {f"wheel_speed_{n}": columns["speed"].copy() for n in (1, 2, 3, 4)}
    columns["speed"][200:] = 0.0
    (stop,) = found(columns, path)[0].stops
    assert stop.end_speed < 1.0
    assert stop.rows[1] == pytest.approx(400 + 30, abs=5)


def test_a_gap_within_a_stop_and_a_brake_signal_that_ends_are_told(tmp_path):
    path, columns = tmp_path / "log.parquet", braking(30.0)
    columns["time"][250:] += 20.0
    assert "not recorded for 20.1 s" in found(columns, path)[0].stops[0].remarks
    first, second = braking(30.0), braking(20.0)
    columns = {name: np.concatenate((first[name], second[name])) for name in first}
    columns["time"] = STEP * np.arange(1200)
    columns["brake_command"][450:] = np.nan
    assert found(columns, path)[1:] == ([100], ["the brake signal is missing"])


def test_a_pulse_before_the_brake_begins_no_stop_and_a_speed_in_every_tenth_row_is_known(tmp_path):
    path, columns = tmp_path / "log.parquet", {name: np.repeat(v, 10) for name, v in braking(30.0).items()}
    columns["time"] = 0.1 * STEP * np.arange(6000)
    pulsed = columns | {"brake_command": columns["brake_command"].copy()}
    pulsed["brake_command"][750] = 1.0
    (quiet,), (noisy,) = (found(each, path)[0].stops for each in (columns, pulsed))
    assert noisy == quiet
    columns["speed"][np.arange(6000) % 10 != 0] = np.nan
    assert found(columns, path)[0].stops[0].speed == pytest.approx(30.0, abs=0.05)


@pytest.mark.parametrize(("digits", "share"), [(0, "9[09]"), (1, "9[09]"), (None, "100")])
def test_a_clock_too_coarse_for_its_rows_or_without_a_time_is_refused(tmp_path, digits, share):
    columns = braking(30.0)
    columns["time"] = (
        np.full(600, np.nan) if digits is None else np.floor(0.01 * np.arange(600) * 10**digits) / 10**digits
    )
    with pytest.raises(UnreadableError, match=rf"repeats its time, or shows none, in {share} %"):
        found(columns, tmp_path / "log.parquet")


@pytest.mark.parametrize("suffix", [" AM", " CET", ":00"])
def test_dates_that_cannot_be_read_are_told(tmp_path, suffix):
    columns = braking(30.0)
    names = ["time", *(f"{name} [{UNITS.get(name, 'm/s')}]" for name in columns if name != "time")]
    time = pa.array([f"2026-05-31 11:58:{k // 10 % 60:02d}.{k % 10}{suffix}" for k in range(600)])
    pa.csv.write_csv(pa.table([time, *list(columns.values())[1:]], names=names), tmp_path / "log.csv")
    with pytest.raises(MapError, match=r"time: 'time': '2026-05-31 11:58:00\.0.*csv: \{dates: "):
        find_stops([tmp_path / "log.csv"], MAP)


def test_files_with_dates_are_read_in_their_order_and_a_copy_or_an_overlap_is_refused(tmp_path):
    columns = table(KINDS)
    columns["time"] += BEGIN

    def parts(*rows):
        return [
            written({k: v[part] for k, v in columns.items()}, tmp_path / f"{n}.parquet")
            for n, part in enumerate(rows)
        ]

    late, early = parts(slice(1500, None), slice(0, 1500))
    log = find_stops([late, early], MAP)
    assert [(event.file, event.row) for event in log.stops] == [(early, place) for place in PLACES]
    (tmp_path / "other.parquet").symlink_to(late)
    with pytest.raises(UnreadableError, match=r"other\.parquet: named twice, or a copy of .*0\.parquet"):
        find_stops([late, tmp_path / "other.parquet"], MAP)
    with pytest.raises(UnreadableError, match="begins 32 s before"):
        find_stops(parts(slice(0, 500), slice(180, None)), MAP)


def test_a_default_date_overlaps_nothing_and_a_log_that_grows_meanwhile_is_told(tmp_path):
    first, second = braking(30.0), braking(20.0)
    first["time"] += BEGIN
    second["time"] += BEGIN + 100.0
    second["time"][:5] = 9.8e8 + STEP * np.arange(5)
    files = [written(each, tmp_path / f"{n}.parquet") for n, each in enumerate((first, second))]
    log = find_stops(files, MAP)
    assert [event.file for event in log.stops] == files
    written({name: np.tile(samples, 2) for name, samples in first.items()}, files[0])
    with pytest.raises(UnreadableError, match=r"0\.parquet: has changed"):
        write_stops(log, MAP, tmp_path / "stops")


def test_pole_wheels_have_no_sign_and_a_clock_put_forward_within_a_stop_makes_it_an_error(tmp_path):
    columns = braking(30.0)
    columns |= {f"wheel_speed_{n}": np.abs(columns["speed"]) for n in (1, 2, 3, 4)}
    columns["speed"] = -columns["speed"]
    (path,) = write_stops(found(columns, tmp_path / "log.parquet")[0], MAP, tmp_path / "stops")
    stop = stop_in(path, MAP).recording
    assert np.median(stop["speed"]) == pytest.approx(np.median(stop["wheel_speed_1"]))
    assert np.median(stop["speed"]) > 0.0
    columns = braking(30.0)
    columns["time"][250:] += 28_800.0
    (path,) = write_stops(found(columns, tmp_path / "log.parquet")[0], MAP, tmp_path / "stops")
    with pytest.raises(UnusableError, match=r"speed is not recorded from 24\.9 to 28825 s"):
        stop_in(path, MAP)


def test_waveforms_of_devices_that_start_apart_lie_where_they_began(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    start = np.datetime64("2026-05-31T12:00:00", "us")
    objects = [
        nptdms.ChannelObject(
            "g",
            name,
            np.arange(100.0),
            {"wf_increment": 0.1, "wf_start_time": start + np.timedelta64(late, "s")},
        )
        for name, late in (("speed", 0), ("brake_line_pressure", 3))
    ]
    with nptdms.TdmsWriter(tmp_path / "log.tdms") as writer:
        writer.write_segment(objects)
    (piece,) = tdms.pieces(tmp_path / "log.tdms", None, ("speed",), 1000)
    assert [group.time[0] for group in piece.groups] == pytest.approx([0.0, 3.0])


def test_a_brake_command_without_a_value_is_not_recorded(tmp_path):
    columns = braking(30.0)
    columns |= {f"cylinder_pressure_{n}": 3e5 * columns["brake_command"] for n in (1, 2, 3, 4)}
    columns["brake_command"] = np.full(600, np.nan)
    assert found(columns, tmp_path / "log.parquet")[1] == [100]


def test_a_pipe_a_name_of_two_columns_and_a_name_that_is_not_utf8_are_refused(tmp_path):
    pipe, twice, latin = (tmp_path / name for name in ("log.csv", "log.parquet", os.fsdecode(b"b\xff.csv")))
    os.mkfifo(pipe)
    columns = braking(30.0)
    names = [*columns, "speed"]
    samples = pa.Table.from_arrays([pa.array(columns[name]) for name in names], names=names)
    parquet.write_table(samples, twice)
    latin.write_text("time [s],speed [m/s],brake_command\n0,1,0\n1,1,0\n")
    refusals = {pipe: r"log\.csv: not a file", twice: "2 columns have the name 'speed'"}
    for path, reason in (refusals | {latin: "the name of the file is not UTF-8"}).items():
        with pytest.raises(UnreadableError, match=reason):
            find_stops([path], MAP)


def test_stops_that_another_run_replaced_are_not_judged(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    written(braking(30.0), tmp_path / "fast.parquet")
    written(braking(15.0), tmp_path / "slow.parquet")
    write = service_log.write_stops

    def overtaken(log, *others):
        own = write(log, *others)
        write(find_stops([tmp_path / "slow.parquet"], MAP), *others)
        return own

    monkeypatch.setattr(service_log, "write_stops", overtaken)
    assert execute(["log", "fast.parquet", *STATED]) == 4
    assert "stops: another log was written there" in capsys.readouterr().err
    assert not list(tmp_path.glob("reports/2*"))


def test_earlier_stops_stay_until_the_new_ones_stand_there(tmp_path, monkeypatch):
    log, *_ = found(braking(30.0), tmp_path / "log.parquet")
    write_stops(log, MAP, tmp_path / "stops")

    def interrupted(*_):
        assert stop_in(tmp_path / "stops" / "stop-0001.parquet", MAP)
        raise KeyboardInterrupt

    monkeypatch.setattr("uictest.core.files.run_folder.remove_contents", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_stops(log, MAP, tmp_path / "stops")
    assert stop_in(tmp_path / "stops" / "stop-0001.parquet", MAP)


def test_the_command_refuses_what_it_would_overwrite_and_wrong_statements(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    log = found(braking(30.0), tmp_path / "log.parquet")[0]
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "own.txt").write_text("mine")
    refusals = [
        (["log.parquet", "--set", "criteria=none-such"], "none-such"),
        (["log.parquet", "--recordings", "full"], "full: own.txt: uictest did not write it"),
        (["stops/stop-0001.parquet"], "lies in stops, which the stops replace"),
    ]
    for arguments, reason in refusals:
        if arguments[0].startswith("stops"):
            assert not (tmp_path / "stops").exists(), "nothing is read with a wrong statement"
            write_stops(log, MAP, tmp_path / "stops")
        assert execute(["log", arguments[0], *STATED, *arguments[1:]]) == 4
        assert reason in capsys.readouterr().err
    assert (tmp_path / "stops/stop-0001.parquet").is_file()
    (tmp_path / "sweep.yaml").write_text(
        "schema: uictest/scenario/1\nname: sweep\ntitle: Sweep\ninitial_speed: 108 km/h\n"
        "brake: {command: 100 %, position: R}\nrail: {condition: wet, friction: 0.1}\n"
        "criteria: [uictest-stop]\nmatrix: {rail.friction: [0.08, 0.1]}\n"
    )
    assert execute(["log", "log.parquet", "--scenario", "sweep.yaml", "-k", "friction=0.08"]) in (0, 1)


@pytest.mark.parametrize("locked", [(1, 2, 3, 4), (2, 3, 4)])
def test_a_train_speed_in_whole_kmh_is_not_stuck_while_wheelsets_lock(tmp_path, locked):
    """On ice a whole km/h lasts for 2.3 s at 0.12 m/s2, and in drag braking for any time."""
    kept = 0 if len(locked) == 4 else 300
    speed = np.concatenate((np.full(100 + kept, 8.0), np.linspace(8.0, 0.0, 667), np.zeros(200)))
    rows = np.arange(len(speed))
    columns = {
        "time": STEP * rows,
        "speed": np.round(3.6 * speed) / 3.6,
        "brake_command": 1.0 * (rows >= 100),
    }
    slid = slice(150, 350) if kept else slice(442, 482)
    for n in (1, 2, 3, 4):
        columns[f"wheel_speed_{n}"] = speed.copy()
        if n in locked:
            share = 1.3 * np.abs(np.linspace(-1.0, 1.0, slid.stop - slid.start)) - 0.3
            columns[f"wheel_speed_{n}"][slid] *= np.clip(share, 0.0, 1.0)
    log, places, _ = found(columns, tmp_path / "log.parquet")
    assert places == [100]
    assert log.stops[0].rows[1] > 100 + kept + 640

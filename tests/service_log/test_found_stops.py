"""A log put together of pieces of known kind: every stop is found, and none is invented."""

import json
import re
import signal
import sys
from pathlib import Path
from threading import Timer

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from pyarrow import csv, parquet

import uictest
from uictest.cli.entry import execute
from uictest.core import guarded_process
from uictest.core.guarded_process import GuardedProcess
from uictest.core.recording.formats import ReadingInterruptedError, UnreadableError, isolation, mdf, tdms
from uictest.recorded.field_data import MapError, load_map, stop_in
from uictest.recorded.service_log import find_stops, signals, stops, write_stops

STEP = 0.1
MAP = load_map("uictest")[0]


def application(speed, end, seconds):
    """Return 10 s of running, then a braked ramp, then 10 s at its end with the brake released."""
    rows = round(seconds / STEP)
    ramp = np.linspace(speed, end, rows, endpoint=False)
    course = np.concatenate((np.full(100, speed), ramp, np.full(100, end)))
    return course, np.concatenate((np.zeros(100), np.ones(rows), np.zeros(100)))


PIECES = {
    "stop": lambda: application(30.0, 0.0, 30.0),
    "backwards": lambda: tuple(
        sign * column for sign, column in zip((-1, 1), application(15.0, 0.0, 15.0), strict=True)
    ),
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


UNITS = {"time": "s", "distance": "m", "brake_command": "1"}
UNITS |= dict.fromkeys(("brake_line_pressure", "reservoir_pressure"), "Pa")
UNITS |= {f"cylinder_pressure_{n}": "Pa" for n in (1, 2, 3, 4)}
STATED = [
    word
    for condition in ("rail.condition=dry", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop")
    for word in ("--set", condition)
]


def written(columns, path):
    if path.suffix in (".mf4", ".mdf"):
        return written_mdf([columns], path)
    if path.suffix == ".tdms":
        return written_tdms([columns], path)
    names = [f"{name} [{UNITS.get(name, 'm/s')}]" for name in columns]
    if path.suffix == ".csv":
        csv.write_csv(pa.table(list(columns.values()), names=names), path)
        return path
    fields = [pa.field(name, pa.float64(), metadata={"unit": UNITS.get(name, "m/s")}) for name in columns]
    parquet.write_table(pa.table(list(columns.values()), schema=pa.schema(fields)), path)
    return path


def written_mdf(groups, path):
    """Write groups of columns, each over the time that it has: version 4, or 3 in `.mdf`."""
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="3.30" if path.suffix == ".mdf" else "4.10") as mdf:
        for columns in groups:
            time, *others = columns.items()
            signals = [asammdf.Signal(v, time[1], name=k, unit=UNITS.get(k, "m/s")) for k, v in others]
            mdf.append(signals, common_timebase=True)
        mdf.save(path, compression=0 if path.suffix == ".mdf" else 2)
    return path


def written_tdms(groups, path, rows=1000):
    """Write groups of columns in many segments; of several groups each states its raster."""
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(path) as writer:
        for number, columns in enumerate(groups):
            time = columns["time"]
            raster = {"wf_start_offset": float(time[0]), "wf_increment": float(time[1] - time[0])}
            for first in range(0, len(time), rows):
                objects = [
                    nptdms.ChannelObject(
                        f"g{number}",
                        name,
                        samples[first : first + rows],
                        {"unit_string": UNITS.get(name, "m/s")} | (raster if len(groups) > 1 else {}),
                    )
                    for name, samples in columns.items()
                    if name != "time" or len(groups) == 1
                ]
                writer.write_segment(objects)
    return path


@pytest.fixture(name="rolled", scope="module")
def _rolled():
    """A simulated stop with sliding wheels, at 100 Hz."""
    case, *_ = uictest.load(Path(__file__).parents[2] / "scenarios" / "slide-80.yaml")
    return uictest.simulate(case)


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.sampled_from(sorted(PIECES)), min_size=1, max_size=12), st.integers(0, 99))
def test_every_stop_is_found_and_none_invented_in_pieces_of_any_length(
    tmp_path_factory, monkeypatch, kinds, seed
):
    path = written(table(kinds, seed), tmp_path_factory.mktemp("log") / "log.parquet")
    log = find_stops([path], MAP)
    assert len(log.stops) == kinds.count("stop") + kinds.count("backwards")
    expected = [REASONS[kind] for kind in kinds if kind in REASONS]
    assert len(log.passed_over) == len(expected)
    assert all(text in event.reason for text, event in zip(expected, log.passed_over, strict=True))
    with monkeypatch.context() as patch:
        patch.setattr("uictest.core.recording.formats.pieces._ROWS", 130 + 7 * seed)
        in_pieces = find_stops([path], MAP)
    assert (in_pieces.stops, in_pieces.passed_over) == (log.stops, log.passed_over)


@pytest.fixture(name="small_pieces")
def _small_pieces(monkeypatch):
    """Pieces of a minute and a half, as if the logs of these tests were long."""
    monkeypatch.setattr("uictest.core.recording.formats.pieces._ROWS", 900)
    monkeypatch.setattr("uictest.core.recording.formats.pieces._BLOCK", 900 * 60)
    monkeypatch.setattr(mdf, "AT_ONCE", 900 * 60)
    monkeypatch.setattr(tdms, "AT_ONCE", 900)


@pytest.mark.parametrize("suffix", ["csv", "parquet", "mf4", "mdf", "tdms"])
def test_every_format_gives_the_same_places(tmp_path, request, small_pieces, suffix):
    if suffix in ("mf4", "tdms"):
        request.getfixturevalue("apart")
    log = find_stops([written(table(["stop", "drag", "stop"]), tmp_path / f"log.{suffix}")], MAP)
    assert [event.row for event in log.stops] == [100, 500 + 800 + 100]
    assert [event.time for event in log.stops] == pytest.approx([10.0, 140.0])
    assert log.stops[0].distance == pytest.approx(300.0, rel=0.01)
    columns = table(["stop", "drag", "stop"])
    for event, path in zip(log.stops, write_stops(log, MAP, tmp_path / "stops"), strict=True):
        stop = parquet.read_table(path)
        assert stop["wheel_speed_3"].to_numpy() == pytest.approx(columns["wheel_speed_3"][slice(*event.rows)])


def test_the_finder_holds_no_more_than_an_application(tmp_path, monkeypatch):
    """Nor more where the train then stands with its brake applied for long."""
    monkeypatch.setattr("uictest.core.recording.formats.pieces._ROWS", 50)
    held = []

    class Counted(stops.Course):
        def __init__(self, rows, *others):
            held.append(len(rows.time))
            super().__init__(rows, *others)

    monkeypatch.setattr(stops, "Course", Counted)
    columns = table(["stop", "drag"] * 10 + ["stop"])
    parked = {name: np.concatenate((v, np.full(8_000, v[-1]))) for name, v in columns.items()}
    parked["time"] = STEP * np.arange(len(parked["time"]))
    parked["brake_command"][-8_000 - 50 :] = 1.0
    log = find_stops([written(parked, tmp_path / "log.parquet")], MAP)
    assert len(log.stops) == 11
    assert log.passed_over[-1].reason == "without motion"
    assert max(held) < 1000


def test_a_long_text_is_not_read_far_ahead(tmp_path, monkeypatch):
    """Arrow has 32 blocks of text waiting, and what is decoded."""
    monkeypatch.setattr("uictest.core.recording.formats.pieces._BLOCK", 10_000)
    path = written(table(["stop", "drag"] * 20), tmp_path / "log.csv")
    before = pa.total_allocated_bytes()
    held = [pa.total_allocated_bytes() - before for _ in signals.pieces_of(path, MAP)]
    assert path.stat().st_size > 150 * 10_000
    assert max(held) < 45 * 10_000


def test_one_long_segment_is_read_as_many_short_ones(tmp_path, small_pieces):
    columns = table(["stop", "drag", "stop"])
    long, short = (
        written_tdms([columns], tmp_path / f"{rows}.tdms", rows) for rows in (len(columns["time"]), 500)
    )
    for one, other in zip(signals.pieces_of(long, MAP), signals.pieces_of(short, MAP), strict=True):
        assert all(np.array_equal(one.channels[k].samples, other.channels[k].samples) for k in one.channels)


@pytest.mark.parametrize(("write", "suffix"), [(written_mdf, "mf4"), (written_tdms, "tdms")])
def test_groups_with_times_of_their_own_lie_over_the_train_speed(tmp_path, small_pieces, write, suffix):
    path = tmp_path / f"log.{suffix}"
    columns = table(["stop", "drag", "stop"])
    fast = {name: columns[name] for name in ("time", "speed")}
    slow = {name: columns[name][::2] for name in ("time", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4)))}
    finest = STEP / 4 * np.arange(4 * len(columns["time"]))
    brake = {"time": finest, "brake_command": np.repeat(columns["brake_command"], 4)}
    coarse = {"time": finest[::40], "reservoir_pressure": 6e5 + 10.0 * finest[::40]}
    log = find_stops([write([slow, brake, coarse, fast], path)], MAP)
    assert [event.row for event in log.stops] == [100, 1400]
    (_, path) = write_stops(log, MAP, tmp_path / "stops")
    stop = parquet.read_table(path)
    begin, end = log.stops[1].rows
    recorded = slow["wheel_speed_1"][(begin + 1) // 2 : (end + 1) // 2]
    assert stop["wheel_speed_1"].to_numpy()[begin % 2 :: 2] == pytest.approx(recorded)
    assert stop["reservoir_pressure"].to_numpy() == pytest.approx(6e5 + STEP * 10.0 * np.arange(begin, end))
    defects = [str(defect) for defect in stop_in(path, MAP).defects if defect.kind == "coarse"]
    assert defects == [
        "coarse: reservoir_pressure is sampled every 1 s; at most 0.25 s shows all that happens"
    ]


def test_groups_whose_times_go_back_are_refused(tmp_path):
    columns = table(["stop"])
    columns["time"][200:] -= 10.0
    groups = [{k: columns[k] for k in ("time", "speed")}, {k: columns[k] for k in ("time", "brake_command")}]
    with pytest.raises(UnreadableError, match=r"log\.mf4: the times of group '' go back"):
        find_stops([written_mdf(groups, tmp_path / "log.mf4")], MAP)


@pytest.mark.parametrize("suffix", ["mf4", "tdms"])
def test_a_damaged_file_is_said_and_its_library_is_silent(tmp_path, capfd, apart, suffix):
    path = written(table(["stop"]), tmp_path / f"log.{suffix}")
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises((UnreadableError, MapError), match=rf"log\.{suffix}: "):
        find_stops([path], MAP)
    assert capfd.readouterr() == ("", "")


def noted_in(begun):
    """Start processes and note them."""
    return lambda *args, **options: begun.append(GuardedProcess(*args, **options)) or begun[-1]


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
@pytest.mark.parametrize(
    ("number", "kind", "told"),
    [
        (signal.SIGABRT, UnreadableError, "ended abruptly"),
        (signal.SIGKILL, ReadingInterruptedError, "was killed"),
        (signal.SIGSTOP, UnreadableError, "did not end within 60 s"),
    ],
)
def test_a_reader_that_crashes_or_hangs_in_the_middle_is_told(
    tmp_path, monkeypatch, apart, small_pieces, number, kind, told
):
    path = written(table(["stop"] * 10), tmp_path / "log.tdms")
    begun = []
    monkeypatch.setattr(guarded_process, "GuardedProcess", noted_in(begun))
    request = {"wanted": None, "leading": ["speed"], "at_once": 500}
    pieces = isolation.read_apart("tdms", path, request, 60.0)
    assert len(next(pieces).groups[0]) == 500
    begun[0].send_signal(number)
    monkeypatch.setattr(isolation.threading, "Timer", lambda _, kill: Timer(0.5, kill))
    with pytest.raises(kind, match=told):
        list(pieces)


def test_a_log_that_is_not_read_to_its_end_leaves_no_process(tmp_path, monkeypatch, apart, small_pieces):
    begun = []
    monkeypatch.setattr(guarded_process, "GuardedProcess", noted_in(begun))
    pieces = signals.pieces_of(written(table(["stop"] * 10), tmp_path / "log.tdms"), MAP)
    next(pieces)
    pieces.close()
    assert [each.returncode is not None for each in begun] == [True]


@pytest.mark.parametrize(
    ("row", "step", "remark"),
    [(200, -500.0, "the clock steps"), (200, 4000.0, "the clock steps"), (520, 20 * 86_400.0, "")],
)
def test_a_step_of_the_clock_hides_no_stop_and_a_log_may_span_weeks(tmp_path, row, step, remark):
    columns = table(["stop", "stop"])
    columns["time"][row:] += step
    columns["time"] += 1.7e9
    first, second = find_stops([written(columns, tmp_path / "log.parquet")], MAP).stops
    assert (remark in first.remarks[0]) if remark else first.remarks == ()
    assert second.remarks == ()


def test_of_many_steps_of_the_clock_the_first_three_are_told(tmp_path):
    columns = table(["stop"])
    for row in range(200, 250, 10):
        columns["time"][row:] += 60.0
    [stop] = find_stops([written(columns, tmp_path / "log.parquet")], MAP).stops
    assert stop.remarks[3:] == ("2 further steps of the clock",)


@pytest.mark.parametrize("offset", [0.0, 0.3e5, -0.3e5])
def test_noise_and_offset_of_a_pressure_invent_no_application(tmp_path, offset):
    columns = table(["stop", "released", "parked", "stop"])
    noise = np.random.default_rng(3).normal(0.0, 0.015e5, len(columns["time"]))
    columns["brake_line_pressure"] = 3e5 * columns.pop("brake_command") + offset + noise
    log = find_stops([written(columns, tmp_path / "log.parquet")], MAP)
    assert [event.row for event in log.stops] == [100, 500 + 380 + 500 + 100]
    assert len(log.passed_over) == 2


def test_a_brake_that_is_never_released_in_the_record_is_seen(tmp_path):
    columns = {name: samples[100:400] for name, samples in table(["stop"]).items()}
    columns["brake_line_pressure"] = 3e5 * columns.pop("brake_command")
    (stop,) = find_stops([written(columns, tmp_path / "log.parquet")], MAP).stops
    assert stop.begins_braked


def test_an_interruption_while_braking_is_no_stop_but_drag_braking_and_a_dead_speed_hide_none(tmp_path):
    path = tmp_path / "log.parquet"
    columns = {name: np.delete(samples, slice(200, 420)) for name, samples in table(["stop"]).items()}
    columns["time"][200:] += 3600.0
    log = find_stops([written(columns, path)], MAP)
    assert not log.stops
    assert "interrupted" in log.passed_over[0].reason
    columns = table(["drag", "stop"])
    columns["brake_command"][100:1100] = 1.0
    columns["speed"][600:1000] = columns["speed"][100]
    log = find_stops([written(columns, path)], MAP)
    assert "the speed is kept for" in log.stops[0].remarks[-1]
    for dead in (np.nan, 0.0, 30.0):
        columns = table(["stop", "stop"])
        columns["speed"][150:] = dead
        assert len(find_stops([written(columns, path)], MAP).stops) == 2


def test_files_are_one_log_and_the_stops_stay_when_it_cannot_be_read_again(tmp_path):
    """The first stop lies in two files; the second runs backwards and is exported with positive speed."""
    columns = table(["stop", "released", "backwards"])
    parts = [{k: v[part] for k, v in columns.items()} for part in (slice(0, 250), slice(250, None))]
    paths = [written(part, tmp_path / f"{k}.parquet") for k, part in enumerate(parts)]
    log = find_stops(paths, MAP)
    assert [event.file for event in log.stops] == paths
    assert log.stops[1].remarks == ("runs backwards: speeds are recorded with their sign changed",)
    first, second = sorted(write_stops(log, MAP, tmp_path / "stops"))
    assert stop_in(first, MAP).standstill == pytest.approx((30.0, 450.0), rel=0.02)
    assert stop_in(second, MAP).recording["speed"][0] > 14.0
    before = {path.name: path.read_bytes() for path in (tmp_path / "stops").iterdir()}
    paths[0].unlink()
    with pytest.raises(OSError, match=r"0\.parquet"):
        write_stops(log, MAP, tmp_path / "stops")
    assert {path.name: path.read_bytes() for path in (tmp_path / "stops").iterdir()} == before


def test_what_cannot_be_read_is_said_with_its_file(tmp_path):
    columns = table(["stop"])
    del columns["brake_command"]
    with pytest.raises(
        MapError, match=r"log\.csv: nothing shows when the brake is applied: map one of brake_"
    ):
        find_stops([written(columns, tmp_path / "log.csv")], MAP)
    (tmp_path / "bad.csv").write_text("time [s],speed [m/s]\n1,2\n3,x\n", "utf-8")
    with pytest.raises((MapError, UnreadableError), match=r"bad\.csv: "):
        find_stops([tmp_path / "bad.csv"], MAP)


def test_the_command_judges_each_stop_and_lists_the_rest_in_every_report(tmp_path, monkeypatch, capsys):
    """Also in a report that is written later."""
    monkeypatch.chdir(tmp_path)
    written(table(["stop", "drag", "stop"]), tmp_path / "day.csv")
    code = execute(["log", "day.csv", "--recordings", "stops", *STATED])
    shown = capsys.readouterr()
    assert code in (0, 1)
    assert re.search(r"passed over: day.csv at 60 s \(sample 601, \d+ m\): drag", shown.err)
    run = tmp_path / "reports/latest"
    stops, passed_over = (
        pd.read_csv(run / f"tables/campaign_{name}.csv") for name in ("stops", "passed_over")
    )
    assert set(stops["stops"]) == {"stop-0001", "stop-0002"}
    assert passed_over[["file", "sample"]].values.tolist() == [["day.csv", 601]]
    assert passed_over["reason"][0].startswith("drag")
    results = json.loads((run / "results.json").read_text("utf-8"))
    assert [case["id"] for case in results["cases"]] == ["stop-0001", "stop-0002"]
    (sentence,) = results["passed_over"]
    assert "drag braking" in sentence
    (run / "index.html").unlink()
    assert execute(["report", "reports/latest", "--format", "html,md"]) == 0
    for name in ("index.html", "summary.md"):
        assert sentence in (run / name).read_text("utf-8")
    assert execute(["evaluate", "stops/stop-0001.parquet", *STATED]) == code


def test_a_stop_that_cannot_be_judged_leaves_the_others(tmp_path, monkeypatch, capsys):
    """Its clock jumps by more than a day in the middle of the stop."""
    monkeypatch.chdir(tmp_path)
    columns = table(["stop", "stop"])
    columns["time"][250:] += 100_000.0
    written(columns, tmp_path / "day.parquet")
    assert execute(["log", "day.parquet", *STATED]) == 3
    results = json.loads((tmp_path / "reports/latest/results.json").read_text("utf-8"))
    assert [case["outcome"] for case in results["cases"]] == ["error", "pass"]
    assert "clock steps by +100000 s" in capsys.readouterr().err


def test_a_simulated_stop_found_by_its_pressures_keeps_its_distance(tmp_path, rolled):
    """It begins with the first rise of the pressure, 0.13 s after the command."""
    names = ["speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4)), "brake_line_pressure"]
    lead = 500
    columns = {
        name: np.concatenate((np.full(lead, rolled[name][0]), rolled[name], np.zeros(1000))) for name in names
    }
    columns["time"] = 0.01 * np.arange(len(columns["speed"]))
    log = find_stops([written(columns, tmp_path / "log.parquet")], MAP)
    stop = stop_in(min(write_stops(log, MAP, tmp_path / "stops")), MAP)
    late = 0.01 * (log.stops[0].row - lead)
    assert 0.0 < late < 0.2
    expected = rolled["distance"][-1] - late * rolled["speed"][0]
    assert stop.standstill[1] == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--from", "0 km/h"], "--from"),
        (["--to", "-3 km/h"], "not negative"),
        (["--from", "10 km/h", "--to", "30 km/h"], "higher speed"),
        (["--map", "one.yaml"], "many brake commands"),
    ],
)
def test_settings_that_find_nothing_are_refused(tmp_path, monkeypatch, capsys, arguments, told):
    monkeypatch.chdir(tmp_path)
    written(table(["stop"]), tmp_path / "day.parquet")
    head = "schema: uictest/channel-map/1\nname: one\nextends: uictest\n"
    (tmp_path / "one.yaml").write_text(head + "preparation: {trigger: start}\n", "utf-8")
    assert execute(["log", "day.parquet", *STATED, *arguments]) == 4
    assert told in capsys.readouterr().err
    assert not (tmp_path / "stops").exists()


def test_stops_of_an_earlier_log_go_and_what_is_not_ours_stays(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    written(table(["stop", "stop", "stop"]), tmp_path / "long.parquet")
    written(table(["stop"]), tmp_path / "short.parquet")
    assert execute(["log", "long.parquet", "-q", *STATED]) == 0
    assert execute(["log", "short.parquet", "-q", *STATED]) == 0
    assert [path.name for path in Path("stops").glob("*.parquet")] == ["stop-0001.parquet"]
    Path("stops/note.txt").write_text("mine", "utf-8")
    before = Path("stops/stop-0001.parquet").read_bytes()
    assert execute(["log", "long.parquet", "-q", *STATED]) == 4
    assert "stops: note.txt: uictest did not write it" in capsys.readouterr().err
    assert {path.name for path in Path("stops").iterdir()} >= {"stop-0001.parquet", "note.txt"}
    assert Path("stops/stop-0001.parquet").read_bytes() == before


def test_a_recorded_distance_gives_the_place_on_the_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    columns = table(["stop"])
    columns["distance"] = 12_000.0 + np.cumsum(STEP * columns["speed"])
    written(columns, tmp_path / "day.parquet")
    execute(["log", "day.parquet", "-q", *STATED])
    heading, row = (
        line.split(",")
        for line in Path("reports/latest/tables/campaign_stops.csv").read_text("utf-8").splitlines()
    )
    place, sample = (row[heading.index(name)] for name in ("place_m", "sample"))
    assert float(place) == pytest.approx(columns["distance"][int(sample) - 1], abs=0.1)

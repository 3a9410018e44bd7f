"""Logs as they come: what cannot be known is said."""

import gzip
from datetime import UTC, datetime, timedelta, timezone

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

from tests.service_log.test_found_stops import MAP, STEP, table, written
from uictest.core.recording.formats import UnreadableError
from uictest.recorded.field_data import MapError, load_map, stop_in
from uictest.recorded.service_log import find_stops, write_stops

KINDS = ["stop", "drag", "stop", "shunting", "released", "parked"]
PLACES = [100, 1400]
BEGIN = datetime(2026, 3, 29, 0, 59, 50, tzinfo=UTC)


def found(columns, path, channel_map=MAP):
    log = find_stops([written(columns, path)], channel_map)
    return log, [event.row for event in log.stops], [event.reason for event in log.passed_over]


def mapped(folder, text):
    (folder / "own.yaml").write_text(f"schema: uictest/channel-map/1\nname: own\nextends: uictest\n{text}")
    return load_map(str(folder / "own.yaml"))[0]


def test_a_brake_signal_missing_within_a_stop_does_not_cut_it_and_is_told(tmp_path):
    path = tmp_path / "log.parquet"
    for rows, remarks in ((5, ()), (25, ()), (50, ("the brake signal is missing in part",))):
        columns = table(KINDS)
        columns["brake_command"][200 : 200 + rows] = np.nan
        log, places, _ = found(columns, path)
        assert (places, log.stops[0].remarks) == (PLACES, remarks)
    columns = table(KINDS)
    columns["brake_command"][50:450] = np.nan
    _, places, reasons = found(columns, path)
    assert (places, reasons[0]) == (PLACES[1:], "the brake signal is missing")


def test_a_brake_pipe_has_to_be_turned_round_and_says_so(tmp_path):
    """It has 5 bar released and 3.5 bar applied; scale and offset of the map turn it round."""
    columns = table(KINDS)
    columns["brake_line_pressure"] = 5e5 - 1.5e5 * columns.pop("brake_command")
    _, _, reasons = found(columns, tmp_path / "log.parquet")
    assert any("stuck or inverted" in reason for reason in reasons)
    pipe = "channels:\n  brake_line_pressure: {source: brake_line_pressure, scale: -1, offset: 500000}\n"
    assert found(columns, tmp_path / "log.parquet", mapped(tmp_path, pipe))[1] == PLACES


@pytest.mark.parametrize("unit", ["time [km/h]", "by map"])
def test_speeds_in_kmh_are_told_by_heading_or_map(tmp_path, unit):
    columns = {name: 3.6 * v if "speed" in name else v for name, v in table(KINDS).items()}
    heads = [name if unit == "by map" or "speed" not in name else f"{name} [km/h]" for name in columns]
    heads = [{"time": "time [s]", "brake_command": "brake_command [1]"}.get(head, head) for head in heads]
    pa.csv.write_csv(pa.table(list(columns.values()), names=heads), tmp_path / "log.csv")
    wheels = '"wheel_speed_{n}": {source: "wheel_speed_{n}", unit: km/h}'
    text = f"channels:\n  speed: {{source: speed, unit: km/h}}\n  {wheels}\n" if unit == "by map" else ""
    channel_map = mapped(tmp_path, text)
    log = find_stops([tmp_path / "log.csv"], channel_map)
    (first, _) = write_stops(log, channel_map, tmp_path / "stops")
    assert stop_in(first, MAP).standstill == pytest.approx((30.0, 450.0), rel=0.02)


@pytest.mark.parametrize("form", ["text", "stamps"])
def test_dates_are_unix_time_over_a_change_to_summer_time(tmp_path, form):
    columns = table(KINDS)
    seconds = columns["time"].tolist()
    dates = [BEGIN + timedelta(seconds=each) for each in seconds]
    # 01:00 UTC is the beginning of the first stop: from then on local time is two hours ahead.
    local = [each.astimezone(timezone(timedelta(hours=1 + (each.hour >= 1)))).isoformat() for each in dates]
    time = local if form == "text" else pa.array(dates, pa.timestamp("us", "UTC"))
    arrays = {"time": pa.array(time), **{k: pa.array(v) for k, v in columns.items() if k != "time"}}
    fields = [
        pa.field(k, v.type, metadata={"unit": "m/s"} if "speed" in k else None) for k, v in arrays.items()
    ]
    parquet.write_table(pa.table(list(arrays.values()), schema=pa.schema(fields)), tmp_path / "log.parquet")
    log = find_stops([tmp_path / "log.parquet"], MAP)
    assert [event.row for event in log.stops] == PLACES
    assert log.stops[0].time == pytest.approx(BEGIN.timestamp() + 10.0)
    assert log.stops[0].remarks == ()


def test_files_that_overlap_or_are_empty_are_refused(tmp_path):
    columns = table(KINDS)
    columns["time"] += 1.75e9
    parts = {"early": slice(0, 1900), "late": slice(1000, None), "rest": slice(1900, None)}
    early, late, rest = (
        written({k: v[part] for k, v in columns.items()}, tmp_path / f"{name}.csv")
        for name, part in parts.items()
    )
    for files in ([early, late], [late, early]):
        with pytest.raises(UnreadableError, match=r"late\.csv: begins 90 s before .*early\.csv ends"):
            find_stops(files, MAP)
    with pytest.raises(UnreadableError, match="named twice"):
        find_stops([early, rest, early], MAP)
    assert len(find_stops([early, rest], MAP).stops) == 2
    assert len(find_stops([rest, early], MAP).stops) == 2
    late.write_text(early.read_text("utf-8").partition("\n")[0] + "\n", "utf-8")
    with pytest.raises(UnreadableError, match=r"late\.csv: no samples"):
        find_stops([early, late], MAP)


@pytest.mark.parametrize("defect", ["quantised", "overshoot", "spikes", "wheels dead", "two wheels", "noise"])
def test_a_poor_speed_hides_no_stop_and_invents_none(tmp_path, defect):
    columns, draw = table(KINDS), np.random.default_rng(2)
    speed = columns["speed"]
    if defect == "quantised":
        columns |= {k: np.round(3.6 * v) / 3.6 for k, v in columns.items() if "speed" in k}
    elif defect == "overshoot":
        speed[400:420] -= 0.5 * np.exp(-np.arange(20) / 5.0)
    elif defect == "spikes":
        speed[250:256], speed[300:304] = 0.0, 120.0
    elif defect == "noise":
        speed[100:400] += draw.normal(0.0, 1.0, 300)
    else:
        for n in (1, 2, 3, 4) if defect == "wheels dead" else (3, 4):
            columns[f"wheel_speed_{n}"][:] = np.nan
    _, places, reasons = found(columns, tmp_path / "log.parquet")
    assert places == PLACES
    assert len(reasons) == 4


def test_implausible_numbers_are_not_believed_wherever_they_stand(tmp_path, monkeypatch):
    """Nor do sound samples beside them suffer: pieces of every length give the same."""
    columns = table(KINDS * 2)
    columns["speed"][250:330] = 6553.5
    columns["brake_command"] = np.where(columns["brake_command"] > 0.0, "on", "off")
    columns["brake_command"][3100:3104] = "?"
    states = 'channels:\n  brake_command: {source: brake_command, states: {"off": 0, "on": 1}}\n'
    channel_map = mapped(tmp_path, states)
    fields = [pa.field(k, pa.array(v[:1]).type, metadata={"unit": "m/s"}) for k, v in columns.items()]
    fields[0] = fields[0].with_metadata({"unit": "s"})
    parquet.write_table(pa.table(list(columns.values()), schema=pa.schema(fields)), tmp_path / "log.parquet")
    found_in = []
    for length in (2000, 2650):
        monkeypatch.setattr("uictest.core.recording.formats.pieces._ROWS", length)
        log = find_stops([tmp_path / "log.parquet"], channel_map)
        found_in.append([repr(event) for event in (*log.stops, *log.passed_over)])
        assert [event.row for event in log.stops] == [*PLACES, 3020, 4320]
        assert log.stops[0].remarks == ("the train speed is missing in part",)
    assert found_in[0] == found_in[1]


@pytest.mark.parametrize("seconds", [0.8, 1.5, 4.0])
@pytest.mark.parametrize("lost", ["train", "all"])
def test_a_speed_that_is_lost_within_a_stop_does_not_end_it(tmp_path, lost, seconds):
    columns = table(KINDS)
    for name in ["speed"] if lost == "train" else [name for name in columns if "speed" in name]:
        columns[name][200 : 200 + round(seconds / STEP)] = 0.0
    log, places, reasons = found(columns, tmp_path / "log.parquet")
    assert places == PLACES
    assert len(reasons) == 4
    begin, end = log.stops[0].rows
    assert begin == 50
    assert 420 <= end <= 440, "3 s after standstill"


@pytest.mark.parametrize(
    ("suffix", "spoilt", "reason"),
    [
        ("parquet", lambda content: content[: len(content) // 2], r"log\.parquet: damaged"),
        ("parquet", lambda content: content[:3000] + bytes(2000) + content[5000:], r"log\.parquet: damaged"),
        ("csv", lambda content: content.replace(b"\n0.", b"\n\xe40.", 1), "encoding: cp1252"),
        ("csv", gzip.compress, "compressed file: unpack it"),
    ],
)
def test_a_damaged_or_compressed_log_or_another_encoding_is_told(tmp_path, suffix, spoilt, reason):
    path = written(table(KINDS), tmp_path / f"log.{suffix}")
    path.write_bytes(spoilt(path.read_bytes()))
    with pytest.raises(UnreadableError, match=reason):
        find_stops([path], MAP)


def test_comments_and_a_last_line_that_is_cut_off_are_no_samples(tmp_path):
    path = written(table(KINDS), tmp_path / "log.csv")
    lines = path.read_text("utf-8").splitlines()
    path.write_text("\n".join([*lines[:1500], "# put right, by hand", *lines[1500:], "292.1,0.0"]), "utf-8")
    assert [event.row for event in find_stops([path], MAP).stops] == PLACES
    path.write_text("\n".join([*lines[:1500], "292.1,0.0", *lines[1500:]]), "utf-8")
    with pytest.raises(UnreadableError, match=r"line 1501 has 2 cells"):
        find_stops([path], MAP)


def test_a_wsp_that_vents_all_cylinders_does_not_end_the_stop(tmp_path):
    columns = table(KINDS)
    pressure = 3e5 * columns.pop("brake_command")
    pressure[150:175] = 0.0
    columns |= {f"cylinder_pressure_{n}": pressure for n in (1, 2, 3, 4)}
    assert found(columns, tmp_path / "log.csv")[1] == PLACES


def test_a_tdms_file_whose_recorder_lost_its_power_is_read_up_to_there(tmp_path):
    path = written(table(KINDS), tmp_path / "log.tdms")
    path.write_bytes(path.read_bytes()[:-5000])
    log = find_stops([path], MAP)
    assert [event.row for event in log.stops] == PLACES
    assert 2000 <= log.first_rows[-1] < len(table(KINDS)["time"])


def csv_log(folder, change):
    """Write the log as text, its lines changed: heading in the first, then samples."""
    lines = written(table(KINDS), folder / "log.csv").read_text().splitlines()
    (folder / "log.csv").write_text("\n".join(change(lines)) + "\n")
    return folder / "log.csv"


@pytest.mark.parametrize(
    "change",
    [
        lambda lines: [lines[0], *(f"{line}," for line in lines[1:])],
        lambda lines: [*lines[:50], *["," * lines[0].count(",")] * 5, *lines[50:]],
        lambda lines: [*lines[:2500], *["," * lines[0].count(",")] * 5, *lines[2500:]],
    ],
    ids=["delimiters at the ends", "empty cells while running", "empty cells while standing braked"],
)
def test_lines_that_evaluate_reads_change_nothing(tmp_path, change):
    plain, places, reasons = found(table(KINDS), tmp_path / "plain.csv")
    log = find_stops([csv_log(tmp_path, change)], MAP)
    assert [event.row for event in log.stops] == places
    assert [event.reason for event in log.passed_over] == reasons
    stop = stop_in(min(write_stops(log, MAP, tmp_path / "stops")), MAP)
    other = stop_in(min(write_stops(plain, MAP, tmp_path / "others")), MAP)
    assert np.array_equal(stop.recording["speed"], other.recording["speed"])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            lambda lines: [*lines[:299], lines[299].rpartition(",")[0], *lines[300:]],
            "line 300 has 6 cells; line 1 names 7",
        ),
        (
            lambda lines: [*lines[:299], f"ERR{lines[299]}", *lines[300:]],
            "line 300, column 1: 'ERR29.8' is no number",
        ),
        (lambda lines: [lines[0].replace("speed [", "Speed [", 1), *lines[1:]], "did you mean 'Speed'"),
    ],
    ids=["a cell too few", "no number", "another name"],
)
def test_what_cannot_be_read_is_told_with_its_line_or_the_names_of_the_file(tmp_path, change, told):
    with pytest.raises((UnreadableError, MapError), match=told):
        find_stops([csv_log(tmp_path, change)], MAP)

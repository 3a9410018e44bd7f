"""Records as others make them, each after a public report: judged as they are, or refused with a remedy.

Each is a stop from 80 km/h that holds its speed for 2 s and then loses 1 m/s2: 246.9 m.
"""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from uictest.core.recording.formats.isolation import read_here
from uictest.recorded.field_data import MapError, UnusableError, load_map, prepare, select_channels
from uictest.recorded.field_data.raw_channels import at_own_rates, with_valve_commands

STEP, DISTANCE = 0.02, 246.91
TIME = STEP * np.arange(1262)
SPEED = np.maximum(80.0 - 3.6 * np.maximum(TIME - 2.0, 0.0), 0.0)
BRAKED = (TIME >= 2.0).astype(int)


def columns_of(**changed):
    """Return the columns of a table, km/h; those of other names are added."""
    columns = {"t [s]": TIME, "v_train [km/h]": SPEED} | {f"v{n} [km/h]": SPEED for n in range(1, 5)}
    return columns | changed


def written(path, columns):
    """Write a table, NaN as an empty cell."""
    rows = zip(*columns.values(), strict=True)
    cells = (",".join("" if value != value else f"{value}" for value in row) for row in rows)
    path.write_text("\n".join([",".join(columns), *cells]) + "\n", encoding="utf-8")
    return path


def stop_of(path, text="", trigger="2 s", kind="csv"):
    """Return the stop in a file, as `evaluate` reads it by a map that extends the common names."""
    map_path = path.with_suffix(".yaml")
    map_path.write_text(f"schema: uictest/channel-map/1\nname: lab\nextends: common-names\n{text}\n")
    channel_map = load_map(str(map_path))[0].triggered_by(trigger)
    contents = read_here(kind, path, channel_map.dialect)
    channels = with_valve_commands(at_own_rates(select_channels(contents, channel_map)))
    return prepare(channels, contents.metadata, channel_map.preparation)


def distance_of(stop):
    """Return the braking distance of a stop, m."""
    assert stop.standstill is not None
    return stop.standstill[1]


def on_two_clocks(step):
    """Return a table of a fast and of a slow clock that never meet: each row has the samples of one."""
    slow_time = TIME[::step] + 0.007
    time = np.sort(np.concatenate([TIME, slow_time]))
    fast, slow = (
        np.where(np.isin(time, of), np.interp(time, TIME, SPEED), np.nan) for of in (TIME, slow_time)
    )
    return {"t [s]": time, "v_train [km/h]": fast} | {f"v{n} [km/h]": slow for n in range(1, 5)}


LATE = np.where(TIME < 0.4, np.nan, SPEED)
LONG = "Model/" + "Subsystem/" * 60 + "v"
ODD = {
    # smuview issue 58
    "samples miss before the brake": (
        {n: LATE if "v" in n else c for n, c in columns_of().items()},
        "",
        0.01,
    ),
    "T1 is no torque, a motor speed no train speed": (
        columns_of(**{"T1 [°C]": np.full(len(TIME), 40.0), "Speed [rpm]": 20.0 * SPEED}),
        *("", 0.01),
    ),
    "names as DIN 461 writes them, and of 600 letters": (
        {"t in s": TIME, "v_Zug / (km/h)": SPEED, "v1 in km/h": SPEED, f"{LONG} [km/h]": SPEED},
        *(f'channels: {{wheel_speed_2: "{LONG}"}}', 0.01),
    ),
    **{
        f"speeds in {unit}": ({"t [s]": TIME, f"v_train [{unit}]": SPEED / size}, "", 0.01)
        for unit, size in (("mph", 1.609344), ("kn", 1.852), ("knots", 1.852))
    },
    "clocks that never meet, 10 Hz": (on_two_clocks(5), "", 0.02),
    "clocks that never meet, 25 Hz": (on_two_clocks(2), "", 0.02),
}
"""Columns of a table, the map that reads them, and the tolerance of the distance, m."""


@pytest.mark.parametrize("odd", ODD)
def test_a_table_that_is_odd_gives_the_distance(tmp_path, odd):
    columns, text, tolerance = ODD[odd]
    stop = stop_of(written(tmp_path / "a.csv", columns), text)
    assert distance_of(stop) == pytest.approx(DISTANCE, abs=tolerance)
    assert bool(stop.defects) == ("miss" in odd)
    assert "brake_torque_1" not in stop.recording.channels
    if "DIN" in odd:
        assert {"wheel_speed_1", "wheel_speed_2"} <= stop.recording.channels.keys()


ASKED_FOR = {
    "a speed with the other sign": (
        {"v_train [km/h]": -SPEED},
        "write sign: -1 beside the source of the speed",
        "channels: {speed: {source: v_train, sign: -1}}",
    ),
    "days of a spreadsheet": (
        {"t [s]": 45_000.0 + TIME / 86_400.0},
        r"is it in d\? write `unit: d`",
        "channels: {time: {source: t, unit: d}}",
    ),
    "times that go back": ({}, r"goes back in time 1 times, .*; sort the rows by time", ""),
}
"""Changed columns, what the refusal says, and the map that does as it says."""


@pytest.mark.parametrize("name", ASKED_FOR)
def test_what_is_refused_is_read_once_the_message_is_obeyed(tmp_path, name):
    changed, message, text = ASKED_FOR[name]
    columns = columns_of(**changed)
    if not text:
        order = np.r_[0:400, 500:600, 400:500, 600:1262]
        columns = {name: samples[order] for name, samples in columns.items()}
    path = written(tmp_path / "a.csv", columns)
    with pytest.raises((MapError, UnusableError), match=message):
        stop_of(path)
    if not text:
        written(path, columns_of())
    trigger = f"{86_400.0 * 45_000.0 + 2.0} s" if "days" in name else "2 s"
    assert distance_of(stop_of(path, text, trigger)) == pytest.approx(DISTANCE, abs=0.01)


@pytest.mark.parametrize("name", ["v_train [km/h]", "v2 [km/h]"])
@pytest.mark.parametrize("samples", [1, 6])
def test_a_speed_that_jumps_up_and_back_is_a_spike(tmp_path, name, samples):
    spiked = SPEED.copy()
    spiked[600 : 600 + samples] = 300.0
    stop = stop_of(written(tmp_path / "a.csv", columns_of(**{name: spiked})))
    (spike,) = stop.defects
    assert (spike.kind, spike.makes_unusable) == ("spike", True)
    assert "rises and returns at once, 1 times from 12 to" in spike.text


@pytest.mark.parametrize(
    ("column", "pulse", "level", "trigger"),
    [("BrakeCommand", 1.0, BRAKED, "command"), ("p_C1 [bar]", 0.4, 3.8 * BRAKED, "pressure")],
    ids=["RaceCapture-Pro_firmware-901", "mqtt-io-48"],
)
def test_a_contact_that_bounces_is_no_brake_command(tmp_path, column, pulse, level, trigger):
    bounced = level.astype(float)
    bounced[50] = pulse
    stop = stop_of(written(tmp_path / "a.csv", columns_of(**{column: bounced})), trigger=trigger)
    assert distance_of(stop) == pytest.approx(DISTANCE, abs=0.5)
    late = np.where(TIME >= 2.05, level, 0.0)  # the contact bounces when it closes, too
    late[100:102] = pulse
    stop = stop_of(written(tmp_path / "a.csv", columns_of(**{column: late})), trigger=trigger)
    assert stop.trigger.time < 2.06


def test_the_text_of_a_table_as_others_write_it(tmp_path):
    """Letters of two bytes without a mark are read; a cell too many and a name twice are refused."""
    path = written(tmp_path / "a.csv", columns_of())
    text = path.read_text()
    for encoding in ("utf-16-le", "utf-16-be"):
        path.write_bytes(text.encode(encoding))
        assert distance_of(stop_of(path)) == pytest.approx(DISTANCE, abs=0.01)
    path.write_text("label," + text)  # Hioki 8807 manual, 12.5
    with pytest.raises(ValueError, match=r"line 1 names 7 channels, but no line of samples has more than 6"):
        stop_of(path)
    path.write_text(text.replace("v1 [km/h]", "v_train [km/h]", 1))
    told = r"several columns have that name: write one of 'v_train \(1\)', 'v_train"
    with pytest.raises(MapError, match=told):
        stop_of(path)


@pytest.mark.parametrize("fast", [True, False], ids=["asammdf-1219", "smuview-58"])
def test_channels_of_a_slower_rate_have_a_time_of_their_own(tmp_path, fast):
    slow = np.where(np.arange(len(TIME)) % 5, np.nan, SPEED)
    names = [f"v{n} [km/h]" for n in range(1, 5)] if fast else ["v_train [km/h]"]
    stop = stop_of(written(tmp_path / "a.csv", columns_of(**dict.fromkeys(names, slow))))
    assert distance_of(stop) == pytest.approx(DISTANCE, abs=0.1)
    assert stop.defects == ()
    assert stop.intervals["wheel_speed_1" if fast else "speed"] == pytest.approx(0.1)
    assert "every 100 ms" in stop.choices["sampling"]
    assert "every 20 ms" in stop.choices["sampling"]


def test_a_single_missing_sample_is_no_slower_rate_and_a_trigger_before_the_record_says_so(tmp_path):
    hole = SPEED.copy()
    hole[600] = np.nan
    stop = stop_of(written(tmp_path / "a.csv", columns_of(**{"v2 [km/h]": hole})))
    assert [defect.kind for defect in stop.defects] == ["not-a-number"]
    stop = stop_of(written(tmp_path / "a.csv", columns_of(**{"t [s]": 1.79e9 + TIME})))
    assert "at 2 s, stated by the user, before the record begins at 1790000000 s" in stop.trigger.text


def test_states_given_to_numbers_and_words_are_used_and_an_inverted_command_is_asked_for(tmp_path):
    path = written(tmp_path / "a.csv", columns_of(BrakeCommand=1 - BRAKED))  # asammdf issues 293, 748
    stop = stop_of(path, trigger="command")
    assert 'or inverted: then write states: {"0": 1, "1": 0} beside its source' in stop.trigger.text
    text = 'channels: {brake_command: {source: BrakeCommand, states: {"0": 1, "1": 0}}}'
    assert distance_of(stop_of(path, text, "command")) == pytest.approx(DISTANCE, abs=0.5)
    written(path, columns_of(MV=np.where(TIME < 5.0, "TRUE", "FALSE")))
    text = 'channels: {valve_command_1: {source: MV, states: {"TRUE": 2, "FALSE": 0}}}'
    assert set(stop_of(path, text).recording["valve_command_1"]) == {0.0, 2.0}


def test_a_piston_stroke_taken_for_the_distance_is_named_and_can_be_left_out(tmp_path):
    path = written(tmp_path / "a.csv", columns_of(**{"s [mm]": 8.0 * BRAKED}))
    (told,) = stop_of(path).defects
    assert "write channels: {distance: null} in the channel map" in told.text
    stop = stop_of(path, "channels: {distance: null}")
    assert (stop.defects, stop.choices["distance"]) == ((), "integrated from speed")


def test_times_of_a_day_in_parquet_run_past_midnight(tmp_path):
    of_day = ((86_390.0 + TIME) % 86_400.0 * 1e6).round().astype(np.int64)
    columns = columns_of(**{"t [s]": pa.array(of_day).cast(pa.time64("us"))})
    pq.write_table(
        pa.table({("time" if name == "t [s]" else name): each for name, each in columns.items()}),
        tmp_path / "a.parquet",
    )
    stop = stop_of(tmp_path / "a.parquet", kind="parquet")
    assert distance_of(stop) == pytest.approx(DISTANCE, abs=0.01)


def test_a_channel_of_two_groups_without_names_is_chosen_by_number(tmp_path):
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF() as file:
        for samples in (np.zeros(len(TIME)), SPEED):
            file.append([asammdf.Signal(samples, TIME, name="speed", unit="km/h")])
        file.save(tmp_path / "a.mf4")
    with pytest.raises(MapError, match="in several groups: write one of 'group 1/speed', 'group 2/speed'"):
        stop_of(tmp_path / "a.mf4", kind="mdf")
    stop = stop_of(tmp_path / "a.mf4", "channels: {speed: group 2/speed}", kind="mdf")
    assert distance_of(stop) == pytest.approx(DISTANCE, abs=0.01)


@pytest.mark.parametrize("step", [5, 10], ids=["10 Hz", "5 Hz"])
def test_a_slow_recorder_shows_a_spike_and_one_sample_of_pressure_is_no_command(tmp_path, step):
    columns = {name: samples[::step] for name, samples in columns_of().items()}
    spiked = SPEED[::step].copy()
    spiked[600 // step] += 10.0 * step
    stop = stop_of(written(tmp_path / "a.csv", columns | {"v_train [km/h]": spiked}))
    assert [defect.kind for defect in stop.defects] == ["spike"]
    pressure = 3.8 * BRAKED[::step].astype(float)
    pressure[50 // step] = 0.4
    stop = stop_of(written(tmp_path / "a.csv", columns | {"p_C1 [bar]": pressure}), trigger="pressure")
    assert stop.trigger.time == pytest.approx(2.0, abs=STEP * step)


def test_rows_that_are_nearly_empty_at_the_end_leave_the_dialect(tmp_path):
    rows = [f"{t:.2f};{v:.3f};{v:.3f}".replace(".", ",") for t, v in zip(TIME, SPEED, strict=True)]
    rows[-6:] = [row.split(";")[0] + ";" + row.split(";")[1] + ";" for row in rows[-6:]]
    (tmp_path / "a.csv").write_text("\n".join(["Zeit [s];v [km/h];v1 [km/h]", *rows]) + "\n")
    stop = stop_of(tmp_path / "a.csv", 'csv: {delimiter: ";", decimal: ","}')
    assert distance_of(stop) == pytest.approx(DISTANCE, abs=0.01)


def test_a_radius_of_a_speed_that_does_not_rotate_and_degrees_are_told(tmp_path):
    path = written(tmp_path / "a.csv", columns_of(**{"Td [°C]": SPEED}))
    with pytest.raises(MapError, match="'v1' is in km/h, no rotational speed: leave out wheel_radius"):
        stop_of(path, "channels: {wheel_speed_1: {source: v1, wheel_radius: 0.46 m}}")
    with pytest.raises(MapError, match=r"write unit: K, and for degrees Celsius offset: 273\.15"):
        stop_of(path, "channels: {disc_surface_temperature_1: Td}")
    text = "channels: {disc_surface_temperature_1: {source: Td, unit: K, offset: 273.15}}"
    assert stop_of(path, text).recording["disc_surface_temperature_1"][0] == pytest.approx(353.15)

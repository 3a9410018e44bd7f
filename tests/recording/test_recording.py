"""Recordings in memory, what a channel is at an instant, and recordings as Parquet."""

import subprocess
import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays

from uictest.core.recording import (
    Contents,
    Group,
    Recording,
    at_instants,
    common_instants,
    covers,
    parquet_bytes,
    read_parquet,
    recording_of,
)
from uictest.core.recording.formats import UnreadableError

TIME = np.array([0.0, 0.5, 1.0])


def recording(channels, **units):
    return Recording(channels, {"time": "s", **units})


def test_a_recording_gives_its_length_and_its_channels_and_says_which_there_are():
    it = recording({"time": TIME, "speed": np.array([3.0, np.nan, 1.0])}, speed="m/s")
    assert (len(it), it["speed"][0]) == (3, 3.0)
    with pytest.raises(KeyError, match="no channel 'sped' in this recording of time, speed"):
        it["sped"]


@pytest.mark.parametrize(
    ("channels", "units", "message"),
    [
        ({}, {}, "first channel of a recording must be 'time', found: none"),
        ({"speed": TIME, "time": TIME}, {"speed": "m/s"}, "must be 'time', found: speed, time"),
        ({"time": TIME, "speed": TIME[:2]}, {"speed": "m/s"}, "'speed' has 2 samples, 'time' has 3"),
        ({"time": TIME, "speed": TIME[:, None]}, {"speed": "m/s"}, "'speed' has 2 dimensions"),
        ({"time": TIME, "note": np.array(["a", "b", "c"])}, {"note": "1"}, "'note' holds <U1"),
        ({"time": np.array([0.0, np.nan, 1.0])}, {}, "'time' is not finite at sample 1"),
        ({"time": np.array([0.0, 1.0, np.inf])}, {}, "'time' is not finite at sample 2"),
        ({"time": np.array([0.0, 1.0, 1.0])}, {}, "'time' does not increase at sample 2: 1.0 s, then 1.0 s"),
        ({"time": TIME, "speed": TIME}, {}, "no unit for speed"),
        ({"time": TIME}, {"speed": "m/s"}, "units for missing channels: speed"),
        ({"time": TIME}, {"time": "ms"}, "'time' must be in \"s\", found 'ms'"),
    ],
)
def test_what_is_no_recording_is_refused(channels, units, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        recording(channels, **units)


TIMES = st.lists(st.integers(-50, 50), min_size=1, max_size=20, unique=True).map(
    lambda steps: 0.25 * np.array(sorted(steps))
)
INSTANTS = st.lists(st.integers(-120, 120), min_size=1, max_size=20).map(lambda ks: 0.125 * np.array(ks))


@given(TIMES, INSTANTS)
def test_a_signal_is_a_line_and_a_state_stands_as_far_as_there_are_samples(time, instants):
    samples = np.cos(7.0 * time)
    line = np.interp(instants, time, samples, left=np.nan, right=np.nan)
    np.testing.assert_allclose(at_instants(time, samples, instants, holds=False), line, atol=1e-12)
    stands = [
        next((x for t, x in zip(time[::-1], samples[::-1], strict=True) if t <= at), np.nan)
        if time[0] <= at <= time[-1]
        else np.nan
        for at in instants
    ]
    np.testing.assert_array_equal(at_instants(time, samples, instants, holds=True), stands)


@pytest.mark.parametrize("clock", [0.0, 86_399.99, 1.7e9])
def test_an_instant_that_is_rounded_is_still_that_of_its_sample(clock):
    time = clock + 0.01 * np.arange(1000)
    valve = np.where(np.arange(1000) >= 500, 2.0, 0.0)
    again = time[250] + 0.01 * np.arange(-250, 750)
    for instants in (again, np.nextafter(time, -np.inf), np.nextafter(time, np.inf)):
        np.testing.assert_array_equal(at_instants(time, valve, instants, holds=True), valve)
        assert covers(time, instants).all()


def test_what_lies_beside_a_missing_sample_or_in_a_gap_is_unknown_and_the_samples_are_not():
    time, samples = np.arange(5.0), np.array([0.0, 1.0, np.nan, 3.0, 4.0])
    gaps = np.array([False, False, False, True])
    at = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0])
    line = at_instants(time, samples, at, holds=False, gaps=gaps)
    np.testing.assert_array_equal(line, [0.5, 1.0, np.nan, np.nan, np.nan, 3.0, np.nan, 4.0])
    stands = at_instants(time, samples, at, holds=True, gaps=gaps)
    np.testing.assert_array_equal(stands, [0.0, 1.0, 1.0, np.nan, np.nan, 3.0, np.nan, 4.0])


@given(TIMES, TIMES)
def test_common_instants_are_samples_that_both_cover_in_either_order(first, second):
    common = common_instants(first, second)
    np.testing.assert_array_equal(common, common_instants(second, first))
    assert np.isin(common, [*first, *second]).all()
    assert covers(first, common).all()
    assert covers(second, common).all()


def test_of_two_equally_coarse_axes_the_samples_of_both_are_common_but_each_only_once():
    time = 0.01 * np.arange(100)
    np.testing.assert_array_equal(common_instants(time, np.nextafter(time, 1.0)), time)
    moved = common_instants(time, time + 0.004)
    assert len(moved) == 2 * 100 - 2
    np.testing.assert_array_equal(common_instants(time, time[::5]), time[::5])


def _named(**channels):
    group = Group("", {"time": np.arange(3.0), **channels}, {"time": "s", **dict.fromkeys(channels, "1")})
    return recording_of(Contents((group,)), {})


def test_names_of_states_are_read_as_their_numbers_and_other_texts_refused():
    read = _named(valve_command_2=np.array(["vent", "", "1"]), speed_valid=np.array(["no", "yes", "no"]))
    np.testing.assert_array_equal(read["valve_command_2"], [2.0, np.nan, 1.0])
    np.testing.assert_array_equal(read["speed_valid"], [0.0, 1.0, 0.0])
    for channel, accepted in (("valve_command_1", "numbers, fill, hold, vent"), ("speed", "numbers")):
        told = rf"'{channel}' contains texts: 'lösen'; accepted: {accepted}$"
        with pytest.raises(UnreadableError, match=told):
            _named(**{channel: np.array(["1", "lösen", "2"])})


STOP_TIME = np.array([0.0, 0.01, 0.02])


def stop():
    return Recording(
        channels={
            "time": STOP_TIME,
            "tank_pressure_1": np.array([0.0, np.nan, 3.8], dtype=np.float32),
            "valve_command_1": np.array([0, 2, 1], dtype=np.int8),
        },
        units={"time": "s", "tank_pressure_1": "bar", "valve_command_1": "1"},
        metadata={"case": "slip-120[friction=0.10]", "title": "Gleitprüfung"},
    )


def test_a_recording_comes_back_as_it_was_written_with_the_same_bytes(tmp_path):
    path = tmp_path / "slip-120[friction=0.10,command=90].parquet"
    path.write_bytes(parquet_bytes(stop()))
    back = read_parquet(path)
    assert back.units == stop().units
    assert back.metadata == stop().metadata
    assert list(back.channels) == list(stop().channels)
    for name, samples in stop().channels.items():
        assert back[name].dtype == samples.dtype
        np.testing.assert_array_equal(back[name], samples)
    assert path.read_bytes() == parquet_bytes(stop())


def test_any_reader_of_parquet_finds_the_units_and_they_survive_without_field_metadata(tmp_path):
    (tmp_path / "a.parquet").write_bytes(parquet_bytes(stop()))
    schema = pq.read_schema(tmp_path / "a.parquet")
    assert schema.field("tank_pressure_1").metadata[b"unit"] == b"bar"
    assert schema.metadata[b"uictest.schema"] == b"uictest/recording/1"
    table = pq.ParquetFile(tmp_path / "a.parquet").read()
    bare = pa.schema([field.remove_metadata() for field in table.schema], metadata=table.schema.metadata)
    pq.write_table(table.cast(bare), tmp_path / "b.parquet")
    assert read_parquet(tmp_path / "b.parquet").units == stop().units


def test_a_folder_named_like_a_partition_is_no_channel_and_a_column_of_records_may_be_one(tmp_path):
    folder = tmp_path / "friction=0.10"
    folder.mkdir()
    (folder / "a.parquet").write_bytes(parquet_bytes(stop()))
    assert "friction" not in read_parquet(folder / "a.parquet").channels
    records = np.zeros(3, dtype=[("speed", "f8"), ("force", "f4")])
    records["speed"] = [3.0, 2.0, 1.0]
    written = Recording({"time": STOP_TIME, "speed": records["speed"]}, {"time": "s", "speed": "m/s"})
    (tmp_path / "a").write_bytes(parquet_bytes(written))
    np.testing.assert_array_equal(read_parquet(tmp_path / "a")["speed"], [3.0, 2.0, 1.0])


def test_missing_samples_become_nan_and_true_and_false_numbers(tmp_path):
    fields = [
        pa.field("time", pa.float64(), metadata={"unit": "s"}),
        pa.field("count", pa.int64(), metadata={"unit": "1"}),
    ]
    pq.write_table(pa.table([[0.0, 1.0], [None, 4]], schema=pa.schema(fields)), tmp_path / "a.parquet")
    np.testing.assert_array_equal(read_parquet(tmp_path / "a.parquet")["count"], [np.nan, 4.0])
    units = {"time": "s", "venting": "1"}
    fields = [pa.field(name, pa.bool_(), metadata={"unit": unit}) for name, unit in units.items()]
    table = pa.table([[False, True], [True, False]], schema=pa.schema(fields))
    pq.write_table(table, tmp_path / "a.parquet")
    recording = read_parquet(tmp_path / "a.parquet")
    assert (recording["time"] - 0.5).tolist() == [-0.5, 0.5]
    assert recording["venting"].tolist() == [1.0, 0.0]


def test_what_is_no_recording_is_a_value_error_and_a_missing_file_an_os_error(tmp_path):
    path = tmp_path / "a.parquet"
    with pytest.raises(FileNotFoundError):
        read_parquet(path)
    pq.write_table(pa.table({"time": [0.0, 1.0], "speed": [3.0, 2.0]}), path)
    with pytest.raises(ValueError, match=r"a\.parquet: not a recording: no unit for time, speed"):
        read_parquet(path)
    path.write_text("time,speed\n0,1\n")
    with pytest.raises(ValueError, match="not a recording"):
        read_parquet(path)


@given(arrays.arrays(np.float64, st.integers(0, 40), elements=st.floats(width=64)))
def test_every_float_comes_back_bit_for_bit(tmp_path_factory, samples):
    path = tmp_path_factory.mktemp("floats") / "a.parquet"
    channels = {"time": np.arange(len(samples)) * 0.01, "force": samples}
    path.write_bytes(parquet_bytes(Recording(channels, {"time": "s", "force": "N"})))
    assert read_parquet(path)["force"].tobytes() == samples.tobytes()


def test_importing_the_room_does_not_import_pyarrow():
    code = (
        "import sys, uictest.core.recording; sys.exit(any(m in sys.modules for m in ('pyarrow', 'pandas')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

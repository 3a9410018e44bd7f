import subprocess
import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays

from uictest.core.recording import Recording, parquet_bytes, read_parquet

TIME = np.array([0.0, 0.01, 0.02])


def stop():
    return Recording(
        channels={
            "time": TIME,
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


def test_a_folder_named_like_a_partition_is_no_channel(tmp_path):
    folder = tmp_path / "friction=0.10"
    folder.mkdir()
    (folder / "a.parquet").write_bytes(parquet_bytes(stop()))
    assert "friction" not in read_parquet(folder / "a.parquet").channels


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
    pq.write_table(pa.table({"time": [0.0, 1.0], "speed": [3.0, 2.0]}), tmp_path / "a.parquet")
    with pytest.raises(ValueError, match=r"a\.parquet: not a recording: no unit for time, speed"):
        read_parquet(tmp_path / "a.parquet")
    (tmp_path / "a.parquet").write_text("time,speed\n0,1\n")
    with pytest.raises(ValueError, match="not a recording"):
        read_parquet(tmp_path / "a.parquet")


def test_a_file_that_is_not_there_is_an_os_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_parquet(tmp_path / "a.parquet")


@given(arrays.arrays(np.float64, st.integers(0, 40), elements=st.floats(width=64)))
def test_every_float_comes_back_bit_for_bit(tmp_path_factory, samples):
    path = tmp_path_factory.mktemp("floats") / "a.parquet"
    channels = {"time": np.arange(len(samples)) * 0.01, "force": samples}
    path.write_bytes(parquet_bytes(Recording(channels, {"time": "s", "force": "N"})))
    assert read_parquet(path)["force"].tobytes() == samples.tobytes()


def test_a_channel_may_be_a_column_of_records(tmp_path):
    records = np.zeros(3, dtype=[("speed", "f8"), ("force", "f4")])
    records["speed"] = [3.0, 2.0, 1.0]
    written = Recording({"time": TIME, "speed": records["speed"]}, {"time": "s", "speed": "m/s"})
    (tmp_path / "a").write_bytes(parquet_bytes(written))
    np.testing.assert_array_equal(read_parquet(tmp_path / "a")["speed"], [3.0, 2.0, 1.0])


def test_importing_the_room_does_not_import_pyarrow():
    code = (
        "import sys, uictest.core.recording; sys.exit(any(m in sys.modules for m in ('pyarrow', 'pandas')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

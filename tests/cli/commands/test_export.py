from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import Recording, parquet_bytes
from uictest.core.recording.formats import Dialect
from uictest.core.recording.formats.reader import read_here

from ..conftest import rolling_train


@pytest.fixture
def recording(workplace):
    path = workplace / "a[friction=0.10].parquet"
    path.write_bytes(parquet_bytes(rolling_train(0.1)))
    return path


def test_every_format_is_written_with_its_provenance(call, recording):
    answer = call("export", recording, "--to", "mdf,tdms", "--to", "mat,csv", "-o", "out/deep", code=0)
    names = ["a[friction=0.10].mf4", "a[friction=0.10].tdms", "a[friction=0.10].mat", "a[friction=0.10].csv"]
    assert [Path(line).name for line in answer.out.splitlines()] == names
    for name, file in zip(("mdf", "tdms", "mat", "csv"), names, strict=True):
        facts = read_here(name, Path("out/deep", file), Dialect()).metadata
        assert facts["brake_command_time"] == "0 s"
        assert facts["source"] == recording.name
        assert facts["program"].startswith("uictest ")


@pytest.mark.parametrize("name", ["mf4", "MDF", "mdf,mf4"])
def test_a_format_is_known_by_the_suffix_of_its_files_too(call, recording, name):
    assert call("export", recording, "--to", name).out.split() == ["a[friction=0.10].mf4"]


def test_nothing_is_overwritten_unless_forced(call, recording):
    assert call("export", recording, "--to", "csv").code == 0
    call("export", recording, "--to", "csv", code=4, says="already there")
    assert call("export", recording, "--to", "csv", "--force").code == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["one.parquet", "--to", "xlsx"], "xlsx"),
        (["one.parquet", "--to", ""], "--to"),
        (["one.parquet"], "--to"),
        (["missing.parquet", "--to", "csv"], "missing.parquet"),
        (["table.csv", "--to", "mat"], "no channel 'time' in seconds"),
        (["run.csv", "--to", "mat"], "channel 'speed' contains texts, the first in line 3, column 2"),
        (["one.parquet", "b/one.parquet", "--to", "csv"], "one.csv"),
        (["one.parquet", "b/one.parquet", "-o", "stop.mf4"], "one file for 2 recordings"),
    ],
)
def test_what_cannot_be_exported_exits_4_and_leaves_nothing(call, recording, arguments, said):
    recording.rename("one.parquet")
    Path("b").mkdir()
    Path("b/one.parquet").write_bytes(Path("one.parquet").read_bytes())
    Path("table.csv").write_text("a,b\n1,2\n")
    Path("run.csv").write_text("time [s],speed [m/s]\n0,10\n1,n.a.\n")
    before = sorted(Path().rglob("*"))
    call("export", *arguments, code=4, says=said)
    assert sorted(Path().rglob("*")) == before


@pytest.mark.parametrize("suffix", ["csv", "mf4"])
def test_an_export_is_compared_with_its_recording_in_either_order(call, workplace, suffix):
    time = 0.07 + np.arange(500) / 300.0  # without an end in decimals
    channels = {"time": time, "valve_command_1": np.repeat([0.0, 2.0, 1.0, 0.0, 2.0], 100)}
    stop = Recording(channels, {"time": "s", "valve_command_1": "1"})
    Path("stop.parquet").write_bytes(parquet_bytes(stop))
    call("export", "stop.parquet", "-o", f"stop.{suffix}", code=0)
    call("compare", "stop.parquet", f"stop.{suffix}", code=0)
    call("compare", f"stop.{suffix}", "stop.parquet", code=0)


@pytest.mark.parametrize("arguments", [[], ["--to", "mdf"]])
def test_a_file_is_written_in_the_format_of_its_suffix(call, recording, arguments):
    answer = call("export", recording, *arguments, "-o", "out/stop.mf4")
    assert (answer.code, answer.out.split()) == (0, [str(Path("out/stop.mf4"))])
    assert read_here("mdf", Path("out/stop.mf4"), Dialect()).metadata["source"] == recording.name

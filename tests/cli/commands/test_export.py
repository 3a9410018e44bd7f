from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import Recording, parquet_bytes
from uictest.core.recording.formats import Dialect
from uictest.core.recording.formats.isolation import read_here

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

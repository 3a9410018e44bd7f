from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uictest.core.recording import Recording, write_parquet
from uictest.core.recording.formats import Dialect
from uictest.core.recording.formats.reader import read_here

Call = Callable[..., Any]


@pytest.fixture
def recording(workplace: Path) -> Path:
    path = workplace / "a[friction=0.10].parquet"
    time = np.arange(10) * 0.1
    write_parquet(
        Recording({"time": time, "speed": 1.0 - time}, {"time": "s", "speed": "m/s"}, {"case": "a"}), path
    )
    return path


def test_every_format_is_written_with_its_provenance(call: Call, recording: Path) -> None:
    answer = call("export", recording, "--to", "mdf,tdms", "--to", "mat,csv", "-o", "out/deep")
    assert answer.code == 0
    names = ["a[friction=0.10].mf4", "a[friction=0.10].tdms", "a[friction=0.10].mat", "a[friction=0.10].csv"]
    assert [Path(line).name for line in answer.out.splitlines()] == names
    for name, file in zip(("mdf", "tdms", "mat", "csv"), names, strict=True):
        facts = read_here(name, Path("out/deep", file), Dialect()).metadata
        assert facts["case"] == "a"
        assert facts["source"] == recording.name
        assert facts["program"].startswith("uictest ")


@pytest.mark.parametrize("name", ["mf4", "MDF", "mdf,mf4"])
def test_a_format_is_known_by_the_suffix_of_its_files_too(call: Call, recording: Path, name: str) -> None:
    assert call("export", recording, "--to", name).out.split() == ["a[friction=0.10].mf4"]


def test_nothing_is_overwritten_unless_forced(call: Call, recording: Path) -> None:
    assert call("export", recording, "--to", "csv").code == 0
    answer = call("export", recording, "--to", "csv")
    assert answer.code == 4
    assert "already there" in answer.err
    assert call("export", recording, "--to", "csv", "--force").code == 0


@pytest.mark.parametrize(
    "arguments", [["--to", "xlsx"], ["--to", ""], ["missing.parquet", "--to", "csv"], []]
)
def test_usage_errors_exit_4(call: Call, recording: Path, arguments: list[str]) -> None:
    before = sorted(Path().iterdir())
    assert call("export", recording, *arguments).code == 4
    assert sorted(Path().iterdir()) == before


def test_what_is_no_recording_exits_4(call: Call, workplace: Path) -> None:
    Path("table.csv").write_text("a,b\n1,2\n")
    answer = call("export", "table.csv", "--to", "mat")
    assert answer.code == 4
    assert "no channel 'time' in seconds" in answer.err
    assert not Path("table.mat").exists()


def test_two_files_for_one_target_are_refused(call: Call, recording: Path, workplace: Path) -> None:
    (workplace / "b").mkdir()
    copy = workplace / "b" / recording.name
    copy.write_bytes(recording.read_bytes())
    assert call("export", recording, copy, "--to", "csv").code == 4


def test_a_text_among_numbers_is_refused_with_its_place(call: Call, workplace: Path) -> None:
    (workplace / "run.csv").write_text("time [s],speed [m/s]\n0,10\n1,n.a.\n")
    answer = call("export", "run.csv", "--to", "mat")
    assert answer.code == 4
    assert "channel 'speed' contains texts, the first in line 3, column 2" in answer.err
    assert not (workplace / "run.mat").exists()


@pytest.mark.parametrize("arguments", [[], ["--to", "mdf"]])
def test_a_file_is_written_in_the_format_of_its_suffix(
    call: Call, recording: Path, arguments: list[str]
) -> None:
    answer = call("export", recording, *arguments, "-o", "out/stop.mf4")
    assert (answer.code, answer.out.split()) == (0, [str(Path("out/stop.mf4"))])
    assert read_here("mdf", Path("out/stop.mf4"), Dialect()).metadata["case"] == "a"


def test_two_recordings_do_not_go_into_one_file(call: Call, recording: Path) -> None:
    other = recording.with_name("b.parquet")
    other.write_bytes(recording.read_bytes())
    answer = call("export", recording, other, "-o", "stop.mf4")
    assert answer.code == 4
    assert "one file for 2 recordings" in answer.err
    assert not Path("stop.mf4").exists()

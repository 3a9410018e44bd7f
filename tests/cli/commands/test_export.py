"""`uictest export`, `export-rig` and `export-controller`."""

import zipfile
from pathlib import Path

import numpy as np
import pytest

from uictest.api import fmu
from uictest.core.recording import Recording, parquet_bytes
from uictest.core.recording.formats import Dialect
from uictest.core.recording.formats.isolation import read_here

from ..conftest import rolling_train


@pytest.fixture
def recording(workplace):
    path = workplace / "a[friction=0.10].parquet"
    path.write_bytes(parquet_bytes(rolling_train(0.1)))
    return path


def test_a_recording_is_exported_in_every_format_and_replaced_only_when_forced(call, recording):
    answer = call("export", recording, "--to", "mdf,tdms", "--to", "mat,csv", "-o", "out/deep", code=0)
    names = ["a[friction=0.10].mf4", "a[friction=0.10].tdms", "a[friction=0.10].mat", "a[friction=0.10].csv"]
    assert [Path(line).name for line in answer.out.splitlines()] == names
    for name, file in zip(("mdf", "tdms", "mat", "csv"), names, strict=True):
        facts = read_here(name, Path("out/deep", file), Dialect()).metadata
        assert facts["brake_command_time"] == "0 s"
        assert facts["source"] == recording.name
        assert facts["program"].startswith("uictest ")
    assert call("export", recording, "--to", "csv").code == 0
    call("export", recording, "--to", "csv", code=4, says="already there")
    assert call("export", recording, "--to", "csv", "--force").code == 0


@pytest.mark.parametrize("name", ["mf4", "MDF", "mdf,mf4"])
def test_a_format_is_known_by_the_suffix_of_its_files_too(call, recording, name):
    assert call("export", recording, "--to", name).out.split() == ["a[friction=0.10].mf4"]


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


TWO_CASES = "matrix:\n  brake.command: [80 %, 90 %]\n"


@pytest.fixture
def built(monkeypatch):
    """What would be built: case, version and contract. The rig's own tests build FMUs."""
    made = []

    def build(case, version, contract):
        made.append((case.id, version, contract))
        return b"an FMU"

    monkeypatch.setattr(fmu, "build_fmu", build)
    return made


def test_a_case_is_written_the_only_one_or_a_chosen_one_and_force_replaces_a_file(call, scenario, built):
    answer = call("export-rig", scenario("stop"), "-o", "out.fmu")
    assert (answer.code, answer.out, answer.err) == (0, "out.fmu\n", "")
    assert Path("out.fmu").read_bytes() == b"an FMU"
    assert built == [("stop", 2, 1)]
    Path("rig.fmu").write_text("older")
    assert call("export-rig", scenario("stop"), "--force").code == 0
    assert Path("rig.fmu").read_bytes() == b"an FMU"
    case = ("--case", "stop[command=90]", "--force")
    assert call("export-rig", scenario("stop", TWO_CASES), *case, "--fmi", "3", "--contract", "2").code == 0
    assert built[-1] == ("stop[command=90]", 3, 2)


def test_a_package_without_libraries_of_fmus_says_what_to_do_and_leaves_nothing(
    call, scenario, built, monkeypatch
):
    def fail(*arguments):
        raise fmu.CannotBuildError("no machine code for windows-x86_64; reinstall uictest")

    monkeypatch.setattr(fmu, "build_fmu", fail)
    answer = call("export-rig", scenario("stop"), code=4)
    assert answer.err == "uictest: no machine code for windows-x86_64; reinstall uictest\n"
    assert not Path("rig.fmu").exists()


def test_the_program_writes_an_fmu_for_every_system(call, scenario):
    assert call("export-rig", scenario("stop")).code == 0
    with zipfile.ZipFile("rig.fmu") as archive:
        binaries = {name for name in archive.namelist() if name.startswith("binaries/")}
    assert binaries == {
        "binaries/linux64/rig_stop.so",
        "binaries/win64/rig_stop.dll",
        "binaries/aarch64-linux/rig_stop.so",
    }


@pytest.fixture
def template(call):
    """What `uictest init controller --c wsp` writes; its library is not built."""
    call("init", "controller", "--c", "wsp")


def test_a_part_is_exported_from_its_source_and_else_told_how_to_name_it_or_to_build_its_library(
    call, template
):
    answer = call("export-controller", "wsp/wsp.c", code=4)
    assert answer.err == (
        "uictest: wsp/wsp.c: uictest_create failed: parameter lower_slide is missing\n"
        "where a part declares its parameters: uictest export-controller PART --source wsp/wsp.c\n"
    )
    assert not Path("controller.fmu").exists()
    call("export-controller", "wsp/my-wsp.yaml", code=4, says="no such file: 'libwsp.so'")
    answer = call("export-controller", "wsp/my-wsp.yaml", "--source", "wsp/wsp.c", "-o", "wsp.fmu")
    assert (answer.out, answer.err) == ("wsp.fmu\n", "")
    described = Path("stop.yaml")
    described.write_text(
        "schema: uictest/scenario/1\nname: s\ninitial_speed: 9 km/h\ncontroller: {fmu: wsp.fmu}\n"
    )
    answer = call("list", "stop.yaml", "--set", "controller.parameters.upper_slides=0.2", code=4)
    assert "did you mean upper_slide?" in answer.err
    answer = call("list", "stop.yaml", "--set", "controller.parameters.upper_slide=2", code=4)
    assert "accepted: 0 to 1" in answer.err


def test_a_file_that_is_there_stays_without_force(call):
    Path("controller.fmu").write_text("older")
    call("export-controller", "slip-band", code=4, says="already there: controller.fmu; --force replaces it")
    call("export-controller", "slip-band", "--force")
    assert Path("controller.fmu").read_bytes().startswith(b"PK")

import zipfile
from pathlib import Path

import pytest

from uictest.api import fmu

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


def test_the_only_case_is_written_and_force_replaces_a_file(call, scenario, built):
    answer = call("export-rig", scenario("stop"), "-o", "out.fmu")
    assert (answer.code, answer.out, answer.err) == (0, "out.fmu\n", "")
    assert Path("out.fmu").read_bytes() == b"an FMU"
    assert built == [("stop", 2, 1)]
    Path("rig.fmu").write_text("older")
    assert call("export-rig", scenario("stop"), "--force").code == 0
    assert Path("rig.fmu").read_bytes() == b"an FMU"


def test_one_of_several_cases_is_chosen(call, scenario, built):
    case = ("--case", "stop[command=90]")
    assert call("export-rig", scenario("stop", TWO_CASES), *case, "--fmi", "3", "--contract", "2").code == 0
    assert built == [("stop[command=90]", 3, 2)]


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


def test_the_template_is_exported_from_its_source_and_keeps_the_part(call, template):
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


def test_a_source_whose_parameters_a_part_declares_says_how_to_name_it(call, template):
    answer = call("export-controller", "wsp/wsp.c", code=4)
    assert answer.err == (
        "uictest: wsp/wsp.c: uictest_create failed: parameter lower_slide is missing\n"
        "where a part declares its parameters: uictest export-controller PART --source wsp/wsp.c\n"
    )
    assert not Path("controller.fmu").exists()


def test_the_library_of_a_part_has_to_be_built(call, template):
    call("export-controller", "wsp/my-wsp.yaml", code=4, says="no such file: 'libwsp.so'")


def test_a_file_that_is_there_stays_without_force(call):
    Path("controller.fmu").write_text("older")
    call("export-controller", "slip-band", code=4, says="already there: controller.fmu; --force replaces it")
    call("export-controller", "slip-band", "--force")
    assert Path("controller.fmu").read_bytes().startswith(b"PK")

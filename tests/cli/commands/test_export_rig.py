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


def test_a_contract_that_there_is_not_is_refused(call, scenario, built):
    answer = call("export-rig", scenario("stop"), "--contract", "3", code=4)
    assert "3 is no version, expected 1 or 2" in answer.err
    assert built == []


def test_several_cases_are_refused_with_their_ids_and_an_unknown_one_exits_5(call, scenario, built):
    answer = call("export-rig", scenario("stop", TWO_CASES), code=4)
    assert answer.err == (
        "uictest: 2 cases; an FMU holds one: choose it with --case ID\nstop[command=80]\nstop[command=90]\n"
    )
    assert not Path("rig.fmu").exists()
    answer = call("export-rig", scenario("stop", TWO_CASES), "--case", "stop", code=5)
    assert answer.err.endswith("stop[command=80]\nstop[command=90]\n")


@pytest.mark.parametrize(
    ("target", "code", "reason"),
    [
        ("rig.zip", 4, "rig.zip: the name of an FMU ends with .fmu"),
        ("no/where.fmu", 3, "cannot write no/where.fmu: No such file or directory"),
        ("there.fmu", 4, "already there: there.fmu; --force replaces it"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_anything_is_read(call, built, target, code, reason):
    Path("there.fmu").write_text("older")
    answer = call("export-rig", "no-such.yaml", "-o", target)
    assert (answer.code, answer.err) == (code, f"uictest: {reason}\n")


def test_a_package_without_libraries_of_fmus_says_what_to_do_and_leaves_nothing(
    call, scenario, built, monkeypatch
):
    def fail(*arguments):
        raise fmu.CannotBuildError("no machine code for windows-x86_64; reinstall uictest")

    monkeypatch.setattr(fmu, "build_fmu", fail)
    answer = call("export-rig", scenario("stop"), code=4)
    assert answer.err == "uictest: no machine code for windows-x86_64; reinstall uictest\n"
    assert not Path("rig.fmu").exists()


def test_an_invalid_file_exits_4(call, scenario, built):
    call("export-rig", scenario("stop", "brake: {command: 200 %}\n"), code=4, says="scenarios/stop.yaml:4:")


def test_a_train_is_refused_whichever_car_is_chosen(call, scenario):
    path = scenario("stop", "train: [{count: 2}]\n")
    for chosen in ((), ("--case", "stop[car=1]")):
        answer = call("export-rig", path, *chosen, code=4)
        assert "stop[car=1] is car 1 of 2: here a car runs alone" in answer.err


def test_the_program_writes_an_fmu_for_every_system(call, scenario):
    assert call("export-rig", scenario("stop")).code == 0
    with zipfile.ZipFile("rig.fmu") as archive:
        binaries = {name for name in archive.namelist() if name.startswith("binaries/")}
    assert binaries == {
        "binaries/linux64/rig_stop.so",
        "binaries/win64/rig_stop.dll",
        "binaries/aarch64-linux/rig_stop.so",
    }

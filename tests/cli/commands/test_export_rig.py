import zipfile
from pathlib import Path
from typing import Any

import pytest

from uictest.api import rig_fmu

from ..conftest import Call, Write

TWO_CASES = "matrix:\n  brake.command: [80 %, 90 %]\n"


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """What would be built: case and version. The rig's own tests build FMUs."""
    made: list[tuple[str, int]] = []

    def build(case: Any, version: int, compiler: str) -> bytes:
        made.append((case.id, version))
        return b"an FMU"

    monkeypatch.setattr(rig_fmu, "usable_compiler", lambda: "cc")
    monkeypatch.setattr(rig_fmu, "build_fmu", build)
    return made


def test_the_only_case_is_written_and_its_file_printed(
    call: Call, scenario: Write, built: list[tuple[str, int]]
) -> None:
    answer = call("export-rig", scenario("stop"), "-o", "out.fmu")
    assert (answer.code, answer.out, answer.err) == (0, "out.fmu\n", "")
    assert Path("out.fmu").read_bytes() == b"an FMU"
    assert built == [("stop", 2)]


@pytest.mark.parametrize("selection", [("--case", "stop[command=90]"), ("-k", "90")])
def test_one_of_several_cases_is_chosen(
    call: Call, scenario: Write, built: list[tuple[str, int]], selection: tuple[str, str]
) -> None:
    assert call("export-rig", scenario("stop", TWO_CASES), *selection, "--fmi", "3").code == 0
    assert built == [("stop[command=90]", 3)]


def test_several_cases_are_refused_with_their_ids(
    call: Call, scenario: Write, built: list[tuple[str, int]]
) -> None:
    answer = call("export-rig", scenario("stop", TWO_CASES))
    assert answer.code == 4
    assert answer.err == (
        "uictest: 2 cases; an FMU holds one: choose it with --case ID\nstop[command=80]\nstop[command=90]\n"
    )
    assert not Path("rig.fmu").exists()


def test_an_unknown_case_exits_5_and_lists_the_cases(
    call: Call, scenario: Write, built: list[tuple[str, int]]
) -> None:
    answer = call("export-rig", scenario("stop", TWO_CASES), "--case", "stop")
    assert answer.code == 5
    assert answer.err.endswith("stop[command=80]\nstop[command=90]\n")


@pytest.mark.parametrize(
    ("target", "reason"),
    [
        ("rig.zip", "rig.zip: the name of an FMU ends with .fmu"),
        ("no/where.fmu", "no/where.fmu: there is no folder no"),
        ("there.fmu", "already there: there.fmu; --force replaces it"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_anything_is_read(
    call: Call, built: list[tuple[str, int]], target: str, reason: str
) -> None:
    Path("there.fmu").write_text("older")
    answer = call("export-rig", "no-such.yaml", "-o", target)
    assert (answer.code, answer.err) == (4, f"uictest: {reason}\n")


def test_force_replaces_a_file(call: Call, scenario: Write, built: list[tuple[str, int]]) -> None:
    Path("rig.fmu").write_text("older")
    assert call("export-rig", scenario("stop"), "--force").code == 0
    assert Path("rig.fmu").read_bytes() == b"an FMU"


def test_a_machine_without_a_compiler_is_told_before_anything_is_compiled(
    call: Call, scenario: Write, built: list[tuple[str, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing() -> str:
        raise rig_fmu.CannotBuildError("no C compiler (cc)")

    monkeypatch.setattr(rig_fmu, "usable_compiler", missing)
    answer = call("export-rig", scenario("stop"))
    assert (answer.code, answer.err) == (4, "uictest: no C compiler (cc)\n")
    assert built == []


def test_a_compiler_that_fails_exits_3_and_leaves_nothing(
    call: Call, scenario: Write, built: list[tuple[str, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*arguments: Any) -> bytes:
        raise RuntimeError("ld: no space left")

    monkeypatch.setattr(rig_fmu, "build_fmu", fail)
    answer = call("export-rig", scenario("stop"))
    assert answer.code == 3
    assert "ld: no space left" in answer.err
    assert not Path("rig.fmu").exists()


def test_an_invalid_file_exits_4(call: Call, scenario: Write, built: list[tuple[str, int]]) -> None:
    answer = call("export-rig", scenario("stop", "brake: {command: 200 %}\n"))
    assert answer.code == 4
    assert "scenarios/stop.yaml:4:" in answer.err


def test_the_program_writes_an_fmu(call: Call, scenario: Write) -> None:
    try:
        rig_fmu.usable_compiler()
    except rig_fmu.CannotBuildError as error:
        pytest.skip(str(error))
    assert call("export-rig", scenario("stop")).code == 0
    with zipfile.ZipFile("rig.fmu") as archive:
        assert "binaries/linux64/rig_stop.so" in archive.namelist()

"""`--trust`: folders that references may lead into; and what foreign code they lead to, a run alone runs."""

import os
import zipfile
from pathlib import Path

import pytest

from ..c_compiler import build_library

HEAD = "schema: uictest/scenario/1\nname: stop\n"
SWEEP = "schema: uictest/scenario/1\nname: s\nextends: stop.yaml\nvary: {matrix: {seed: [1, 2]}}\n"


@pytest.fixture
def inside(workplace, monkeypatch):
    """A working folder whose scenario extends one in a folder beside it."""
    for name in ("inside", "beside"):
        (workplace / name).mkdir()
    (workplace / "beside" / "base.yaml").write_text(HEAD + "initial_speed: 30 km/h\n")
    (workplace / "inside" / "stop.yaml").write_text(HEAD + "extends: ../beside/base.yaml\n")
    (workplace / "inside" / "s.sweep.yaml").write_text(SWEEP)
    monkeypatch.chdir(workplace / "inside")
    return workplace / "inside"


READING = [
    *("check stop.yaml", "check s.sweep.yaml", "list stop.yaml", "list s.sweep.yaml"),
    *("run stop.yaml --dry-run", "sweep s.sweep.yaml --dry-run"),
]


@pytest.mark.parametrize("command", [*READING, "check ."])
def test_a_reference_out_of_the_folders_given_needs_trust(call, inside, command):
    refused = call(*command.split(), code=4, says=f"'../beside/base.yaml' leads out of {inside}")
    assert f"add --trust {inside.parent / 'beside'}, or UICTEST_TRUST=" in refused.err
    assert call(*command.split(), "--trust", "../beside").code == 0


@pytest.mark.parametrize("command", ["check", "list", "run", "sweep s.sweep.yaml", "evaluate stop.csv"])
def test_commands_that_read_scenarios_take_folders_to_trust(call, inside, command):
    answer = call(*command.split(), "--trust", "missing", code=4, says="'--trust'")
    assert "missing" in answer.err


def test_folders_of_the_option_and_of_the_environment_are_trusted_together(call, inside, monkeypatch):
    monkeypatch.setenv("UICTEST_TRUST", "../beside")
    assert call("list", "stop.yaml", "--trust", ".").code == 0


@pytest.mark.parametrize(
    "command",
    [
        *("check", "fit stop.csv --scenario stop.yaml", "bench triangular", "identify hysteresis stop.csv"),
        *("export-rig stop.yaml --case none", "library show stop.yaml"),
    ],
)
def test_every_command_takes_folders_to_trust_from_the_environment(call, inside, monkeypatch, command):
    monkeypatch.setenv("UICTEST_TRUST", f"missing{os.pathsep}.")
    call(*command.split(), code=4, says="UICTEST_TRUST")
    monkeypatch.setenv("UICTEST_TRUST", f".{os.pathsep}../beside")
    assert "leads out of" not in call(*command.split()).err


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("car.yaml", "schema: uictest/vehicle/1\nextends: %s\n"),
        ("map.yaml", "schema: uictest/channel-map/1\nname: m\nchannels: {}\nextends: %s\n"),
    ],
)
def test_the_file_of_a_part_is_shown_with_what_lies_beside_it(call, inside, monkeypatch, name, text):
    beside = inside.parent / "beside"
    (beside / "own.yaml").write_text(text % {"car.yaml": "crh380a", "map.yaml": "uictest"}[name])
    (beside / name).write_text(text % "own.yaml")
    (inside / name).write_text(text % "../beside/own.yaml")
    assert call("library", "show", beside / name).code == 0
    assert call("library", "show", name).code == 4
    monkeypatch.setenv("UICTEST_TRUST", str(beside))
    assert call("library", "show", name).code == 0


def test_links_and_parts_that_lead_out_are_named_by_file_and_key(call, inside):
    secret = inside.parent / "beside" / "secret.txt"
    secret.write_text("top secret\n")
    Path("sub").mkdir()
    Path("sub/x.sweep.yaml").symlink_to(secret)
    answer = call("check", "sub", code=4)
    assert "sub/x.sweep.yaml:1:1: a link that leads out of the folders given" in answer.err
    assert "top secret" not in answer.err
    (inside / "mine.yaml").write_text("schema: uictest/controller/1\nname: mine\nextends: ../beside/c.yaml\n")
    assert "mine.yaml:3:10: extends: '../beside/c.yaml' leads out" in call("library", "show", "mine.yaml").err


DESCRIPTION = '<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0" modelName="wsp" version="1"/>'


def _program(path, mark):
    path.write_text(
        f"open({str(mark)!r}, 'w').close()\nclass Wsp: ...\n"
        "PARAMETERS = {'share': {'default': 0.0, 'unit': '1'}}\n"
    )
    return f"{{python: {path.name}, class: Wsp, parameters: {{share: 0.5}}}}"


def _library(path, mark):
    """Compile a library that creates a file as soon as it is loaded."""
    source = path.with_suffix(".c")
    source.write_text(
        "#include <stdio.h>\n"
        f'__attribute__((constructor)) static void load(void) {{ fclose(fopen("{mark}", "w")); }}\n'
    )
    build_library(path, source)
    path.chmod(0o644)
    return f"{{library: {path.name}}}"


def _fmu(path, mark):
    """Write an FMU whose binary creates a file as soon as it is loaded."""
    _library(path.with_name("inside.so"), mark)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION)
        archive.write(path.with_name("inside.so"), "binaries/linux64/wsp.so")
    return f"{{fmu: {path.name}}}"


@pytest.mark.parametrize(("name", "write"), [("wsp.py", _program), ("wsp.so", _library), ("wsp.fmu", _fmu)])
def test_foreign_code_is_loaded_by_a_run_and_by_nothing_that_only_reads_files(call, workplace, name, write):
    mark = workplace / "loaded"
    controller = write(workplace / name, mark)
    (workplace / "stop.yaml").write_text(f"{HEAD}initial_speed: 20 km/h\ncontroller: {controller}\n")
    (workplace / "s.sweep.yaml").write_text(SWEEP)
    for command in (*READING, "schema"):
        call(*command.split(), code=0)
        assert not mark.exists(), command
    if name != "wsp.fmu":
        # So that the lines above prove something; what is loaded here is no controller.
        call("run", "stop.yaml", code=3)
        assert mark.exists()

"""An FMU built from the threshold controller in C is the built-in controller, bit for bit."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from fmpy.validation import validate_fmu

from uictest import rig
from uictest.plans.scenario import Case, load
from uictest.rig.external.in_process import run_in_process
from uictest.rig.external.workers import Workers

from .conftest import EXAMPLES, WithController, bits


@pytest.fixture(scope="session", params=[2, 3], ids=["FMI 2.0", "FMI 3.0"])
def fmu(request: pytest.FixtureRequest, compiler: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """examples/fmu/wsp.fmu, built as the scenario beside it says."""
    threshold = EXAMPLES / "threshold-c"
    path = tmp_path_factory.mktemp("fmu") / "wsp.fmu"
    options = ["--scenario", threshold / "threshold.yaml", "-o", path, "--fmi", str(request.param)]
    command = [sys.executable, EXAMPLES / "fmu" / "build.py", threshold / "threshold.c", *options]
    subprocess.run(command, check=True, env={**os.environ, "CC": compiler})
    return path


@pytest.fixture(autouse=True)
def temporary_folder(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    """FMUs stay unpacked until Python ends."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path_factory.mktemp("unpacked")))


def test_it_is_a_valid_fmu(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []


def test_every_shipped_stop_has_the_bits_of_the_built_in_controller(
    shipped: list[Case], built_in: list[bytes], fmu: Path, with_controller: WithController
) -> None:
    different = [
        case.id
        for case, expected in zip(shipped, built_in, strict=True)
        if bits(rig.simulate(with_controller(case, fmu), run=run_in_process)) != expected
    ]
    assert different == []


def test_the_example_scenario_runs_in_a_child_process_and_leaves_no_file(
    fmu: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The child is ended by a signal: what it unpacked lies in a folder of its parent."""
    shutil.copy(fmu, tmp_path)
    shutil.copy(EXAMPLES / "fmu" / "wsp.yaml", tmp_path)
    case = load([tmp_path / "wsp.yaml"])[0]
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    with Workers() as workers:
        there = rig.simulate(case, run=workers.run)
        assert list(folder.rglob("modelDescription.xml")) != []
    assert list(folder.iterdir()) == []
    assert bits(there) == bits(rig.simulate(case, run=run_in_process))


def test_check_reads_no_fmu(tmp_path: Path) -> None:
    """It takes the SHA-256 alone: a file that is no FMU at all passes."""
    shutil.copy(EXAMPLES / "fmu" / "wsp.yaml", tmp_path)
    (tmp_path / "wsp.fmu").write_text("no FMU")
    command = [sys.executable, "-c", "from uictest.cli import main; main()", "check", "wsp.yaml"]
    checked = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (checked.returncode, checked.stderr) == (0, "uictest: 1 scenario with 1 case, no error\n")


def test_a_run_in_this_process_leaves_no_file(fmu: Path, tmp_path: Path) -> None:
    shutil.copy(fmu, tmp_path)
    shutil.copy(EXAMPLES / "fmu" / "wsp.yaml", tmp_path)
    folder = tmp_path / "temporary"
    folder.mkdir()
    program = "from uictest.cli import main; main()"
    command = [sys.executable, "-c", program, "run", "wsp.yaml", "--in-process"]
    subprocess.run(command, cwd=tmp_path, env={**os.environ, "TMPDIR": str(folder)}, check=True)
    assert list(folder.iterdir()) == []

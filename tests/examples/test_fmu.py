"""The threshold controller in C, exported as an FMU, is the built-in controller, bit for bit."""

import os
import shutil
import subprocess
import sys

import pytest
from fmpy.validation import validate_fmu

from uictest import rig
from uictest.plans.scenario import load
from uictest.rig.external.in_process import run_in_process
from uictest.rig.external.workers import Workers

from .conftest import bits

STOP = """\
schema: uictest/scenario/1
name: wsp-fmu
initial_speed: 80 km/h
rail: {condition: wet, friction: 0.09}
controller: {fmu: wsp.fmu, parameters: {slip_threshold: 0.9993, vent_deceleration: 6.98}}
"""


@pytest.fixture(scope="session", params=["2", "3"], ids=["FMI 2.0", "FMI 3.0"])
def fmu(request, threshold_library, compiler, tmp_path_factory):
    """examples/threshold-c, built and exported."""
    path = tmp_path_factory.mktemp("fmu") / "wsp.fmu"
    command = [*PROGRAM, "export-controller", "threshold.yaml", "-o", path, "--fmi", request.param]
    environment = {**os.environ, "CC": compiler}
    subprocess.run(command, cwd=threshold_library.parent, check=True, env=environment)
    return path


PROGRAM = [sys.executable, "-c", "from uictest.cli import main; main()"]


@pytest.fixture(autouse=True)
def scenario(tmp_path):
    """A stop with an FMU beside it, which is none until it is copied."""
    path = tmp_path / "wsp.yaml"
    path.write_text(STOP)
    path.with_suffix(".fmu").write_text("no FMU")
    return path


@pytest.fixture(autouse=True)
def temporary_folder(monkeypatch, tmp_path_factory):
    """FMUs stay unpacked until Python ends."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path_factory.mktemp("unpacked")))


def test_it_is_a_valid_fmu(fmu):
    assert validate_fmu(str(fmu)) == []


def test_every_shipped_stop_has_the_bits_of_the_built_in_controller(shipped, built_in, fmu, with_controller):
    different = [
        case.id
        for case, expected in zip(shipped, built_in, strict=True)
        if bits(rig.simulate(with_controller(case, fmu), run=run_in_process)) != expected
    ]
    assert different == []


def test_it_runs_in_a_child_process_and_leaves_no_file(fmu, scenario, tmp_path, monkeypatch):
    """The child is ended by a signal: what it unpacked lies in a folder of its parent."""
    shutil.copy(fmu, tmp_path)
    case = load([scenario])[0]
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    with Workers() as workers:
        there = rig.simulate(case, run=workers.run)
        assert list(folder.rglob("modelDescription.xml")) != []
    assert list(folder.iterdir()) == []
    assert bits(there) == bits(rig.simulate(case, run=run_in_process))


def test_check_reads_no_fmu(tmp_path):
    """It takes the SHA-256 alone: a file that is no FMU at all passes."""
    checked = subprocess.run([*PROGRAM, "check", "wsp.yaml"], cwd=tmp_path, capture_output=True, text=True)
    assert (checked.returncode, checked.stderr) == (0, "uictest: 1 scenario with 1 case, no error\n")


def test_a_run_in_this_process_leaves_no_file(fmu, scenario, tmp_path):
    shutil.copy(fmu, tmp_path)
    folder = tmp_path / "temporary"
    folder.mkdir()
    command = [*PROGRAM, "run", scenario.name, "--in-process"]
    subprocess.run(command, cwd=tmp_path, env={**os.environ, "TMPDIR": str(folder)}, check=True)
    assert list(folder.iterdir()) == []

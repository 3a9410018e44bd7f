"""Controllers that fail in every way, as files beside a scenario."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from uictest.controllers import HEADER
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.noise_key import StopInputs

HERE = Path(__file__).parent
Compile = Callable[..., Path]
StopOf = Callable[..., StopInputs]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with a scenario and a controller in Python."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(HERE / "bad.py", tmp_path)
    (tmp_path / "stop.yaml").write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\n", "utf-8"
    )
    return tmp_path


@pytest.fixture
def library(folder: Path) -> Compile:
    """Compile bad.c and return the library."""
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    if compiler is None:
        pytest.skip("no C compiler")

    def compiled(*options: str, name: str = "libbad.so") -> Path:
        command = [
            compiler,
            "-O1",
            "-fPIC",
            "-shared",
            f"-I{HEADER.parent}",
            *options,
            "-o",
            folder / name,
            HERE / "bad.c",
        ]
        subprocess.run(command, check=True)
        return folder / name

    return compiled


@pytest.fixture
def stop_of(folder: Path) -> StopOf:
    """A stop from 30 km/h with a controller; its fault comes in a cycle."""

    def inputs(fault: str = "none", at: int = 700, limit: str = "60 s", **program: str) -> StopInputs:
        program = program or {"python": "bad.py", "class": "Bad"}
        written = "".join(f", {key}: {value}" for key, value in program.items())
        controller = f"{{parameters: {{fault: {fault}, at: {at}}}, time_limit: {limit}{written}}}"
        scenario = folder / "stop.yaml"
        text = scenario.read_text("utf-8").partition("controller:")[0]
        scenario.write_text(f"{text}controller: {controller}\n", "utf-8")
        return assemble(load([scenario])[0])

    return inputs

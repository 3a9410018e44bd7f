"""Controllers that fail in every way, as files beside a scenario."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from uictest.controllers import HEADER
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.external.block import BlockInputs
from uictest.rig.external.workers import Workers
from uictest.rig.single_stop import StopInputs

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


@pytest.fixture(scope="session")
def _built(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Compile bad.c, once for each set of options."""
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    if compiler is None:
        pytest.skip("no C compiler")

    @cache
    def built(*options: str) -> Path:
        library = tmp_path_factory.mktemp("bad") / "libbad.so"
        command = [compiler, "-O1", "-fPIC", "-shared", f"-I{HEADER.parent}", *options]
        subprocess.run([*command, "-o", library, HERE / "bad.c"], check=True)
        return library

    return built


@pytest.fixture
def library(folder: Path, _built: Callable[..., Path]) -> Compile:
    """Put the library of bad.c into the working folder."""

    def compiled(*options: str, name: str = "libbad.so") -> Path:
        return Path(shutil.copy(_built(*options), folder / name))

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


@pytest.fixture(scope="module")
def workers() -> Iterator[Workers]:
    """Child processes that the tests of a module share."""
    with Workers() as open_workers:
        yield open_workers


@pytest.fixture(scope="session")
def block_of() -> Callable[[Sequence[StopInputs]], BlockInputs]:
    """Put stops into a block."""

    def block(stops: Sequence[StopInputs]) -> BlockInputs:
        programs, configs = ([getattr(stop, name) for stop in stops] for name in ("program", "config"))
        records = ("parameters", "wheelset_parameters", "rail")
        numbers = (np.array([getattr(stop, name) for stop in stops]) for name in records)
        return BlockInputs(programs, configs, *numbers)

    return block

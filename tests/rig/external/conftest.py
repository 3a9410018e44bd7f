"""Controllers that fail in every way, as files beside a scenario."""

import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.external.workers import Workers

from ...c_compiler import build_library

HERE = Path(__file__).parent
Compile = Callable[..., Path]


@pytest.fixture(scope="module")
def _place(tmp_path_factory):
    """Where the programs of a module lie: a child process serves those of one place, for all its tests."""
    return tmp_path_factory.mktemp("programs")


@pytest.fixture
def folder(_place, monkeypatch):
    """The working folder, with a scenario and a controller in Python and nothing else."""
    monkeypatch.chdir(_place)
    for left in _place.iterdir():
        shutil.rmtree(left) if left.is_dir() else left.unlink()
    shutil.copy(HERE / "bad.py", _place)
    (_place / "stop.yaml").write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\n", "utf-8"
    )
    return _place


@pytest.fixture(scope="session")
def _built(tmp_path_factory):
    """Compile bad.c, once for each set of options."""

    @cache
    def built(*options):
        library = tmp_path_factory.mktemp("bad") / "libbad.so"
        build_library(library, *options, HERE / "bad.c")
        return library

    return built


@pytest.fixture
def library(folder, _built):
    """Put the library of bad.c into the working folder."""

    def compiled(*options, name="libbad.so"):
        return Path(shutil.copy(_built(*options), folder / name))

    return compiled


@pytest.fixture
def stop_of(folder):
    """A stop from 30 km/h with a controller; its fault comes in a cycle."""

    def inputs(fault="none", at=700, limit="60 s", **program):
        program = program or {"python": "bad.py", "class": "Bad"}
        written = "".join(f", {key}: {value}" for key, value in program.items())
        controller = f"{{parameters: {{fault: {fault}, at: {at}}}, time_limit: {limit}{written}}}"
        scenario = folder / "stop.yaml"
        text = scenario.read_text("utf-8").partition("controller:")[0]
        scenario.write_text(f"{text}controller: {controller}\n", "utf-8")
        return assemble(load([scenario])[0])

    return inputs


@pytest.fixture(scope="module")
def workers():
    """Child processes that the tests of a module share."""
    with Workers() as open_workers:
        yield open_workers

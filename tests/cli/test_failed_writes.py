"""What cannot be written ends every command alike: exit code 3, the name of the target, nothing by halves."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import parquet_bytes

from .conftest import STATED, caliper, rolling_train

SUFFIXES = {"page": ".html", "recording": ".csv", "fmu": ".fmu", "part": ".yaml", "junit": ".xml"}
WRITING = {
    "run": ["run", "-o", "FOLDER"],
    "run, JUnit": ["run", "--junitxml", "FILE.junit"],
    "run, new baseline": ["run", "--baseline", "FOLDER", "--accept"],
    "evaluate": ["evaluate", "stop.parquet", *STATED, "-o", "FOLDER"],
    "evaluate, JUnit": ["evaluate", "stop.parquet", *STATED, "--junitxml", "FILE.junit"],
    "log": ["log", "log.csv", *STATED, "-o", "FOLDER"],
    "log, stops": ["log", "log.csv", *STATED, "--recordings", "FOLDER"],
    "log, JUnit": ["log", "log.csv", *STATED, "--junitxml", "FILE.junit"],
    "sweep": ["sweep", "two.sweep.yaml", "-o", "FOLDER"],
    "sweep, JUnit": ["sweep", "two.sweep.yaml", "--junitxml", "FILE.junit"],
    "validate": ["validate", "my.validation.yaml", "-o", "FOLDER"],
    "fit": ["fit", "stop.parquet", "--scenario", "scenarios/stop.yaml", "-o", "FOLDER"],
    "report": ["report", "earlier/latest", "-o", "FOLDER"],
    "compare": ["compare", "stop.parquet", "stop.parquet", "--html", "FILE.page"],
    "controller check": ["controller", "check", "threshold", "--html", "FILE.page"],
    "controller check, JUnit": ["controller", "check", "threshold", "--junitxml", "FILE.junit"],
    "selftest, JUnit": ["selftest", "--junitxml", "FILE.junit"],
    "export": ["export", "stop.parquet", "--to", "csv", "-o", "FOLDER"],
    "export, file": ["export", "stop.parquet", "-o", "FILE.recording"],
    "bench": ["bench", "six-inch-hysteresis", "-o", "FILE.recording"],
    "identify": ["identify", "hysteresis", "lines.parquet", "-o", "FILE.part"],
    "export-rig": ["export-rig", "scenarios/stop.yaml", "-o", "FILE.fmu"],
    "export-controller": ["export-controller", "threshold", "-o", "FILE.fmu"],
    "init": ["init", "FOLDER"],
    "init, scenarios": ["init", "--scenarios", "FOLDER"],
    "init controller": ["init", "controller", "--python", "FOLDER"],
    "init controller in C": ["init", "controller", "--c", "FOLDER"],
    "schema": ["schema", "--all", "FOLDER"],
}
COMPUTED_FIRST = {"fit", "identify"}
"""What only a result can be written of: a place that cannot be is found after it."""
LONG_RUNNING = COMPUTED_FIRST | {"bench", "export-rig", "export-controller", "selftest, JUnit"}
LONG_RUNNING |= {"controller check", "controller check, JUnit"}
PLACES = {
    "through a file": "file/inner",
    "through nothing": "/proc/none/inner",
    "in a circle": "circle/inner",
    "too long": "n" * 300,
}
EARLIER = {"run, new baseline", "log"}
"""What has written something complete before."""


@pytest.fixture(autouse=True)
def made(call, scenario, made_up, monkeypatch):
    """What the commands read, and stops that are not simulated."""
    scenario("stop", "rail: {condition: dry}\n")
    text = "schema: uictest/scenario/1\nname: two\nextends: scenarios/stop.yaml\n"
    Path("two.sweep.yaml").write_text(text + "vary: {matrix: {seed: [1, 2]}}\n")
    Path("stop.parquet").write_bytes(parquet_bytes(rolling_train()))
    Path("lines.parquet").write_bytes(parquet_bytes(caliper()))
    _write_log()
    text = "schema: uictest/validation/1\nname: my\nstops:\n"
    text += "  - {scenario: scenarios/stop.yaml, recordings: [stop.parquet]}\n"
    Path("my.validation.yaml").write_text(text)
    call("run", "-o", "earlier", "--report", "csv", code=0)
    made_up.clear()
    Path("file").touch()
    Path("circle").symlink_to("circle")
    return made_up


def _write_log():
    """Two stops from 72 km/h, one after the other."""
    time = np.arange(0.0, 120.0, 0.05)
    since = np.mod(time, 60.0)
    speed = np.where(since < 50.0, np.clip(20.0 - (since - 20.0), 0.0, 20.0), 2.0 * (since - 50.0))
    braked = np.where((since >= 20.0) & (since < 50.0), 1.0, 0.0)
    channels = {"time": time, "speed": speed, "brake_command": braked}
    rows = zip(*channels.values(), strict=True)
    lines = ["time [s],speed [m/s],brake_command [1]", *(",".join(f"{x:g}" for x in row) for row in rows)]
    Path("log.csv").write_text("\n".join(lines) + "\n")


def arguments_for(name, place):
    kinds = {"FOLDER": place, **{f"FILE.{kind}": place + suffix for kind, suffix in SUFFIXES.items()}}
    return [kinds.get(argument, argument) for argument in WRITING[name]]


def tree():
    return {path: path.is_file() and path.read_bytes() for path in sorted(Path().rglob("*"))}


def _named(place):
    """Return how a message may begin: with the target, or with the folder that it would be in."""
    return tuple(f"uictest: cannot write {each}" for each in (place, Path(place).parent))


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
@pytest.mark.parametrize("name", [name for name in WRITING if name not in LONG_RUNNING])
def test_a_place_that_cannot_be_is_named(call, made, name, place):
    if name == "run, new baseline" and place == PLACES["too long"]:
        return  # it is read first
    before = tree()
    answer = call(*arguments_for(name, place), code=3)
    assert answer.err.splitlines()[-1].startswith(_named(place))
    assert made == [] or name in {"run, new baseline", "validate"} or "log" in name
    assert tree() == before or name in EARLIER


@pytest.mark.parametrize("name", sorted(LONG_RUNNING))
def test_nothing_is_computed_for_a_place_that_cannot_be_unless_it_says_so(call, name):
    answer = call(*arguments_for(name, "file/inner"), code=3)
    assert answer.err.splitlines()[-1].startswith(_named("file/inner"))
    assert answer.out == "" or name in COMPUTED_FIRST


@pytest.fixture
def fill(monkeypatch):
    """Let the disk be full after so many files."""

    def fill(files):
        synced = []

        def sync(descriptor):
            synced.append(descriptor)
            if len(synced) > files:
                raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(os, "fsync", sync)

    return fill


@pytest.mark.parametrize("name", [name for name in WRITING if name not in LONG_RUNNING])
def test_a_full_disk_ends_every_command_alike_and_leaves_nothing(call, fill, name):
    before = tree()
    fill(0)
    target = "new/inner" if "FOLDER" in WRITING[name] else "inner"
    last = call(*arguments_for(name, target), code=3).err.splitlines()[-1]
    assert last.startswith("uictest: cannot write ")
    assert last.endswith(": No space left on device")
    after = tree()
    assert after == before or "sweep" in name or name == "report", after.keys() - before.keys()


@pytest.mark.parametrize("name", ["init", "init, scenarios", "init controller", "schema", "log, stops"])
def test_a_disk_that_fills_up_meanwhile_leaves_nothing_half_written(call, fill, name):
    Path("place").mkdir()
    Path("place", "own.txt").write_text("of the user")
    if name == "log, stops":
        Path("place", "own.txt").unlink()
        call(*arguments_for(name, "place"), code=1)
    before = tree()
    fill(1)
    answer = call(*arguments_for(name, "place"), code=3)
    assert "place/" in answer.err.splitlines()[-1]
    assert tree() == before


def test_what_was_exported_before_the_disk_was_full_is_announced_and_stays(call, fill):
    fill(1)
    answer = call("export", "stop.parquet", "--to", "csv,parquet", "-o", "new", code=3)
    assert answer.out.split() == [str(path) for path in Path("new").iterdir()] == ["new/stop.csv"]
    assert answer.err == "uictest: cannot write new/stop.parquet: No space left on device\n"

"""A project of somebody else, with scenarios, that is tested by pytest; with workers in processes."""

import contextlib
import io
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch
from xml.etree import ElementTree

import pytest

# pytest would load the plugin a second time if it found its entry point as well.
_PLUGIN = ["-p", "uictest.api.pytest_plugin"]
_ENVIRONMENT = {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTEST_ADDOPTS": ""}
HANGING = 600.0
"""Seconds after which a test takes something for hanging: no machine is so busy that it takes this long."""

SCENARIO = "schema: uictest/scenario/1\nname: {name}\ninitial_speed: 30 km/h\n{text}"
SHORT_STOPS = """\
schema: uictest/criteria/1
name: short-stops
sources: {ours: {mark: chosen, text: A limit that the stops of these tests miss}}
criteria:
  - id: distance
    title: A stop of at most 35 m
    source: ours
    requirements: [BR-2]
    layer: requirement
    measure: braking_distance
    upper: {value: 35 m, source: ours}
"""


@dataclass(frozen=True)
class Outcome:
    """What a test run came to."""

    code: int
    lines: list[str]

    @property
    def node_ids(self):
        """The collected tests, after `--collect-only -q`."""
        return [line for line in self.lines if "::" in line]

    @property
    def summary(self):
        """The last line without the time."""
        return self.lines[-1].strip("= ").partition(" in ")[0]


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write a file of the project."""
    monkeypatch.chdir(tmp_path)

    def to(name, text):
        path = Path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
        return path

    to("pytest.ini", "[pytest]\nuictest_files = scenarios\n")
    return to


@pytest.fixture
def scenario(write):
    """Write a scenario of the project; the text is appended to what every scenario needs."""

    def to(name, text=""):
        return write(f"scenarios/{name}.yaml", SCENARIO.format(name=name, text=text))

    return to


@pytest.fixture
def run(write):
    """Run pytest in the project: in this process, unless it starts workers."""

    def call(*arguments):
        return in_process_of_its_own(*arguments) if "xdist" in arguments else _here(arguments)

    return call


def in_process_of_its_own(*arguments):
    """Run pytest in the project as its users do."""
    command = [sys.executable, "-m", "pytest", *_PLUGIN, *arguments]
    environment = {**os.environ, **_ENVIRONMENT}
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, env=environment
    )
    return Outcome(done.returncode, [*done.stdout.splitlines(), *done.stderr.splitlines()])


def _here(arguments):
    """Run pytest as that process would, and forget the modules of the project."""
    out, err = io.StringIO(), io.StringIO()
    modules, places = set(sys.modules), list(sys.path)
    with (
        patch.dict(os.environ, _ENVIRONMENT),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
    ):
        # It would search all memory for garbage at its end, which the process of the tests does at its own.
        code = pytest.main([*_PLUGIN, "-p", "no:unraisableexception", *arguments])
    sys.path[:] = places
    for name in set(sys.modules) - modules:
        if Path(getattr(sys.modules[name], "__file__", None) or "/").is_relative_to(Path.cwd()):
            del sys.modules[name]
    return Outcome(int(code), [*out.getvalue().splitlines(), *err.getvalue().splitlines()])


def junit_testcases(junit):
    """Return the testcases of a JUnit file by name."""
    return {str(each.get("name")): each for each in ElementTree.parse(junit).iter("testcase")}


def properties(testcase):
    """Return the properties of a testcase."""
    return {str(each.get("name")): str(each.get("value")) for each in testcase.iter("property")}

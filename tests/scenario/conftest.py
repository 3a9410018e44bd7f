"""A folder to write scenario files into, which is also the working folder."""

import io
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, load

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 120 km/h\n"
"""The least that a scenario says; three lines, so that what a test adds starts in line 4."""

Write = Callable[..., Path]


@pytest.fixture
def head():
    return HEAD


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write a file into the working folder; returns its relative path."""
    monkeypatch.chdir(tmp_path)

    def _write(name, content):
        path = Path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return _write


@pytest.fixture
def loaded(write):
    """The cases of a scenario given as text."""

    def _loaded(content, *overrides, seed=None):
        return load([write("stop.yaml", content)], overrides, seed)

    return _loaded


@pytest.fixture
def case(loaded, head):
    """The stop of `head`, which a module may replace, changed by `key=value` overrides."""
    return lambda *overrides: loaded(head, *overrides)[0]


@pytest.fixture
def refused(write):
    """The diagnostics of a scenario that must be refused."""

    def _refused(content, *overrides):
        with pytest.raises(ScenarioErrors) as caught:
            load([write("stop.yaml", content)], overrides)
        return caught.value.diagnostics

    return _refused


@pytest.fixture(scope="session")
def fmu():
    """An FMU that holds nothing but its description."""

    def _fmu(description):
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w") as archive:
            archive.writestr("modelDescription.xml", description)
        return content.getvalue()

    return _fmu

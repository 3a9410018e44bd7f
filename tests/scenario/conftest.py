"""A folder to write scenario files into, which is also the working folder."""

import io
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from uictest.plans.scenario import Case, Diagnostic, ScenarioErrors, load

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 120 km/h\n"
"""The least that a scenario says; three lines, so that what a test adds starts in line 4."""

Write = Callable[..., Path]


@pytest.fixture
def head() -> str:
    return HEAD


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Write a file into the working folder; returns its relative path."""
    monkeypatch.chdir(tmp_path)

    def _write(name: str, content: str | bytes) -> Path:
        path = Path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return _write


@pytest.fixture
def loaded(write: Write) -> Callable[..., list[Case]]:
    """The cases of a scenario given as text."""

    def _loaded(content: str | bytes, *overrides: str, seed: int | None = None) -> list[Case]:
        return load([write("stop.yaml", content)], overrides, seed)

    return _loaded


@pytest.fixture
def case(loaded: Callable[..., list[Case]], head: str) -> Callable[..., Case]:
    """The stop of `head`, which a module may replace, changed by `key=value` overrides."""
    return lambda *overrides: loaded(head, *overrides)[0]


@pytest.fixture
def refused(write: Write) -> Callable[..., tuple[Diagnostic, ...]]:
    """The diagnostics of a scenario that must be refused."""

    def _refused(content: str | bytes, *overrides: str) -> tuple[Diagnostic, ...]:
        with pytest.raises(ScenarioErrors) as caught:
            load([write("stop.yaml", content)], overrides)
        return caught.value.diagnostics

    return _refused


@pytest.fixture(scope="session")
def fmu() -> Callable[[str], bytes]:
    """An FMU that holds nothing but its description."""

    def _fmu(description: str) -> bytes:
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w") as archive:
            archive.writestr("modelDescription.xml", description)
        return content.getvalue()

    return _fmu

"""The program as its users meet it: in a folder of its own, in this process or in one of its own."""

from __future__ import annotations

import subprocess
import sysconfig
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from uictest import rig
from uictest.campaign import Examined, RecordingWish, execution
from uictest.cli.entry import execute
from uictest.evaluation import CaseResult, Figures, error_result

PROGRAM = Path(sysconfig.get_path("scripts"), "uictest")
FIGURES = Figures(465.25, 27.5, 1.195, float("nan"), 0.9, 1.31, 7.2, 180.0, 1e-5, 1e-12)


@dataclass(frozen=True)
class Answer:
    """What one call of the program came to."""

    code: int
    out: str
    err: str


Call = Callable[..., Answer]
Write = Callable[..., Path]


@pytest.fixture(autouse=True)
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder of its own, and no setting of the terminal that runs the tests."""
    monkeypatch.chdir(tmp_path)
    for variable in ("CI", "NO_COLOR", "COLUMNS", "TERM", "GITHUB_STEP_SUMMARY"):
        monkeypatch.delenv(variable, raising=False)
    return tmp_path


@pytest.fixture
def scenario(workplace: Path) -> Write:
    """Write a scenario below scenarios/; the text is appended to what every scenario needs."""

    def write(name: str = "stop", text: str = "", file: str | None = None) -> Path:
        path = Path("scenarios", file or f"{name}.yaml")
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"schema: uictest/scenario/1\nname: {name}\ninitial_speed: 30 km/h\n{text}", "utf-8")
        return path

    return write


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Call the program in this process."""

    def run(*arguments: str | Path) -> Answer:
        code = execute([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Answer(int(code), captured.out, captured.err)

    return run


@pytest.fixture
def program() -> Path:
    """The installed program."""
    return PROGRAM


@pytest.fixture
def process() -> Call:
    """Call the installed program in a process of its own."""

    def run(*arguments: str | Path, **options: Any) -> Answer:
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": 120, **options}
        done = subprocess.run([PROGRAM, *map(str, arguments)], text=True, check=False, **options)
        return Answer(done.returncode, done.stdout or "", done.stderr or "")

    return run


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Let stops come out as their tags say (`fail`, `invalid`, `error`, else `pass`); the ids as examined."""
    examined: list[str] = []

    def examine(case: Any, wish: RecordingWish) -> Examined:
        examined.append(case.id)
        if "error" in case.scenario.tags:
            return Examined(error_result(case, "ZeroDivisionError: no wheel load"))
        outcome = next((tag for tag in ("fail", "invalid") if tag in case.scenario.tags), "pass")
        given = (case.id, case.path.as_posix(), dict(case.parameters), case.scenario.expect)
        result = CaseResult(*given, outcome, measures=FIGURES, reason="made up")  # type: ignore[arg-type]
        return Examined(result)

    monkeypatch.setattr(execution, "examine", examine)
    monkeypatch.setattr(rig, "is_warm", lambda: True)
    return examined

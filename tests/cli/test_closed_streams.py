"""The exit code says the same whoever listens: on closed streams, on full ones, and where a reader leaves."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest

from .conftest import HANGING

Write = Callable[..., Path]

COMMANDS = {
    "run scenarios": 0,
    "run scenarios --set expect=invalid": 1,
    "run scenarios --format json": 0,
    "sweep scenarios/speeds.sweep.yaml": 1,
    "check missing.yaml": 4,
    "list scenarios": 0,
    "schema": 0,
    "--help": 0,
    "evaluate missing.csv": 4,
}
SWEEP = """schema: uictest/sweep/1
name: speeds
scenario: stop.yaml
grid: {initial_speed: [30 km/h], expect: [pass, invalid]}
"""


def run(program: Path, command: str, redirection: str) -> subprocess.CompletedProcess[str]:
    script = ["sh", "-c", f'"{program}" {command} {redirection}']
    return subprocess.run(script, capture_output=True, text=True, check=False, timeout=HANGING)


def exit_code(program: Path, command: str, redirection: str) -> int:
    return run(program, command, redirection).returncode


@pytest.fixture
def scenarios(scenario: Write) -> None:
    scenario("stop")
    Path("scenarios/speeds.sweep.yaml").write_text(SWEEP)


# Each stream alone for a table with files, a sweep and a document; the others with none, or one that fails.
@pytest.mark.parametrize(
    ("command", "closed"),
    [
        *product(COMMANDS, ["<&- >&- 2>&-", "2>/dev/full"]),
        *product(["run scenarios", "sweep scenarios/speeds.sweep.yaml", "schema"], ["<&-", ">&-", "2>&-"]),
    ],
)
def test_closed_streams_and_a_full_stderr_change_no_exit_code(
    program: Path, scenarios: None, command: str, closed: str
) -> None:
    assert exit_code(program, command, closed) == COMMANDS[command]


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">/dev/full"])
def test_the_reports_are_written_all_the_same(program: Path, scenarios: None, closed: str) -> None:
    exit_code(program, "run scenarios -v", closed)
    document = json.loads(Path("reports/latest/results.json").read_text())
    assert document["complete"] is True
    assert [case["id"] for case in document["cases"]] == ["stop"]


def test_no_file_is_opened_in_the_place_of_a_closed_stream(program: Path, scenarios: None) -> None:
    """Messages would go into it."""
    exit_code(program, "run scenarios -v", "2>&- >&-")
    run = Path("reports/latest")
    texts = [path.read_bytes() for path in run.rglob("*") if path.is_file()]
    assert len(texts) > 5
    assert not any(b"uictest: 1 case" in text for text in texts)


def test_data_that_a_full_disk_does_not_take_are_an_error(program: Path, scenarios: None) -> None:
    for command in ("run scenarios", "run scenarios --format json", "list scenarios", "schema"):
        script = f'"{program}" {command} >/dev/full'
        done = subprocess.run(
            ["sh", "-c", script], capture_output=True, text=True, check=False, timeout=HANGING
        )
        assert done.returncode == 3, command
        assert done.stderr.splitlines()[-1] == "uictest: stdout: No space left on device; data are lost"

"""The exit code says the same whoever listens: on closed streams, on full ones, and where a reader leaves."""

import json
import os
import subprocess
from itertools import product
from pathlib import Path

import pytest

from .conftest import HANGING

RUN = "run scenarios -v"
SWEEP = "sweep scenarios/speeds.sweep.yaml"
COMMANDS = {
    RUN: 0,
    "run scenarios --set expect=invalid": 1,
    "run scenarios --format json": 0,
    SWEEP: 1,
    "check missing.yaml": 4,
    "list scenarios": 0,
    "schema": 0,
    "--help": 0,
    "evaluate missing.csv": 4,
}


def run(program, command, redirection):
    script = ["sh", "-c", f'"{program}" {command} {redirection}']
    return subprocess.run(script, capture_output=True, text=True, check=False, timeout=HANGING)


@pytest.fixture(autouse=True)
def scenarios(scenario):
    scenario("stop")
    matrix = "matrix: {initial_speed: [30 km/h], expect: [pass, invalid]}"
    Path("scenarios/speeds.sweep.yaml").write_text(
        f"schema: uictest/scenario/1\nname: speeds\nextends: stop.yaml\nvary: {{{matrix}}}\n"
    )


def reports_are_whole():
    """Whether a run wrote its results, and no message into a file opened in the place of a closed stream."""
    document = json.loads(Path("reports/latest/results.json").read_text())
    texts = [path.read_bytes() for path in Path("reports/latest/").rglob("*") if path.is_file()]
    assert len(texts) > 5
    whole = document["complete"] and [case["id"] for case in document["cases"]] == ["stop"]
    return whole and not any(b"uictest: 1 case" in text for text in texts)


# Each stream alone for a table with files and a document; the others with none, or one that fails.
@pytest.mark.parametrize(
    ("command", "closed"),
    [*product(COMMANDS, ["<&- >&- 2>&-", "2>/dev/full"]), *product([RUN, "schema"], ["<&-", ">&-", "2>&-"])],
)
def test_closed_streams_and_a_full_stderr_change_no_exit_code(program, command, closed):
    assert run(program, command, closed).returncode == COMMANDS[command]
    assert command != RUN or reports_are_whole()


@pytest.mark.parametrize(
    "command", [RUN, "run scenarios --format json", "list scenarios", "schema", "--help"]
)
def test_data_that_a_full_disk_does_not_take_are_an_error(program, command):
    done = run(program, command, ">/dev/full")
    assert done.returncode == 3
    last = done.stderr.splitlines()[-1]
    assert "No space left on device" in last
    assert command == "--help" or last == "uictest: stdout: No space left on device; data are lost"
    assert command != RUN or reports_are_whole()


@pytest.mark.parametrize("command", [RUN, "list scenarios", "--help"])
def test_a_reader_that_leaves_is_no_error(process, command):
    reading, writing = os.pipe()
    os.close(reading)
    answer = process(*command.split(), stdout=writing)
    os.close(writing)
    assert answer.code == 0
    assert "Traceback" not in answer.err

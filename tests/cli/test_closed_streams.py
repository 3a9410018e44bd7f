"""The exit code says the same whoever listens: on closed streams, on full ones, and where a reader leaves.

What the interpreter makes of such streams when it starts is shown by `schema`; the other commands begin in a
process that has imported what they need.
"""

import json
import os
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from .conftest import HANGING, results_of

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


CLOSED, FULL = {"<&-": 0, ">&-": 1, "2>&-": 2}, {">/dev/full": 1, "2>/dev/full": 2}
BRANCHES = """
import json, os, sys
import jinja2, numpy, pydantic, yaml
import uictest.cli.commands.run, uictest.cli.commands.sweep, uictest.plans.scenario.model
import uictest.report.page.rendering, uictest.running.campaign.batch
from uictest.cli import main

for line in sys.stdin:
    folder, words, files, closed = json.loads(line)
    if branch := os.fork():
        print(os.waitstatus_to_exitcode(os.waitpid(branch, 0)[1]), flush=True)
        continue
    os.chdir(folder)
    for number, name in enumerate(files):
        os.dup2(os.open(name, os.O_RDWR | os.O_CREAT), number)
    for number in closed:
        os.close(number)
        setattr(sys, ("stdin", "stdout", "stderr")[number], None)  # as the interpreter finds it
    sys.argv = ["uictest", *words]
    main()
"""


@pytest.fixture(scope="module")
def branches():
    """A process that branches off another one for each call, with its streams."""
    command = [sys.executable, "-c", BRANCHES]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield process


@pytest.fixture
def run(branches, program):
    """Call a command with streams that are closed or full; return its exit code and what stderr says."""

    def call(command, redirection):
        if command == "schema":
            script = ["sh", "-c", f'"{program}" {command} {redirection}']
            done = subprocess.run(script, capture_output=True, text=True, check=False, timeout=HANGING)
            return done.returncode, done.stderr
        signs = redirection.split()
        files = ["/dev/full" if number in map(FULL.get, signs) else os.devnull for number in range(3)]
        files[2] = files[2] if "2>/dev/full" in signs else "stderr"
        closed = [CLOSED[sign] for sign in signs if sign in CLOSED]
        branches.stdin.write(json.dumps([str(Path.cwd()), command.split(), files, closed]) + "\n")
        branches.stdin.flush()
        code = int(branches.stdout.readline())
        return code, Path("stderr").read_text() if "stderr" in files else ""

    return call


@pytest.fixture(autouse=True)
def scenarios(scenario):
    scenario("stop")
    matrix = "matrix: {initial_speed: [30 km/h], expect: [pass, invalid]}"
    Path("scenarios/speeds.sweep.yaml").write_text(
        f"schema: uictest/scenario/1\nname: speeds\nextends: stop.yaml\nvary: {{{matrix}}}\n"
    )


def reports_are_whole():
    """Whether a run wrote its results, and no message into a file opened in the place of a closed stream."""
    document = results_of()
    texts = [path.read_bytes() for path in Path("reports/latest/").rglob("*") if path.is_file()]
    assert len(texts) > 5
    whole = document["complete"] and [case["id"] for case in document["cases"]] == ["stop"]
    return whole and not any(b"uictest: 1 case" in text for text in texts)


# Each stream alone for a table with files and a document; the others with none, or one that fails.
@pytest.mark.parametrize(
    ("command", "closed"),
    [*product(COMMANDS, ["<&- >&- 2>&-", "2>/dev/full"]), *product([RUN, "schema"], ["<&-", ">&-", "2>&-"])],
)
def test_closed_streams_and_a_full_stderr_change_no_exit_code(run, command, closed):
    assert run(command, closed)[0] == COMMANDS[command]
    assert command != RUN or reports_are_whole()


@pytest.mark.parametrize(
    "command", [RUN, "run scenarios --format json", "list scenarios", "schema", "--help"]
)
def test_data_that_a_full_disk_does_not_take_are_an_error(run, command):
    code, said = run(command, ">/dev/full")
    assert code == 3
    last = said.splitlines()[-1]
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

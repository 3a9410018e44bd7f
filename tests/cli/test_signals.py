"""Who asks the program to stop gets exit code 2 and no traceback, at whatever moment."""

import json
import signal
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from .conftest import HANGING

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")

ASKING = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
# Asks as soon as the named module is looked for, which is a moment that does not depend on the machine.
ASKED_WHILE_IMPORTING = """
import os, sys
module, number = sys.argv.pop(1), int(sys.argv.pop(1))
class Asking:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == module:
            os.kill(os.getpid(), number)
sys.meta_path.insert(0, Asking)
from uictest.cli import main
main()
"""


def heeding():
    """Undo what the caller of the tests may ignore, such as SIGHUP under nohup."""
    for number in ASKING:
        signal.signal(number, signal.SIG_DFL)


def ignoring():
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


# Each signal before and after the program has begun, and moments further on.
@pytest.mark.parametrize(
    ("module", "number"),
    [
        *product(["uictest.cli.entry", "uictest.cli.commands.run"], ASKING),
        *zip(["typer", "pydantic", "numpy"], ASKING, strict=True),
    ],
)
def test_asked_while_it_starts(scenario, module, number):
    scenario("stop")
    command = [sys.executable, "-c", ASKED_WHILE_IMPORTING, module, str(int(number)), "run"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, preexec_fn=heeding
    )
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "uictest: interrupted\n")
    assert not Path("reports").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_ctrl_c_and_a_closed_terminal_leave_what_is_finished(program, scenario, number):
    scenario("stop", "rail: {condition: wet}\n")
    # More lines than a pipe holds: the run cannot end before somebody reads on.
    command = [program, "run", "-n1", "--set", "rail.friction=range(0.1,0.3,0.0004)"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, preexec_fn=heeding, **pipes) as running:
        first = running.stdout.readline()
        running.send_signal(number)
        # communicate() would miss the lines that readline() has buffered.
        lines, err = [first, *running.stdout], running.stderr.read()
        assert running.wait(HANGING) == 2, err
    assert "interrupted" in err
    document = json.loads(Path("reports/latest/results.json").read_text())
    assert document["complete"] is False
    # The signal may come between keeping a result and showing it: nothing that was shown is missing.
    shown = [line.split()[1] for line in lines]
    assert shown[0] == "stop[friction=0.1000]"
    assert shown == [case["id"] for case in document["cases"]][: len(shown)]
    assert len(document["cases"]) < len(shown) + 2
    assert [path.name for path in Path("reports").iterdir() if path.name.startswith(".")] == []


def test_what_the_caller_ignores_stays_ignored(scenario):
    """As nohup wants it."""
    scenario("stop")
    command = [sys.executable, "-c", ASKED_WHILE_IMPORTING, "numpy", str(int(signal.SIGHUP)), "run"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, preexec_fn=ignoring
    )
    assert done.returncode == 0, done.stderr

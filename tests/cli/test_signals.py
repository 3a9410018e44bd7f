"""Who asks the program to stop gets exit code 2 and no traceback, at whatever moment."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from .conftest import HANGING

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")

Write = Callable[..., Path]
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


def heeding() -> None:
    """Undo what the caller of the tests may ignore, such as SIGHUP under nohup."""
    for number in ASKING:
        signal.signal(number, signal.SIG_DFL)


def ignoring() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


@pytest.mark.parametrize("number", ASKING)
@pytest.mark.parametrize(
    "module", ["uictest.cli.entry", "typer", "uictest.cli.commands.run", "pydantic", "numpy"]
)
def test_asked_while_it_starts(scenario: Write, module: str, number: signal.Signals) -> None:
    scenario("stop")
    command = [sys.executable, "-c", ASKED_WHILE_IMPORTING, module, str(int(number)), "run"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, preexec_fn=heeding
    )
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "uictest: interrupted\n")
    assert not Path("reports").exists()


def test_a_closed_terminal_leaves_what_is_finished(program: Path, scenario: Write) -> None:
    scenario("stop", "rail: {condition: wet}\n")
    command = [program, "run", "-n1", "--set", "rail.friction=range(0.1,0.3,0.0004)"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=heeding) as running:
        assert running.stdout is not None
        assert running.stdout.readline().startswith("pass stop[friction=0.1000]")
        running.send_signal(signal.SIGHUP)
        # communicate() would miss the lines that readline() has buffered.
        out = running.stdout.read()
        assert running.wait(HANGING) == 2
    document = json.loads(Path("reports/latest/results.json").read_text())
    assert document["complete"] is False
    # The signal may come between keeping a result and showing it.
    shown = 1 + len(out.splitlines())
    assert shown <= len(document["cases"]) <= shown + 1


def test_what_the_caller_ignores_stays_ignored(scenario: Write) -> None:
    """As nohup wants it."""
    scenario("stop")
    command = [sys.executable, "-c", ASKED_WHILE_IMPORTING, "numpy", str(int(signal.SIGHUP)), "run"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, preexec_fn=ignoring
    )
    assert done.returncode == 0, done.stderr

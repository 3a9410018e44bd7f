"""Names, titles and contents of files that users did not choose: every command shows them as text.

No control character, no line that a CI service takes for a command, no cell that a spreadsheet takes for a
formula, no element of a page.
"""

import contextlib
import re
from pathlib import Path

import pytest

from uictest.cli.entry import execute
from uictest.core.recording.formats import writer_of

from .conftest import STATED, rolling_train

HOSTILE = "[red]\x1b[2J\n::error::=1+1 <script>alert(1)</script> & |"
TITLE = "=1+1 ::error:: [red] <script>alert(1)</script> & |"
"""A title has no control characters."""
FILE = "[red]\x1b[2J\n::error::=1+1.yaml"
STOP = "schema: uictest/scenario/1\ninitial_speed: 5 km/h\n"
SHOWING = [
    "check FILE",
    "check FILE --format github",
    "check bad",
    "check bad --format github",
    "list FILE -v",
    "list FILE --requirements",
    "run FILE -v --report csv,html,md",
    "run FILE --set expect=fail --format github --report csv,html,md",
    "run FILE -o runs --keep 1",
    "run FILE --real-time",
    "run bad",
    "sweep SWEEP --dry-run",
    "sweep SWEEP --set expect=fail --report csv,html,md",
    "sweep SWEEP --set expect=fail --restart --format github",
    "evaluate RECORDING STATED",
    "evaluate RECORDING --list",
    "evaluate RECORDING --write-map map.yaml",
    "compare reports/latest runs/latest",
    "report reports/latest --format xlsx,md -o again",
    "compare WORD WORD",
    "report WORD",
    "export RECORDING WORD --to csv",
    "library show FILE",
    "library show WORD",
    "open WORD",
    "WORD",
    "controller check FILE --set a=1",
    "export-rig FILE --case WORD",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A working folder with a scenario, a sweep and a recording of hostile names."""
    folder = tmp_path_factory.mktemp("hostile")
    with contextlib.chdir(folder):
        head = f"{STOP}title: '{TITLE}'\ntags: [wet]\nrequirements: [BR-1]\n"
        Path(FILE).write_text(f"{head}name: stop\n")
        Path(FILE.replace(".yaml", ".sweep.yaml")).write_text(
            f"{head}name: study\nvary: {{matrix: {{seed: [1, 2]}}}}\n"
        )
        Path("bad").mkdir()
        Path("bad", FILE).write_text(STOP + 'name: stop\ntitle: "[red]\\x1b[2J"\n"::error::\\x1b": 1\n')
        writer_of("csv")(rolling_train(), Path(FILE.replace(".yaml", ".csv")))
        assert execute(["run", FILE, "-o", "runs"]) == 0
        assert execute(["run", FILE]) == 0
    return folder


@pytest.mark.parametrize("command", SHOWING)
@pytest.mark.parametrize("terminal", [False, True], ids=["", "terminal"])
def test_a_command_shows_it_as_text(call, folder, workplace, monkeypatch, command, terminal):
    monkeypatch.chdir(folder)
    if terminal:
        monkeypatch.setenv("COLUMNS", "80")
        monkeypatch.setattr("uictest.cli.run_display.interactive", lambda stream: True)
        for name in (
            "cli.run_display.output",
            "cli.commands.sweep.output",
            "cli.commands.compare.output",
            "cli.commands.list.terminal",
        ):
            monkeypatch.setattr(f"uictest.{name}_width", lambda stream: 80)
    names = {
        "FILE": FILE,
        "SWEEP": FILE.replace(".yaml", ".sweep.yaml"),
        "RECORDING": FILE.replace(".yaml", ".csv"),
        "WORD": HOSTILE,
    }
    words = [
        each for word in command.split() for each in (STATED if word == "STATED" else [names.get(word, word)])
    ]
    answer = call(*words)
    shown = answer.out + answer.err
    assert "Traceback" not in shown
    assert not re.search(r"[^\n\t -~\u00a0-\uffff]", shown)
    assert not [line for line in shown.splitlines() if line.startswith("::error::")]


def test_reports_show_it_as_text(folder):
    for path in [
        *folder.glob("reports/*/*.*"),
        *folder.glob("reports/*.html"),
        *folder.glob("reports/*/tables/*"),
    ]:
        if path.suffix in (".xlsx", ".parquet", ".json"):
            continue
        text = path.read_text("utf-8")
        assert "\x1b" not in text, path
        assert path.suffix != ".csv" or not re.search(r"(^|,)\"?=1", text), path
        assert path.suffix != ".html" or "<script>alert" not in text, path

"""Whoever waits for the compiler is told for what, how far it is, and how long it may still take."""

import io
import re

import pytest

from uictest.cli import progress
from uictest.cli.progress import compilation_shown
from uictest.rig.backends import machine_code


@pytest.fixture
def clock(monkeypatch):
    """Seconds that the clock shows, one after the other."""
    seconds = []
    monkeypatch.setattr(progress, "monotonic", lambda: seconds.pop(0))
    return seconds


def compile_(*shares):
    for done in shares:
        machine_code._watcher("the rig", done)


def test_a_compilation_has_lines_where_there_is_no_terminal(clock, capsys):
    clock[:] = [100.0, 101.0, 106.0, 108.0, 112.0]
    with compilation_shown():
        compile_(0.0, 0.1, 0.4, 0.5, 1.0)
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.splitlines() == [
        "uictest: compiling the rig, once per installation...",
        "uictest: 40% compiled, about 9 s left",
        "uictest: compiled in 12 s",
    ]


def test_quiet_is_silent_and_what_the_cache_holds_is_not_worth_a_word(capsys):
    with compilation_shown():
        pass
    assert capsys.readouterr().err == ""
    with compilation_shown(quiet=True):
        compile_(0.0, 0.5, 1.0)
    assert capsys.readouterr().err == ""


def test_a_terminal_has_a_bar_for_each_compilation(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(progress, "interactive", lambda stream: True)
    monkeypatch.setenv("TERM", "xterm")
    with compilation_shown():
        compile_(0.0, 0.5, 1.0)
        compile_(0.0, 1.0)
    shown = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", terminal.getvalue())
    assert shown.count("compiling the rig, once per installation") == 2
    assert "100%" in shown


def test_outside_of_commands_a_line_of_the_log_says_it(caplog):
    compile_(0.0, 0.5, 1.0)
    assert [record.getMessage() for record in caplog.records] == [
        "uictest: compiling the rig, once per installation"
    ]

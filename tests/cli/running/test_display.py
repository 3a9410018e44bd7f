import io
from contextlib import redirect_stdout

import pytest

from uictest.cli.options import Format
from uictest.cli.output import interactive
from uictest.cli.run_display import Annotations, Lines, ResultsDocument, VerdictTable, chosen_display
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS
from uictest.report import RunContent

MET = CaseResult("[bold]a", "a.yaml", {}, PASS, "pass")
MISSED = CaseResult("b", "b.yaml", {}, PASS, "fail", reason="locked")


class Terminal(io.StringIO):
    """A stream that is a terminal."""

    def isatty(self):
        return True


@pytest.fixture
def terminal(monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    return Terminal()


@pytest.mark.parametrize(
    ("stream", "shown", "display"),
    [
        (Terminal, Format.TEXT, VerdictTable),
        (Terminal, Format.JSON, ResultsDocument),
        (Terminal, Format.GITHUB, Annotations),
        (io.StringIO, Format.TEXT, Lines),
    ],
)
def test_text_is_a_table_on_a_terminal_and_lines_elsewhere(stream, shown, display):
    with redirect_stdout(stream()):
        assert type(chosen_display(shown, quiet=False, verbose=False)) is display


@pytest.mark.parametrize(("ci", "watched"), [("true", False), ("1", False), ("", True), ("false", True)])
def test_on_a_ci_service_nobody_watches(monkeypatch, ci, watched):
    monkeypatch.setenv("CI", ci)
    assert interactive(Terminal()) is watched


def _shown(terminal, *, quiet=False):
    with redirect_stdout(terminal):
        display = chosen_display(Format.TEXT, quiet=quiet, verbose=False)
        for result in (MET, MISSED):
            display.show(result, ())
        display.end(RunContent("run", [MET, MISSED]), "{}")
    return terminal.getvalue()


def test_the_table_explains_what_is_not_met_and_a_quiet_one_holds_nothing_else(terminal, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    shown = _shown(terminal)
    assert "[bold]a" in shown
    assert "fail b\n  fail. Expected: pass\n  locked\n" in shown
    assert "\x1b" not in shown
    terminal.truncate(0)
    assert "[bold]a" not in _shown(terminal, quiet=True)


def test_the_table_is_as_wide_as_columns_says(terminal, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setenv("NO_COLOR", "1")
    assert max(map(len, _shown(terminal).splitlines())) <= 100


@pytest.mark.parametrize(("variable", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_colour_on_a_terminal_until_it_is_unwanted(terminal, monkeypatch, variable, value):
    assert "\x1b[" in _shown(terminal)
    terminal.truncate(0)
    monkeypatch.setenv(variable, value)
    assert "\x1b[" not in _shown(terminal)

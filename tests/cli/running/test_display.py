import io
from contextlib import redirect_stdout

import pytest

from uictest.cli.options import Colour, Format
from uictest.cli.output import interactive
from uictest.cli.running.display import Annotations, Lines, ResultsDocument, VerdictTable, chosen_display
from uictest.judging.evaluation import CaseResult
from uictest.report import RunContent

MET = CaseResult("[bold]a", "a.yaml", {}, "pass", "pass")
MISSED = CaseResult("b", "b.yaml", {}, "pass", "fail", reason="locked")


class Terminal(io.StringIO):
    """A stream that is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    monkeypatch.setenv("COLUMNS", "120")
    return Terminal()


@pytest.mark.parametrize(
    ("shown", "display"),
    [(Format.TEXT, VerdictTable), (Format.JSON, ResultsDocument), (Format.GITHUB, Annotations)],
)
def test_text_is_a_table_on_a_terminal(terminal: Terminal, shown: Format, display: type) -> None:
    with redirect_stdout(terminal):
        assert type(chosen_display(shown, Colour.AUTO, quiet=False, verbose=False)) is display


def test_text_is_lines_elsewhere() -> None:
    with redirect_stdout(io.StringIO()):
        assert type(chosen_display(Format.TEXT, Colour.AUTO, quiet=False, verbose=False)) is Lines


@pytest.mark.parametrize(("ci", "watched"), [("true", False), ("1", False), ("", True), ("false", True)])
def test_on_a_ci_service_nobody_watches(monkeypatch: pytest.MonkeyPatch, ci: str, watched: bool) -> None:
    monkeypatch.setenv("CI", ci)
    assert interactive(Terminal()) is watched


def _shown(terminal: Terminal, colour: Colour = Colour.AUTO, *, quiet: bool = False) -> str:
    with redirect_stdout(terminal):
        display = chosen_display(Format.TEXT, colour, quiet=quiet, verbose=False)
        for result in (MET, MISSED):
            display.case(result)
        display.end(RunContent("run", [MET, MISSED]), "{}")
    return terminal.getvalue()


def test_the_table_explains_what_is_not_met(terminal: Terminal) -> None:
    shown = _shown(terminal, Colour.NEVER)
    assert "[bold]a" in shown
    assert "fail b\n  fail. Expected: pass\n  locked\n" in shown
    assert "\x1b" not in shown


def test_the_table_is_as_wide_as_columns_says(terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    assert max(map(len, _shown(terminal, Colour.NEVER).splitlines())) <= 100


def test_a_quiet_table_holds_only_what_is_not_met(terminal: Terminal) -> None:
    assert "[bold]a" not in _shown(terminal, Colour.NEVER, quiet=True)


@pytest.mark.parametrize(("variable", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_colour_on_a_terminal_until_it_is_unwanted(
    terminal: Terminal, monkeypatch: pytest.MonkeyPatch, variable: str, value: str
) -> None:
    assert "\x1b[" in _shown(terminal)
    terminal.truncate(0)
    monkeypatch.setenv(variable, value)
    assert "\x1b[" not in _shown(terminal)

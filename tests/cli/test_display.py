"""What a run shows while it runs and at its end: progress, its text, and its exit code."""

import io
import threading
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path

import pytest

from uictest import report
from uictest.cli import run_display
from uictest.cli.options import Format
from uictest.cli.output import ExitCode, interactive, of_run
from uictest.cli.run_display import chosen_display, progress
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS
from uictest.report import RunContent
from uictest.runs import Published

from .conftest import HANGING

MET = CaseResult("[bold]a", "a.yaml", {}, PASS, "pass")
MISSED = CaseResult("b", "b.yaml", {}, PASS, "fail", reason="locked")


def run_of(*outcomes, interrupted=False):
    content = RunContent("run", [CaseResult(outcome, "a.yaml", {}, PASS, outcome) for outcome in outcomes])
    return Published(Path("run"), content, report.publication_of_run(content), interrupted)


@pytest.mark.parametrize(
    ("run", "code"),
    [
        (run_of("pass", "pass"), 0),
        (run_of("pass", "skipped"), 1),
        (run_of("pass", "fail"), 1),
        (run_of("invalid"), 1),
        (run_of("fail", "error"), 3),
        (run_of("fail", "error", interrupted=True), 2),
        (run_of(interrupted=True), 2),
    ],
)
def test_what_outweighs_what_in_an_exit_code(run, code):
    assert of_run(run) == code


def test_the_codes_are_those_that_the_documentation_promises():
    codes = "MET 0, MISSED 1, INTERRUPTED 2, ERROR 3, USAGE 4, NOTHING_SELECTED 5"
    assert ", ".join(f"{code.name} {code:d}" for code in ExitCode) == codes


class Terminal(io.StringIO):
    """A stream that is a terminal."""

    def isatty(self):
        return True


@pytest.mark.parametrize(("ci", "watched"), [("true", False), ("1", False), ("", True), ("false", True)])
def test_on_a_ci_service_nobody_watches(monkeypatch, ci, watched):
    monkeypatch.setenv("CI", ci)
    assert interactive(Terminal()) is watched


WIDE = replace(MISSED, id="a-name-of-some-length" * 2 + "[friction=0.10,command=100]")


@pytest.fixture
def shown(monkeypatch):
    """Return what a stream shows of a met and a missed case, with variables of the environment."""

    def show(stream=Terminal, quiet=False, cases=(MET, MISSED), **variables):
        for name, value in {"COLUMNS": "120", **variables}.items():
            monkeypatch.setenv(name, value)
        with redirect_stdout(stream()) as written:
            display = chosen_display(Format.TEXT, quiet=quiet, verbose=False)
            content = RunContent("run", cases)
            display.end(content, "{}")
            display.close(content, "; took 1.0 s", Path("reports/run"))
        return written.getvalue()

    return show


def test_the_text_of_a_terminal_is_that_of_a_log_and_ends_with_what_failed_and_where_the_reports_are(shown):
    text = shown(NO_COLOR="1")
    assert shown(io.StringIO) == text
    assert text.splitlines()[-6:] == [
        "b misses requirements",
        *("  fail. Expected: pass", "  locked"),
        "",
        "FAILED: 1 of 2 cases failed: b; took 1.0 s",
        "reports: reports/run",
    ]
    assert "[bold]a" in text
    assert "[bold]a" not in shown(quiet=True)


@pytest.mark.parametrize(
    ("columns", "widest"), [("", 100), ("40", 100), ("80", 100), ("100", 100), ("140", 140)]
)
@pytest.mark.parametrize("service", [{}, {"CI": "true", "GITHUB_ACTIONS": "true", "GITLAB_CI": "true"}])
def test_a_log_has_100_columns_whatever_the_service_and_columns_alone_widens_it(
    shown, columns, widest, service
):
    narrow = shown(io.StringIO, cases=(MET, WIDE), COLUMNS="100")
    text = shown(io.StringIO, cases=(MET, WIDE), COLUMNS=columns, **service)
    assert max(map(len, text.splitlines())) <= widest
    assert (text == narrow) == (widest == 100)


@pytest.mark.parametrize("unwanted", [{"NO_COLOR": "1"}, {"TERM": "dumb"}])
def test_colour_on_a_terminal_until_it_is_unwanted(shown, unwanted):
    assert "\x1b[" in shown()
    assert "\x1b" not in shown(**unwanted)


@pytest.fixture
def beats(monkeypatch):
    """Let a sign of life come at once and again; returns the lines, and what waits for one with a text."""
    lines, written = [], threading.Condition()

    def write(text):
        with written:
            lines.append(text)
            written.notify_all()

    def wait_for(text):
        with written:
            assert written.wait_for(lambda: any(text in line for line in lines), HANGING)

    monkeypatch.setattr(run_display, "HEARTBEAT", 0.001)
    monkeypatch.setattr(run_display, "message", write)
    return lines, wait_for


def heartbeats():
    return [thread for thread in threading.enumerate() if thread.name == "heartbeat"]


def test_where_nobody_watches_there_is_a_sign_of_life_with_the_total_as_it_grows(beats):
    _, wait_for = beats
    with progress(1000, 100, quiet=False, unit="stops") as advance:
        wait_for("uictest: 100 of 1000 stops after ")
        advance(1)
        wait_for("101 of 1000 stops after")
        wait_for(" s left")
    assert heartbeats() == []
    lines, wait_for = beats
    with progress(7, quiet=False) as advance:
        advance(0, 2)
        advance(7)
        wait_for(" 7 of 9 cases after")
    assert not any("7 of 7" in line for line in lines)


def test_quiet_is_silent(beats):
    with progress(7, quiet=True) as advance:
        advance(1)
        assert heartbeats() == []
    assert beats[0] == []

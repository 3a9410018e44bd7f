from __future__ import annotations

import io
import re
import threading

import pytest

from uictest.cli import progress as progress_module
from uictest.cli.progress import announce_compilation, progress

from .conftest import HANGING


def test_where_nobody_watches_there_is_a_sign_of_life_now_and_then(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before, after = threading.Event(), threading.Event()

    def record(text: str) -> None:
        # The thread may beat at any time before the first case is counted, so only the counts tell.
        (after if "1 of 7 cases after" in text else before).set()

    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.001)
    monkeypatch.setattr(progress_module, "message", record)
    with progress(7, quiet=False) as advance:
        assert before.wait(HANGING)
        advance()
        assert after.wait(HANGING)
    assert not [thread for thread in threading.enumerate() if thread.name == "heartbeat"]


def test_quiet_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.0)
    with progress(7, quiet=True) as advance:
        advance()
    assert not [thread for thread in threading.enumerate() if thread.name == "heartbeat"]


@pytest.mark.parametrize(
    ("warm", "quiet", "said"), [(False, False, True), (True, False, False), (False, True, False)]
)
def test_a_wait_is_announced_once_for_all_commands(
    capsys: pytest.CaptureFixture[str], warm: bool, quiet: bool, said: bool
) -> None:
    announce_compilation(warm=warm, quiet=quiet)
    shown = capsys.readouterr()
    assert shown.out == ""
    assert ("uictest: compiling the rig (once per installation" in shown.err) is said


@pytest.mark.parametrize(("choice", "no_color"), [("never", ""), ("auto", "1")])
def test_the_bar_has_no_colour_where_none_is_wanted(
    monkeypatch: pytest.MonkeyPatch, choice: str, no_color: str
) -> None:
    monkeypatch.setenv("NO_COLOR", no_color)
    monkeypatch.setenv("TERM", "xterm-256color")
    stream = io.StringIO()
    monkeypatch.setattr(stream, "isatty", lambda: True)
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setenv("CI", "")
    with progress(2, quiet=False, colour=choice) as advance:
        advance()
    shown = stream.getvalue()
    assert "1/2" in shown
    assert not re.search(r"\x1b\[[0-9;]*m", shown)

import threading

from uictest.cli import progress as progress_module
from uictest.cli.progress import progress

from .conftest import HANGING


def test_where_nobody_watches_there_is_a_sign_of_life_now_and_then(monkeypatch):
    before, after = threading.Event(), threading.Event()

    def record(text):
        # The thread may beat at any time before the first case is counted, so only the counts tell.
        (after if "1 of 7 cases after" in text else before).set()

    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.001)
    monkeypatch.setattr(progress_module, "message", record)
    with progress(7, quiet=False) as advance:
        assert before.wait(HANGING)
        advance(1)
        assert after.wait(HANGING)
    assert not [thread for thread in threading.enumerate() if thread.name == "heartbeat"]


def test_a_total_that_grows_is_not_said_to_be_finished(monkeypatch):
    finished = threading.Event()
    lines = []

    def record(text):
        lines.append(text)
        if " 7 of 9 cases after" in text:
            finished.set()

    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.001)
    monkeypatch.setattr(progress_module, "message", record)
    with progress(7, quiet=False) as advance:
        advance(0, 2)
        advance(7)
        assert finished.wait(HANGING)
    assert not any("7 of 7" in line for line in lines)


def test_quiet_is_silent(monkeypatch):
    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.0)
    with progress(7, quiet=True) as advance:
        advance(1)
    assert not [thread for thread in threading.enumerate() if thread.name == "heartbeat"]

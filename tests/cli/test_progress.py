from __future__ import annotations

import threading

import pytest

from uictest.cli import progress as progress_module
from uictest.cli.progress import progress


def test_where_nobody_watches_there_is_a_sign_of_life_now_and_then(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    heard: list[str] = []
    twice = threading.Event()

    def hear(text: str) -> None:
        heard.append(text)
        if len(heard) == 2:
            twice.set()

    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.001)
    monkeypatch.setattr(progress_module, "message", hear)
    with progress(7, quiet=False) as advance:
        advance()
        assert twice.wait(30.0)
    assert "1 of 7 cases after" in heard[-1]
    count = len(heard)
    assert not [thread for thread in threading.enumerate() if thread.name == "heartbeat"]
    assert len(heard) == count


def test_quiet_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress_module, "HEARTBEAT", 0.0)
    with progress(7, quiet=True) as advance:
        advance()
    assert not [thread for thread in threading.enumerate() if thread.name == "heartbeat"]

"""Parts on threads: in order whatever the threads do, and kept whatever happens."""

from __future__ import annotations

import threading
import time

import pytest

from uictest.sweep import run_parts


def late_first(number: int) -> bytes:
    time.sleep(0.02 if number == 0 else 0.0)
    return bytes([number])


@pytest.mark.parametrize("jobs", [1, 2, 5])
def test_parts_come_in_order(jobs: int) -> None:
    seen: list[tuple[int, bytes]] = []
    run_parts(range(9), late_first, jobs, lambda number, content: seen.append((number, content)))
    assert seen == [(number, bytes([number])) for number in range(9)]


def test_few_parts_are_in_memory_at_once() -> None:
    most = 0
    waiting = 0
    lock = threading.Lock()

    def work(number: int) -> bytes:
        nonlocal most, waiting
        with lock:
            waiting += 1
            most = max(most, waiting)
        return b""

    def on_part(number: int, content: bytes) -> None:
        nonlocal waiting
        time.sleep(0.002)
        with lock:
            waiting -= 1

    run_parts(range(40), work, 2, on_part)
    assert most <= 6


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
def test_what_is_finished_before_an_interruption_is_kept(error: type[BaseException]) -> None:
    kept: list[int] = []

    def on_part(number: int, content: bytes) -> None:
        if number == 3:
            raise error
        kept.append(number)

    with pytest.raises(error):
        run_parts(range(9), late_first, 2, on_part)
    assert kept == [0, 1, 2]

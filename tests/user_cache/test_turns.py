"""What is cached is made by one process at a time, and nobody waits for one that has ended."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager
from pathlib import Path

import pytest

from uictest.core import user_cache

INPUTS = b"sources"
MAKER = """
import sys
from uictest.core import user_cache
with user_cache.turn("code", b"sources"):
    print("began", flush=True)
    sys.stdin.read()
    user_cache.write("code", b"sources", b"made")
"""
LONG_ENOUGH = 0.5
"""Seconds in which whoever does not wait comes back; whoever waits has not come back after any time."""


@contextmanager
def another_process():
    """Lend a process that has its turn; it makes the content and ends when its input is closed."""
    command = [sys.executable, "-c", MAKER]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "began\n"
        yield process


def read_in_turn(kind="code", inputs=INPUTS):
    with user_cache.turn(kind, inputs):
        return user_cache.read(kind, inputs)


def has_come_back(reading):
    return bool(wait([reading], LONG_ENOUGH).done)


def test_the_others_wait_and_find_the_content(root):
    with ThreadPoolExecutor(2) as threads:
        with another_process() as maker:
            readings = [threads.submit(read_in_turn) for _ in range(2)]
            assert not any(has_come_back(reading) for reading in readings)
            maker.communicate()
        assert [reading.result() for reading in readings] == [b"made", b"made"]
    assert len(list(root.iterdir())) == 1, "only the content is left"


def test_other_content_is_not_waited_for(root):
    with another_process():
        assert read_in_turn("page") is None
        assert read_in_turn("code", b"other sources") is None


def test_a_process_that_was_killed_or_stopped_holds_nobody_up_without_end(root, monkeypatch):
    with another_process() as maker:
        maker.kill()
    assert read_in_turn() is None
    monkeypatch.setattr(user_cache, "PATIENCE", 0.1)
    with another_process():
        assert read_in_turn() is None


def test_an_error_ends_the_turn(root):
    with pytest.raises(ZeroDivisionError), user_cache.turn("code", INPUTS):
        raise ZeroDivisionError
    assert read_in_turn() is None
    assert list(root.iterdir()) == []


def test_without_a_folder_nobody_waits(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    assert read_in_turn() is None


def test_a_folder_in_the_place_of_the_lock_is_passed_by(root):
    user_cache.write("code", INPUTS, b"made")
    (content,) = root.iterdir()
    Path(f"{content}.lock").mkdir()
    assert read_in_turn() == b"made"

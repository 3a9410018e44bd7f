"""A folder belongs to one process at a time, and to nobody once that has ended."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from uictest import folder_lock
from uictest.folder_lock import FolderInUseError, FolderLock, remove_abandoned

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks")

HOLDER = """
import sys
from pathlib import Path
from uictest.folder_lock import FolderLock
with FolderLock(Path(sys.argv[1]), shared=sys.argv[2] == "shared"):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def another_process(folder: Path, how: str = "alone") -> Iterator[subprocess.Popen[str]]:
    """Lend a process that has the lock, until the end of the block."""
    command = [sys.executable, "-c", HOLDER, str(folder), how]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        yield process


def test_another_process_is_named(tmp_path: Path) -> None:
    with another_process(tmp_path) as process:
        with pytest.raises(FolderInUseError) as caught:
            FolderLock(tmp_path)
        assert str(caught.value) == f"process {process.pid} on {os.uname().nodename}"
    with FolderLock(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []


def test_those_who_share_work_side_by_side_and_nobody_else_does(tmp_path: Path) -> None:
    with another_process(tmp_path, "shared"):
        with FolderLock(tmp_path, shared=True):
            pass
        with pytest.raises(FolderInUseError, match="another shard"):
            FolderLock(tmp_path)
    with FolderLock(tmp_path):
        pass


def test_a_killed_process_holds_nothing(tmp_path: Path) -> None:
    with another_process(tmp_path) as process:
        process.send_signal(signal.SIGKILL)
    with FolderLock(tmp_path), pytest.raises(FolderInUseError, match=f"process {os.getpid()} on"):
        FolderLock(tmp_path)


def test_only_a_folder_whose_process_has_ended_is_abandoned(tmp_path: Path) -> None:
    living, dead, other = tmp_path / "living", tmp_path / "dead", tmp_path / "other"
    for folder in (living, dead, other):
        folder.mkdir()
        (folder / "summary.csv").touch()
    with another_process(dead) as process:
        process.send_signal(signal.SIGKILL)
    with another_process(living):
        for folder in (living, dead, other):
            remove_abandoned(folder)
        assert sorted(tmp_path.iterdir()) == [living, other]


def test_a_folder_that_is_only_just_made_is_not_abandoned(tmp_path: Path) -> None:
    """Its lock is taken in two steps: the file is there first."""
    (tmp_path / ".lock").touch()
    remove_abandoned(tmp_path)
    assert tmp_path.is_dir()


def test_where_there_are_no_locks_nobody_is_refused_and_nothing_abandoned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(folder_lock, "_lock", lambda descriptor, shared: False)
    with FolderLock(tmp_path), FolderLock(tmp_path):
        remove_abandoned(tmp_path)
        assert tmp_path.is_dir()

"""A folder belongs to one process at a time, and to nobody once that has ended."""

import errno
import fcntl
import os
import platform
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from uictest.core.files import FolderInUseError, FolderLock

HOLDER = """
import sys
from pathlib import Path
from uictest.core.files import FolderLock
with FolderLock(Path(sys.argv[1]), shared=sys.argv[2] == "shared"):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def another_process(folder, how="alone"):
    """Lend a process that has the lock, until the end of the block."""
    command = [sys.executable, "-c", HOLDER, str(folder), how]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "held\n"
        yield process


def test_another_process_is_named_and_those_who_share_work_side_by_side_alone(tmp_path):
    with another_process(tmp_path) as process:
        with pytest.raises(FolderInUseError) as caught:
            FolderLock(tmp_path)
        assert str(caught.value) == f"process {process.pid} on {platform.node()}"
    with FolderLock(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []
    with another_process(tmp_path, "shared"):
        with FolderLock(tmp_path, shared=True):
            pass
        with pytest.raises(FolderInUseError, match="another shard"):
            FolderLock(tmp_path)
    with FolderLock(tmp_path):
        pass


@pytest.mark.parametrize("how", ["alone", "shared"])
def test_a_killed_process_holds_nothing(tmp_path, how):
    with another_process(tmp_path, how) as process:
        process.send_signal(signal.SIGKILL)
    assert len(list(tmp_path.iterdir())) == 1
    with FolderLock(tmp_path, shared=True):
        pass
    with FolderLock(tmp_path), pytest.raises(FolderInUseError, match=f"process {os.getpid()} on"):
        FolderLock(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_who_waits_for_one_that_shares_waits_until_its_end(tmp_path):
    held = FolderLock(tmp_path, shared=True)
    with pytest.raises(FolderInUseError, match="another shard"):
        FolderLock(tmp_path, patience=0.2)
    held.release()
    with FolderLock(tmp_path, patience=0.2), pytest.raises(FolderInUseError):
        FolderLock(tmp_path, shared=True)


def test_files_of_other_programs_stay(tmp_path):
    (tmp_path / ".uictest-0.lock").write_text("mine")
    with FolderLock(tmp_path):
        pass
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]
    (tmp_path / ".lock").write_text("theirs")
    with FolderLock(tmp_path):
        pass
    assert (tmp_path / ".lock").read_text() == "theirs"
    with FolderLock(tmp_path):
        (tmp_path / ".uictest.lock").unlink()
        (tmp_path / ".uictest.lock").write_text("mine")
    assert (tmp_path / ".uictest.lock").read_text() == "mine"


def test_where_there_are_no_locks_nobody_is_refused(tmp_path, monkeypatch):
    def refuse(*_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    with FolderLock(tmp_path), FolderLock(tmp_path):
        (tmp_path / ".uictest.lock").write_text("uictest lock: process 1 on here")
        with pytest.raises(FileNotFoundError, match="there are no locks here"):
            FolderLock(tmp_path, abandoned=True)


FOREIGN = {
    "link": lambda place, victim: place.symlink_to(victim),
    "hard link": lambda place, victim: place.hardlink_to(victim),
    "copy": lambda place, victim: place.write_bytes(victim.read_bytes()),
    "pipe": lambda place, victim: os.mkfifo(place),
    "folder": lambda place, victim: place.mkdir(),
}


@pytest.mark.parametrize("kind", FOREIGN)
@pytest.mark.parametrize("content", ["mine", ""])
def test_what_is_no_lock_of_uictest_is_neither_followed_nor_changed(tmp_path, kind, content):
    """A link led to the file of somebody else, which was emptied and given the name of a process."""
    victim, folder = tmp_path / "victim.txt", tmp_path / "reports"
    victim.write_text(content)
    folder.mkdir()
    if kind == "copy" and not content:
        pytest.skip("an empty file of this name is a lock that is being made")
    FOREIGN[kind](folder / ".uictest.lock", victim)
    before = (folder / ".uictest.lock").lstat()
    with pytest.raises(FileExistsError, match="is no lock of uictest and stays as it is") as caught:
        FolderLock(folder)
    assert caught.value.filename == str(folder / ".uictest.lock")
    after = (folder / ".uictest.lock").lstat()
    assert (after.st_ino, after.st_mode, after.st_mtime_ns) == (
        before.st_ino,
        before.st_mode,
        before.st_mtime_ns,
    )
    assert victim.read_text() == content


def test_a_link_makes_no_file_where_it_leads(tmp_path):
    (tmp_path / ".uictest.lock").symlink_to(tmp_path / "made")
    with pytest.raises(FileExistsError):
        FolderLock(tmp_path)
    assert not (tmp_path / "made").exists()
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to("there")
    with FolderLock(tmp_path / "link"):  # as the user named it
        assert (tmp_path / "there" / ".uictest.lock").is_file()
    with pytest.raises(OSError, match="is a link, which is not followed"):
        FolderLock(tmp_path, "link")
    assert list((tmp_path / "there").iterdir()) == []


def test_a_file_that_its_last_holder_removed_meanwhile_is_no_lock(tmp_path, monkeypatch):
    """Whoever opened it before would hold a lock that nobody else meets."""
    flock, path = fcntl.flock, tmp_path / ".uictest.lock"

    def removed_first(descriptor, operation):
        monkeypatch.setattr("fcntl.flock", flock)
        path.unlink()
        flock(descriptor, operation)

    monkeypatch.setattr("fcntl.flock", removed_first)
    with FolderLock(tmp_path), pytest.raises(FolderInUseError):
        FolderLock(tmp_path)


def test_a_file_that_another_process_made_meanwhile_is_left_to_it(tmp_path, monkeypatch):
    flock, path, held = fcntl.flock, tmp_path / ".uictest.lock", []

    def replaced_first(descriptor, operation):
        monkeypatch.setattr("fcntl.flock", flock)
        path.unlink()
        held.append(FolderLock(tmp_path))
        flock(descriptor, operation)

    monkeypatch.setattr("fcntl.flock", replaced_first)
    with pytest.raises(FolderInUseError):
        FolderLock(tmp_path)
    assert path.exists()
    held[0].release()
    assert not path.exists()


def test_a_lock_that_is_removed_after_it_is_closed_is_not_abandoned_meanwhile(tmp_path, monkeypatch):
    """Windows removes no open file; a finished run would be taken for that of a killed process."""
    unlink, removed = Path.unlink, []

    def refuse_first(path, **options):
        removed.append(path)
        if len(removed) == 1:
            raise PermissionError(13, "used by another process")
        with pytest.raises(FileExistsError):
            FolderLock(tmp_path, abandoned=True)
        unlink(path, **options)

    monkeypatch.setattr(Path, "unlink", refuse_first)
    with FolderLock(tmp_path):
        pass
    assert len(removed) == 2
    assert list(tmp_path.iterdir()) == []

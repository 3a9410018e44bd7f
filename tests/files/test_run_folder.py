import errno
import hashlib
import logging
import os
import subprocess
import sys

import pytest

from uictest.core.files import (
    LATEST,
    LIST,
    FolderLock,
    RunFolder,
    begin_list,
    latest_run,
    point_latest,
    write,
)


def test_a_published_folder_appears_under_its_name_with_its_files(tmp_path):
    with RunFolder(tmp_path / "reports", "first") as folder:
        write(folder.path, "summary.csv", "id\n")
        assert not (tmp_path / "reports" / "first").exists()
        place = folder.publish()
    assert place == tmp_path / "reports" / "first"
    assert [path.name for path in (tmp_path / "reports").iterdir()] == ["first"]
    assert (place / "summary.csv").read_text() == "id\n"


def test_a_taken_name_gets_a_number_also_where_it_is_taken_meanwhile(tmp_path):
    for expected in ("run", "run-2", "run-3"):
        with RunFolder(tmp_path, "run") as folder:
            assert folder.publish().name == expected
    with RunFolder(tmp_path, "later") as folder:
        (tmp_path / "later").mkdir()
        assert folder.publish() == tmp_path / "later-2"


def test_the_name_that_reports_state_is_that_of_the_folder(tmp_path):
    (tmp_path / "run").mkdir()
    with RunFolder(tmp_path, "run") as first, RunFolder(tmp_path, "run") as second:
        names = first.name, second.name
        assert names == ("run-2", "run-3")
        places = second.publish(), first.publish()
    assert tuple(place.name for place in reversed(places)) == names


def test_a_folder_that_is_not_published_leaves_what_others_put_beside_it_and_nothing_else(tmp_path):
    def fail_halfway():
        with RunFolder(tmp_path / "deep" / "reports", "run") as folder:
            write(folder.path, "recordings/half.csv", "i")
            raise OSError("No space left on device")

    with pytest.raises(OSError, match="No space left"):
        fail_halfway()
    assert list(tmp_path.iterdir()) == []
    with RunFolder(tmp_path / "reports", "run"):
        (tmp_path / "reports" / "note.txt").write_text("mine")
    assert [path.name for path in (tmp_path / "reports").iterdir()] == ["note.txt"]
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        RunFolder(tmp_path / "file" / "reports", "run")


KILLED_AT_WORK = """
import os, signal, sys
from pathlib import Path
from uictest.core.files import RunFolder, write
with RunFolder(Path(sys.argv[1]), "killed") as folder:
    write(folder.path, "recordings/a.csv", "half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_what_a_killed_run_left_is_removed_by_the_next_and_what_a_living_one_has_is_not(tmp_path):
    subprocess.run([sys.executable, "-c", KILLED_AT_WORK, str(tmp_path)], check=False)
    [left] = tmp_path.iterdir()
    assert left.name == ".killed.partial"
    with RunFolder(tmp_path, "living") as living:
        assert not left.exists()
        with RunFolder(tmp_path, "later") as later:
            assert living.path.is_dir()
            later.publish()
        assert living.publish() == tmp_path / "living"
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        "SHA256SUMS",
        "SHA256SUMS",
        "later",
        "living",
    ]


def _run(parent, name):
    run = parent / name
    run.mkdir()
    return run


def test_latest_follows_the_newest_run_by_a_link_that_can_be_moved_with_its_folder(tmp_path):
    for name in ("first", "second"):
        point_latest(_run(tmp_path, name))
        found = latest_run(tmp_path)
        assert found.name == name
    assert sorted(path.name for path in tmp_path.iterdir()) == ["first", LATEST, "second"]
    (tmp_path / "here").mkdir()
    point_latest(_run(tmp_path / "here", "run"))
    (tmp_path / "here").rename(tmp_path / "there")
    assert latest_run(tmp_path / "there") == (tmp_path / "there" / "run").resolve()


def test_where_links_are_impossible_a_text_file_names_the_run(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise OSError("links are not supported here")

    monkeypatch.setattr(os, "symlink", refuse)
    run = _run(tmp_path, "run")
    point_latest(run)
    assert (tmp_path / LATEST).read_text() == "run\n"
    assert latest_run(tmp_path) == run


@pytest.mark.parametrize("with_dangling_link", [False, True])
def test_without_a_run_there_is_no_latest(tmp_path, with_dangling_link):
    if with_dangling_link:
        (tmp_path / LATEST).symlink_to("gone")
    assert latest_run(tmp_path) is None


def test_a_file_of_somebody_else_that_is_named_latest_stays(tmp_path):
    for content in ("the latest news", "news\n", "../there\n"):
        (tmp_path / LATEST).write_text(content)
        said = point_latest(_run(tmp_path, str(len(content))))
        assert said == f"{tmp_path / LATEST} was not written by uictest: it is left as it is"
        assert (tmp_path / LATEST).read_text() == content


def _killed(tmp_path):
    subprocess.run([sys.executable, "-c", KILLED_AT_WORK, str(tmp_path)], check=False)
    return tmp_path / ".killed.partial"


def test_what_the_user_put_into_the_folder_of_a_killed_run_stays_and_is_named(tmp_path, caplog):
    left = _killed(tmp_path)
    (left / "notes.txt").write_text("mine")
    with caplog.at_level(logging.WARNING), RunFolder(tmp_path, "run"):
        pass
    assert f"{left} stays: it holds notes.txt, which uictest did not write" in caplog.text
    assert (left / "notes.txt").read_text() == "mine"
    assert not (left / "recordings").exists()


@pytest.mark.parametrize("lock", [None, "", "process 4 on here", "uictest lock"])
def test_a_hidden_folder_without_a_lock_of_uictest_stays(tmp_path, lock):
    """Any `.x.partial` folder with an unlocked `.lock` was removed: other programs have such folders."""
    foreign = tmp_path / ".theirs.partial"
    foreign.mkdir()
    begin_list(foreign)
    write(foreign, "data.csv", "1")
    for name in (".lock", ".uictest.lock"):
        if lock is not None:
            (foreign / name).write_text(lock)
    before = sorted(path.name for path in foreign.iterdir())
    with RunFolder(tmp_path, "run"):
        pass
    assert sorted(path.name for path in foreign.iterdir()) == before


def test_a_link_to_the_folder_of_a_killed_run_is_not_followed(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "reports").mkdir()
    left = _killed(tmp_path / "there")
    (tmp_path / "reports" / ".killed.partial").symlink_to(left)
    with RunFolder(tmp_path / "reports", "run"):
        pass
    assert (left / "recordings" / "a.csv").read_text() == "half"


@pytest.mark.parametrize("made", ["file", "link", "full"])
def test_nothing_that_appears_between_the_check_and_the_rename_is_replaced(tmp_path, monkeypatch, made):
    """A finished run was lost in 2 of 360 collisions."""
    makers = {
        "file": lambda: (tmp_path / "run").write_text("theirs"),
        "link": lambda: (tmp_path / "run").symlink_to("gone"),
        "full": lambda: write(_run(tmp_path, "run"), "a.csv", "theirs"),
    }
    rename = os.rename

    def too_late(old, new):
        monkeypatch.setattr(os, "rename", rename)
        makers[made]()
        rename(old, new)

    with RunFolder(tmp_path, "run") as folder:
        write(folder.path, "summary.csv", "ours")
        monkeypatch.setattr(os, "rename", too_late)
        place = folder.publish()
    assert place == tmp_path / "run-2"
    assert (place / "summary.csv").read_text() == "ours"
    there = tmp_path / "run"
    assert there.is_symlink() if made == "link" else there.exists()
    assert (there / "a.csv").exists() == (made == "full")


def test_a_publication_that_fails_leaves_nothing(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "rename", full)
    with pytest.raises(OSError, match="No space left"), RunFolder(tmp_path / "reports", "run") as folder:
        write(folder.path, "summary.csv", "ours")
        folder.publish()
    assert list(tmp_path.iterdir()) == []


PUBLISHER = """
import sys
from pathlib import Path
from uictest.core.files import RunFolder, write
sys.stdin.read()
for _ in range(10):
    with RunFolder(Path(sys.argv[1]), "run") as folder:
        write(folder.path, "name", folder.name)
        folder.publish()
"""


def test_none_of_many_runs_of_one_name_is_lost(tmp_path):
    command = [sys.executable, "-c", PUBLISHER, str(tmp_path)]
    processes = [subprocess.Popen(command, stdin=subprocess.PIPE) for _ in range(6)]
    for process in processes:
        process.stdin.close()
    assert [process.wait() for process in processes] == [0] * 6
    names = ["run", *(f"run-{number}" for number in range(2, 61))]
    assert {path.name: (path / "name").read_text() for path in tmp_path.iterdir()} == {n: n for n in names}


def test_the_list_of_a_run_is_what_sha256sum_checks(tmp_path):
    with RunFolder(tmp_path, "run") as folder:
        write(folder.path, "a.csv", "first")
        write(folder.path, "recordings/slip[f=0.09].parquet", b"\0")
        write(folder.path, "a.csv", "second")
        place = folder.publish()
    heading, *lines = (place / LIST).read_text().splitlines()
    assert heading.startswith("# ")
    assert lines == [
        f"{hashlib.sha256(content).hexdigest()}  {name}"
        for name, content in {"recordings/slip[f=0.09].parquet": b"\0", "a.csv": b"second"}.items()
    ]


def test_a_run_in_a_folder_behind_a_link_is_published_there(tmp_path):
    """The user named the link: the reports may lie on another disk."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "reports").symlink_to("disk")
    with RunFolder(tmp_path / "reports", "run") as folder:
        write(folder.path, "summary.csv", "ours")
        assert point_latest(folder.publish()) == ""
    assert sorted(path.name for path in (tmp_path / "disk").iterdir()) == [LATEST, "run"]
    with FolderLock(tmp_path / "reports"):
        assert (tmp_path / "disk" / ".uictest.lock").exists()


def test_a_run_that_is_published_while_its_name_is_being_reserved_has_the_name(tmp_path, monkeypatch):
    """The name that reports state is that of their folder."""
    mkdir = os.mkdir

    def published_first(path, *arguments):
        monkeypatch.setattr(os, "mkdir", mkdir)
        (tmp_path / "run").mkdir()
        mkdir(path, *arguments)

    monkeypatch.setattr(os, "mkdir", published_first)
    with RunFolder(tmp_path, "run") as folder:
        assert folder.name == "run-2"
    assert [path.name for path in tmp_path.iterdir()] == ["run"]

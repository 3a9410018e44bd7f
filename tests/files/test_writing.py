import errno
import os
import stat
import sys

import pytest

from uictest.core.files import WriteError, new_file, write_to


def test_the_file_has_the_content_at_the_end_of_the_block_and_nothing_is_left_beside_it(tmp_path):
    write_to(tmp_path / "summary.csv", "a,b\r\n1,±2\n")
    assert (tmp_path / "summary.csv").read_bytes() == "a,b\r\n1,±2\n".encode()
    assert [path.name for path in tmp_path.iterdir()] == ["summary.csv"]
    target = tmp_path / ("c" * 247 + ".parquet")
    write_to(target, "x")
    assert target.read_text() == "x"
    target = tmp_path / "index.html"
    with new_file(tmp_path, "index.html") as file:
        file.write(b"<html>")
        assert not target.exists()
    assert target.read_text() == "<html>"


def test_a_failed_write_keeps_the_old_file_and_leaves_no_other(tmp_path):
    target = tmp_path / "results.json"
    write_to(target, "old")
    with pytest.raises(KeyboardInterrupt), new_file(tmp_path, "results.json") as file:
        file.write(b"half of the n")
        raise KeyboardInterrupt
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]
    (tmp_path / "kept").mkdir()
    for name in ("a/b/stop.parquet", "kept/stop.parquet"):
        with pytest.raises(ZeroDivisionError), new_file(tmp_path, name):
            raise ZeroDivisionError
    assert sorted(path.name for path in tmp_path.iterdir()) == ["kept", "results.json"]


def test_a_full_disk_is_reported_and_leaves_nothing(tmp_path, monkeypatch):
    def full(_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_to(tmp_path / "a.parquet", b"x")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("folder", ["nowhere", "file"])
def test_errors_name_the_file_that_was_to_be_written(tmp_path, folder):
    (tmp_path / "file").touch()
    target = tmp_path / folder / "a.txt"
    with pytest.raises(WriteError) as caught:
        write_to(target, "x")
    assert caught.value.filename == str(target)
    assert "partial" not in str(caught.value)


def test_a_file_that_cannot_be_put_in_its_place_is_named_and_another_error_keeps_its_name(tmp_path):
    target = tmp_path / "taken"
    target.mkdir()
    (target / "inside").touch()
    with pytest.raises(OSError, match="taken") as caught:
        write_to(target, "x")
    assert caught.value.filename == str(target)
    assert "partial" not in str(caught.value)
    assert list(tmp_path.iterdir()) == [target]
    other = tmp_path / "other"
    with pytest.raises(FileNotFoundError) as caught, new_file(tmp_path, "a.txt"):
        other.read_text()
    assert caught.value.filename == str(other)


@pytest.mark.skipif(os.name != "posix", reason="file modes are POSIX")
def test_the_file_has_the_mode_any_new_file_has(tmp_path):
    (tmp_path / "ordinary").touch()
    write_to(tmp_path / "atomic", "")
    assert (tmp_path / "atomic").stat().st_mode == (tmp_path / "ordinary").stat().st_mode


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such modes")
def test_nobody_else_can_read_or_write_a_private_file(tmp_path):
    path = tmp_path / "kept"
    with new_file(tmp_path, "kept", private=True):
        [temporary] = tmp_path.iterdir()
        assert stat.S_IMODE(temporary.stat().st_mode) == 0o600
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_what_is_no_file_is_not_replaced_by_one(tmp_path):
    """A rename would make a file of `/dev/null`."""
    pipe = tmp_path / "junit.xml"
    os.mkfifo(pipe)
    with pytest.raises(WriteError, match="no file, and not replaced by one"):
        write_to(pipe, "text")
    assert stat.S_ISFIFO(pipe.lstat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


@pytest.mark.parametrize("target", ["pipe", "file", "nothing"])
def test_a_link_is_neither_replaced_nor_followed(tmp_path, target):
    """A rename would make a file of `/dev/stdout`, which is a link."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "file").write_text("mine")
    link = tmp_path / "junit.xml"
    link.symlink_to(target)
    with pytest.raises(WriteError, match="is a link, and not replaced by a file"):
        write_to(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "file").read_text() == "mine"
    assert not (tmp_path / "nothing").exists()

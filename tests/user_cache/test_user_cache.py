"""Only what is intact, ours and made of the same inputs is read: what lies in the cache is executed."""

import os
import resource
import signal
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from uictest.core import user_cache

pytestmark = pytest.mark.skipif(os.name != "posix", reason="files of other kinds, owners and modes are POSIX")

INPUTS, CONTENT = b"sources, versions, options", bytes(range(256)) * 10


@pytest.fixture
def root(tmp_path, monkeypatch):
    """The user's cache, not made yet; the temporary folder can take none."""
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    return tmp_path / "cache"


def only_file(folder):
    (path,) = folder.iterdir()
    return path


def test_content_is_read_for_its_kind_and_inputs_and_no_others(root):
    assert user_cache.read("code", INPUTS) is None
    assert not root.exists(), "reading makes no folders"
    user_cache.write("code", INPUTS, CONTENT)
    assert user_cache.read("code", INPUTS) == CONTENT
    assert user_cache.read("code", INPUTS + b"!") is None
    assert user_cache.read("page", INPUTS) is None


DAMAGE = {
    "a bit of the content": lambda whole: whole[:-1] + bytes([whole[-1] ^ 1]),
    "a bit of the digest": lambda whole: bytes([whole[0] ^ 1]) + whole[1:],
    "cut": lambda whole: whole[:-1],
    "cut within the digest": lambda whole: whole[:20],
    "longer": lambda whole: whole + b"\0",
    "empty": lambda whole: b"",
    "something else": lambda whole: b"\x7fELF" + bytes(500),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_file_is_not_read_and_is_replaced(root, damage):
    user_cache.write("code", INPUTS, CONTENT)
    path = only_file(root)
    path.write_bytes(DAMAGE[damage](path.read_bytes()))
    assert user_cache.read("code", INPUTS) is None
    user_cache.write("code", INPUTS, CONTENT)
    assert user_cache.read("code", INPUTS) == CONTENT


def test_an_intact_file_of_other_inputs_is_not_read(root):
    """Such as one that was copied from a machine with another processor."""
    user_cache.write("code", INPUTS, CONTENT)
    path = only_file(root)
    path.unlink()
    user_cache.write("code", b"another processor", CONTENT)
    only_file(root).rename(path)
    assert user_cache.read("code", INPUTS) is None


@pytest.mark.parametrize("kind", ["FIFO", "socket", "link"])
def test_what_is_no_ordinary_file_is_not_read_and_is_replaced(root, tmp_path, monkeypatch, kind):
    user_cache.write("code", INPUTS, CONTENT)
    path = only_file(root)
    path.rename(tmp_path / "elsewhere")
    if kind == "FIFO":
        os.mkfifo(path)
    elif kind == "socket":
        monkeypatch.chdir(path.parent)
        with socket.socket(socket.AF_UNIX) as bound:
            bound.bind(path.name)  # a whole path may be longer than an address can be
    else:
        path.symlink_to(tmp_path / "elsewhere")
    assert user_cache.read("code", INPUTS) is None
    user_cache.write("code", INPUTS, CONTENT)
    assert user_cache.read("code", INPUTS) == CONTENT


def test_a_folder_in_place_of_the_file_is_left_alone_and_named_once(root, caplog):
    user_cache.write("code", INPUTS, CONTENT)
    path = only_file(root)
    path.unlink()
    path.mkdir()
    for _ in range(2):
        user_cache.write("code", INPUTS, CONTENT)
        assert user_cache.read("code", INPUTS) is None
    assert list(root.iterdir()) == [path]
    (warning,) = [message for message in caplog.messages if str(root) in message]
    assert "cannot be written (Is a directory)" in warning


def test_a_file_that_others_can_write_is_not_read_and_files_are_private_whatever_the_mask(root):
    user_cache.write("code", INPUTS, CONTENT)
    only_file(root).chmod(0o666)
    assert user_cache.read("code", INPUTS) is None
    before = os.umask(0)
    try:
        user_cache.write("code", INPUTS, CONTENT)
    finally:
        os.umask(before)
    assert [path.stat().st_mode & 0o077 for path in (root, only_file(root))] == [0, 0]
    assert user_cache.read("code", INPUTS) == CONTENT


def test_where_the_first_place_takes_nothing_the_next_one_does(root, tmp_path, monkeypatch):
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    user_cache.write("code", INPUTS, CONTENT)
    assert user_cache.read("code", INPUTS) == CONTENT
    assert only_file(tmp_path / f"uictest-{os.getuid()}").read_bytes().endswith(CONTENT)


def test_a_full_disk_is_named_once_and_leaves_nothing(tmp_path):
    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))

    program = """if True:
        from uictest.core import user_cache
        for number in b"ab":
            user_cache.write("code", bytes(number), bytes(1000))
            assert user_cache.read("code", bytes(number)) is None
    """
    places = {"UICTEST_CACHE": str(tmp_path / "cache"), "TMPDIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-B", "-c", program],
        preexec_fn=small_files,
        env={**os.environ, **places},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    first, second, last = done.stderr.splitlines()
    assert first == f"uictest: the cache '{tmp_path}/cache' cannot be written (File too large)"
    assert (
        second == f"uictest: the cache '{tmp_path}/uictest-{os.getuid()}' cannot be written (File too large)"
    )
    assert last.startswith("uictest: nothing is cached")
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_writers_do_not_disturb_each_other(root):
    """Whoever comes last wins, and no reader meets half a file."""

    def take_turns(number):
        user_cache.write("code", INPUTS, CONTENT)
        return user_cache.read("code", INPUTS)

    with ThreadPoolExecutor(8) as pool:
        assert set(pool.map(take_turns, range(64))) == {CONTENT}
    assert len(list(root.iterdir())) == 1


SOMEBODY_ELSE = 65534


def uses(root, monkeypatch):
    """Return whether content is kept in a folder."""
    monkeypatch.setenv("UICTEST_CACHE", str(root))
    user_cache.write("code", b"", b"content")
    return any(root.iterdir())


def warning(caplog, place):
    (text,) = {message for message in caplog.messages if f"'{place}' is not used" in message}
    return text


@pytest.mark.parametrize("mode", [0o777, 0o775, 0o757, 0o1777])
def test_a_folder_that_others_can_write_is_not_used(root, monkeypatch, caplog, mode):
    root.mkdir()
    root.chmod(mode)
    assert not uses(root, monkeypatch)
    assert f"others can write '{root}', and what is cached is executed; `chmod go-w` it" in warning(
        caplog, root
    )


def test_a_planted_file_is_not_read(root):
    user_cache.write("code", b"", b"planted")
    assert user_cache.read("code", b"") == b"planted"
    root.chmod(0o777)
    assert user_cache.read("code", b"") is None


def test_a_folder_below_one_that_others_can_write_is_used_only_where_nobody_renames_it(
    root, monkeypatch, caplog
):
    """They could rename the cache and put their own there."""
    (root / "mine" / "cache").mkdir(parents=True)
    root.chmod(0o777)
    assert not uses(root / "mine" / "cache", monkeypatch)
    assert f"others can write '{root}'" in warning(caplog, root / "mine" / "cache")
    (root / "ours").mkdir()
    root.chmod(0o1777)
    assert uses(root / "ours", monkeypatch)


def test_links_count_where_they_lead_and_where_they_lie(tmp_path, root, monkeypatch):
    shared, own = tmp_path / "shared", tmp_path / "own"
    for folder in (shared, own, shared / "cache", own / "cache"):
        folder.mkdir()
    (own / "to-shared").symlink_to(shared / "cache")
    (own / "to-own").symlink_to(own / "cache")
    (shared / "to-own").symlink_to(own / "cache")
    shared.chmod(0o777)
    assert not uses(own / "to-shared", monkeypatch)
    assert not uses(shared / "to-own", monkeypatch)
    assert uses(own / "to-own", monkeypatch)


@pytest.mark.skipif(os.name == "posix" and os.getuid() != 0, reason="only root can give a folder away")
@pytest.mark.parametrize("given_away", ["the folder", "the one above", "a link"])
def test_what_belongs_to_another_user_is_not_used(tmp_path, root, monkeypatch, caplog, given_away):
    (root / "above" / "cache").mkdir(parents=True)
    (tmp_path / "link").symlink_to(root / "above" / "cache")
    place, cache = {
        "the folder": (root / "above" / "cache", root / "above" / "cache"),
        "the one above": (root / "above", root / "above" / "cache"),
        "a link": (tmp_path / "link", tmp_path / "link"),
    }[given_away]
    os.chown(place, SOMEBODY_ELSE, -1, follow_symlinks=False)
    assert not uses(cache, monkeypatch)
    assert f"'{place}' belongs to another user" in warning(caplog, cache)


@pytest.mark.parametrize("variable", ["UICTEST_CACHE", "XDG_CACHE_HOME", "HOME", "TMPDIR"])
def test_every_place_is_checked(tmp_path, monkeypatch, variable):
    """None of the places that the environment names is used where others can write it."""
    (tmp_path / "file").write_text("not a folder")
    for name in ("UICTEST_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "file"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    shared = tmp_path / "shared"
    shared.mkdir()
    if variable == "TMPDIR":
        monkeypatch.setattr("tempfile.tempdir", str(shared))
    else:
        monkeypatch.setenv(variable, str(shared))
    user_cache.write("code", b"", b"planted")
    assert user_cache.read("code", b"") == b"planted"
    shared.chmod(0o777)
    assert user_cache.read("code", b"") is None


@pytest.mark.parametrize("prepared", ["a link", "a file"])
def test_what_lies_in_the_temporary_folder_under_our_name_is_left_alone(
    tmp_path, root, monkeypatch, prepared
):
    """Where a link in a folder that all can write leads to one that all can write, too."""
    trap, elsewhere = tmp_path / f"uictest-{os.getuid()}", tmp_path / "elsewhere"
    elsewhere.mkdir()
    elsewhere.chmod(0o777)
    if prepared == "a link":
        trap.symlink_to(elsewhere)
    else:
        trap.write_text("")
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    user_cache.write("code", b"", b"content")
    assert list(elsewhere.iterdir()) == []
    assert user_cache.read("code", b"") is None


def test_a_user_without_a_home_has_a_temporary_folder(tmp_path, monkeypatch):
    def homeless(path):
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("UICTEST_CACHE", raising=False)
    monkeypatch.setattr(Path, "expanduser", homeless)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    user_cache.write("code", b"", b"content")
    assert user_cache.read("code", b"") == b"content"

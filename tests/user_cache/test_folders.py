"""A folder that others can write, or swap for another, is not used: what lies in it would be executed."""

import os
from pathlib import Path

import pytest

from uictest.core import user_cache

pytestmark = pytest.mark.skipif(os.name != "posix", reason="owners and modes are POSIX")

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

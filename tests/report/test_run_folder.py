from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from uictest.report.run_folder import LATEST, RunFolder, latest_run, point_latest


def test_a_published_folder_appears_under_its_name_with_its_files(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "reports", "first") as folder:
        (folder.path / "summary.csv").write_text("id\n")
        assert not (tmp_path / "reports" / "first").exists()
        place = folder.publish()
    assert place == tmp_path / "reports" / "first"
    assert [path.name for path in (tmp_path / "reports").iterdir()] == ["first"]
    assert (place / "summary.csv").read_text() == "id\n"


def test_a_taken_name_gets_a_number(tmp_path: Path) -> None:
    for expected in ("run", "run-2", "run-3"):
        with RunFolder(tmp_path, "run") as folder:
            assert folder.publish().name == expected


def test_the_name_that_reports_state_is_that_of_the_folder(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    with RunFolder(tmp_path, "run") as first, RunFolder(tmp_path, "run") as second:
        names = first.name, second.name
        assert names == ("run-2", "run-3")
        places = second.publish(), first.publish()
    assert tuple(place.name for place in reversed(places)) == names


def test_a_name_that_is_taken_meanwhile_gets_a_number(tmp_path: Path) -> None:
    with RunFolder(tmp_path, "run") as folder:
        (tmp_path / "run").mkdir()
        assert folder.publish() == tmp_path / "run-2"


def test_a_folder_that_is_not_published_leaves_nothing_of_what_was_made(tmp_path: Path) -> None:
    def fail_halfway() -> None:
        with RunFolder(tmp_path / "deep" / "reports", "run") as folder:
            (folder.path / "half.csv").write_text("i")
            raise OSError("No space left on device")

    with pytest.raises(OSError, match="No space left"):
        fail_halfway()
    assert list(tmp_path.iterdir()) == []


def test_what_others_put_beside_an_abandoned_folder_stays(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "reports", "run"):
        (tmp_path / "reports" / "note.txt").write_text("mine")
    assert [path.name for path in (tmp_path / "reports").iterdir()] == ["note.txt"]


def test_a_folder_below_a_regular_file_is_an_oserror(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        RunFolder(tmp_path / "file" / "reports", "run")


KILLED_AT_WORK = """
import os, signal, sys
from pathlib import Path
from uictest.report.run_folder import RunFolder
with RunFolder(Path(sys.argv[1]), "killed") as folder:
    (folder.path / "summary.csv").write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks")
def test_what_a_killed_run_left_is_removed_by_the_next_and_what_a_living_one_has_is_not(
    tmp_path: Path,
) -> None:
    subprocess.run([sys.executable, "-c", KILLED_AT_WORK, str(tmp_path)], check=False)
    [left] = tmp_path.iterdir()
    assert left.name.startswith(".killed.")
    with RunFolder(tmp_path, "living") as living:
        assert not left.exists()
        with RunFolder(tmp_path, "later") as later:
            assert living.path.is_dir()
            later.publish()
        assert living.publish() == tmp_path / "living"
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["later", "living"]


def _run(parent: Path, name: str) -> Path:
    run = parent / name
    run.mkdir()
    return run


def test_latest_follows_the_newest_run(tmp_path: Path) -> None:
    for name in ("first", "second"):
        point_latest(_run(tmp_path, name))
        found = latest_run(tmp_path)
        assert found is not None
        assert found.name == name
    assert sorted(path.name for path in tmp_path.iterdir()) == ["first", LATEST, "second"]


def test_the_link_is_relative_so_that_the_folder_can_be_moved(tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    point_latest(_run(tmp_path / "here", "run"))
    (tmp_path / "here").rename(tmp_path / "there")
    assert latest_run(tmp_path / "there") == (tmp_path / "there" / "run").resolve()


def test_where_links_are_impossible_a_text_file_names_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError("links are not supported here")

    monkeypatch.setattr(Path, "symlink_to", refuse)
    run = _run(tmp_path, "run")
    point_latest(run)
    assert (tmp_path / LATEST).read_text() == "run\n"
    assert latest_run(tmp_path) == run


@pytest.mark.parametrize("with_dangling_link", [False, True])
def test_without_a_run_there_is_no_latest(tmp_path: Path, with_dangling_link: bool) -> None:
    if with_dangling_link:
        (tmp_path / LATEST).symlink_to("gone")
    assert latest_run(tmp_path) is None

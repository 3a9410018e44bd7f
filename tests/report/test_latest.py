from __future__ import annotations

from pathlib import Path

import pytest

from uictest.report.latest import LATEST, latest_run, point_latest


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

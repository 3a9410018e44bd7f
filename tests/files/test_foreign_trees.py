"""Whatever stands in a folder of runs: nothing outside of it changes, and nothing in it that is not ours."""

import logging
import os
import tempfile
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings, strategies as st

from uictest.core.files import (
    LATEST,
    LIST,
    FolderInUseError,
    FolderLock,
    ForeignFileError,
    RunFolder,
    begin_list,
    point_latest,
    remove_listed,
    remove_partial_files,
    remove_run,
    write,
)

NAMES = (
    *("run", "run-2", "recordings", "summary.csv", "notes.txt", "index.html", LATEST, LIST),
    *(".lock", ".uictest.lock", ".run.partial", ".old.partial", ".uictest-0123.partial"),
)
TEXTS = st.sampled_from(["mine", "process 4 on here", "uictest", "a  summary.csv\n", "gone\n"])
LINKS = st.sampled_from(["victim.txt", "folder", "folder/inner.csv", "nowhere", ".", "reports"])


def tree(inner):
    return st.dictionaries(st.sampled_from(NAMES), inner, max_size=6)


# A text is a file, a path a link to it below the folder of all, a mapping a folder.
TREES = tree(st.recursive(st.one_of(TEXTS, LINKS.map(Path)), tree, max_leaves=12))


def grow(folder, content, top):
    folder.mkdir(exist_ok=True)
    for name, each in content.items():
        if isinstance(each, dict):
            grow(folder / name, each, top)
        elif isinstance(each, Path):
            (folder / name).symlink_to(top / each)
        else:
            (folder / name).write_text(each)


def state(folder):
    """Every path below a folder, and what is there: links are not followed."""
    found = {}
    for place, folders, names in os.walk(folder):
        for path in (Path(place, name) for name in (*folders, *names)):
            link = f"-> {path.readlink()}" if path.is_symlink() else ""
            found[str(path.relative_to(folder))] = link or (path.read_text() if path.is_file() else "folder")
    return found


@given(TREES, TREES)
@settings(deadline=None, max_examples=40)
def test_nothing_of_somebody_else_changes(reports_tree, partial_tree):
    logging.disable(logging.WARNING)
    with tempfile.TemporaryDirectory() as place:
        top = Path(place)
        (top / "victim.txt").write_text("victim")
        grow(top / "folder", {"inner.csv": "inner", "empty": {}}, top)
        grow(top / "reports", {**reports_tree, ".killed.partial": partial_tree}, top)
        before = state(top)
        work_in(top / "reports")
        after = state(top)
    logging.disable(logging.NOTSET)
    changed = {path for path, content in before.items() if after.get(path) != content}
    renewed = {f"reports/{LATEST}"} if isinstance(reports_tree.get(LATEST), Path) else set()
    assert changed <= renewed
    added = {path.split("/")[1] for path in after.keys() - before.keys() if path.startswith("reports/")}
    assert {path for path in after.keys() - before.keys() if not path.startswith("reports/")} == set()
    assert len(added - {LATEST}) <= 1, "the run, which is published"


def work_in(reports):
    """Do in a folder everything that the room can do."""
    with RunFolder(reports, "run") as folder:
        write(folder.path, "summary.csv", "ours")
        write(folder.path, "recordings/a.csv", "ours")
        run = folder.publish()
    point_latest(run)
    with suppress(OSError), FolderLock(reports):
        pass
    remove_partial_files(reports)
    remove_listed(reports, "*")
    for name in sorted(path.name for path in reports.iterdir()):
        if name != run.name:
            with suppress(OSError, ForeignFileError, FolderInUseError):
                remove_run(reports, name)
    with RunFolder(reports, "run") as folder:
        write(folder.path, "summary.csv", "ours")
    assert (run / "summary.csv").read_text() == "ours"


@pytest.mark.parametrize("below", ["recordings", "recordings/more"])
def test_no_file_is_written_or_removed_behind_a_link(tmp_path, below):
    (tmp_path / "there" / "more").mkdir(parents=True)
    run = tmp_path / "run"
    run.mkdir()
    begin_list(run)
    write(run, f"{below}/a.csv", "ours")
    (run / "recordings").rename(tmp_path / "moved")
    (run / "recordings").symlink_to(tmp_path / "moved")
    before = state(tmp_path / "moved")
    with pytest.raises(OSError, match="is a link, which is not followed"):
        write(run, f"{below}/b.csv", "ours")
    remove_listed(run, "*")
    with pytest.raises(ForeignFileError, match="recordings"):
        remove_run(tmp_path, "run")
    assert state(tmp_path / "moved") == before


@pytest.mark.parametrize("name", ["../out.csv", "a/../../out.csv", "/tmp/out.csv"])
def test_no_name_leads_out_of_the_folder(tmp_path, name):
    (tmp_path / "run").mkdir()
    with pytest.raises(OSError, match="leads out of its folder"):
        write(tmp_path / "run", name, "x")
    assert not (tmp_path / "out.csv").exists()


def test_what_is_not_of_uictest_is_neither_continued_nor_removed(tmp_path, caplog):
    for make in (lambda path: path.write_text("mine"), lambda path: path.symlink_to(tmp_path / "victim")):
        (tmp_path / "victim").write_text("victim")
        make(tmp_path / LIST)
        begin_list(tmp_path)
        write(tmp_path, "a.csv", "ours")
        remove_listed(tmp_path, "*.csv")
        assert (tmp_path / "a.csv").is_file()
        assert (tmp_path / LIST).read_text() in ("mine", "victim")
        (tmp_path / LIST).unlink()
    run = tmp_path / "run"
    run.mkdir()
    begin_list(run)
    for name in ("map-a.csv", "map-b.csv", "summary.csv"):
        write(run, name, name)
    (run / "map-b.csv").write_text("changed by me")
    (run / "map-c.csv").write_text("mine")
    remove_listed(run, "map-*.csv")
    assert sorted(path.name for path in run.iterdir()) == [LIST, "map-b.csv", "map-c.csv", "summary.csv"]
    assert "map-b.csv stays" in caplog.text
    assert "map-c.csv stays" in caplog.text
    write(run, "map-a.csv", "again")
    remove_listed(run, "map-a.csv")
    assert not (run / "map-a.csv").exists()

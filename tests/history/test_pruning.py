import hashlib
import os
from functools import partial
from pathlib import Path

import pytest

from uictest import report
from uictest.core import files
from uictest.core.files import FolderLock
from uictest.runs.history import prune

from .conftest import case


def fates(reports, keep, written, *referred, kind="run"):
    return {each.name: each.kept_because for each in prune(reports, kind, keep, written.name, referred)}


def test_the_newest_stay_and_the_others_go_whatever_files_of_ours_they_hold(publish, reports):
    runs = [publish(case("a"), formats=tuple(report.FORMATS)), *(publish() for _ in range(4))]
    files.write(runs[0], "recordings/slip-120[friction=0.09].parquet", b"")
    with pytest.raises(ValueError, match="at least 1 run stays"):
        fates(reports, 0, runs[-1])
    assert fates(reports, 5, runs[-1]) == {}
    assert fates(reports, 2, runs[-1]) == {run.name: "" for run in reversed(runs[:3])}
    assert [run.exists() for run in runs] == [False, False, False, True, True]
    # That just written stays, though the clock went back.
    assert fates(reports, 1, runs[3]) == {runs[4].name: "the link latest refers to it"}
    assert runs[3].exists()


@pytest.fixture
def two(publish):
    """An old run and the newest."""
    return publish(), publish()


def _write(run, name):
    (run / name).parent.mkdir(parents=True, exist_ok=True)
    with (run / name).open("a") as file:
        file.write("\n")


def _replace_by_a_link(run):
    (run / "summary.csv").unlink()
    (run / "summary.csv").symlink_to("wheelsets.csv")


NOT_OURS = "it holds {}, which uictest did not write"
THEIRS = ["review.md", "notes.csv", "index.html.bak", "sub/run.json", "recordings/mine.csv"]
THEIRS += ["recordings/track-test.parquet", "recordings/a/b.parquet"]
CHANGED = ["summary.csv", "manifest.json", "junit.xml"]
REASONS = [
    # Files of the user were removed that had a name which uictest gives as well.
    *((partial(_write, name=name), NOT_OURS.format(name)) for name in THEIRS + CHANGED),
    (lambda run: (run / files.LIST).write_text("mine\n"), NOT_OURS.format(files.LIST)),
    (_replace_by_a_link, NOT_OURS.format("summary.csv")),
    (lambda run: (run / "mine").mkdir(), NOT_OURS.format("mine")),
    (lambda run: (run / "recordings").mkdir(), NOT_OURS.format("recordings")),
    (lambda run: (run / files.LIST).unlink(), "it has no SHA256SUMS"),
    (lambda run: (run.parent / "accepted").symlink_to(run.name), "the link accepted refers to it"),
    (lambda run: (run.parent / "a.csv").symlink_to(run / "summary.csv"), "the link a.csv refers to it"),
]


@pytest.mark.parametrize(("change", "reason"), REASONS)
def test_what_somebody_may_need_stays_as_it_is_and_the_reason_is_given(two, reports, change, reason):
    old, newest = two
    change(old)
    before = sorted(old.rglob("*"))
    assert fates(reports, 1, newest) == {old.name: reason}
    assert sorted(old.rglob("*")) == before


def test_what_the_command_line_or_a_run_that_stays_for_a_reason_refers_to_stays_too(publish, reports):
    source, baseline, other = publish(), publish(), publish()
    middle = publish(inputs={f"reports/{source.name}/results.json": "00"})
    newest = publish()
    _write(middle, "review.md")
    assert fates(reports, 1, newest, baseline / "results.json", Path("elsewhere")) == {
        middle.name: NOT_OURS.format("review.md"),
        other.name: "",
        baseline.name: "the command line refers to it",
        source.name: f"{middle.name} refers to it",
    }


def test_a_folder_with_a_name_of_the_user_stays_and_so_does_an_incomplete_run(two, publish, reports):
    """A baseline has nothing but files that uictest wrote."""
    old, other = two
    for name in ("index.html", "index-entry.json", "junit.xml"):
        (old / name).unlink(missing_ok=True)
    old.rename(reports / "baseline")
    incomplete, newest = publish(complete=False), publish()
    assert fates(reports, 1, newest) == {
        incomplete.name: "it is incomplete",
        other.name: "",
        "baseline": "somebody gave it this name, as to a baseline",
    }
    assert (reports / "baseline" / "results.json").is_file()


@pytest.mark.parametrize("working_folder", [".", "/"])
def test_baseline_and_source_of_a_run_that_stays_stay_in_every_working_folder(
    publish, reports, monkeypatch, working_folder
):
    baseline, source, other = publish(), publish(), publish()
    newest = publish(
        baseline=report.BaselineComparison(f"reports/{baseline.name}", "00"),
        inputs={f"reports/{source.name}/recordings/a.parquet": "00"},
    )
    monkeypatch.chdir(working_folder)
    said = f"{newest.name} refers to it"
    assert fates(reports, 1, newest) == {other.name: "", source.name: said, baseline.name: said}


@pytest.mark.parametrize("given", ["...", "reports/latest/recordings"])
@pytest.mark.parametrize("name", ["a.parquet", "slip[friction=0.09,command=100].parquet"])
def test_a_file_is_known_by_its_content_where_its_path_no_longer_leads_to_it(publish, reports, given, name):
    source, alike = publish(), publish()
    for run in (source, alike):
        files.write(run, f"recordings/{name}", run.name)
    digest = hashlib.sha256(source.name.encode()).hexdigest()
    newest = publish(inputs={f"{given}/{name}": digest})
    assert fates(reports, 1, newest) == {alike.name: "", source.name: f"{newest.name} refers to it"}


def test_two_runs_that_end_together_do_not_remove_each_other(publish, reports):
    own, other = publish(), publish()
    (reports / "latest").unlink()  # between its publication and the renewal of the link
    assert fates(reports, 1, own) == {other.name: "another process wrote it after this run"}
    assert fates(reports, 1, other) == {own.name: ""}
    assert other.exists()


def test_a_link_that_leads_to_itself_and_a_damaged_path_refer_to_nothing(publish, reports):
    old, newest = publish(), publish(inputs={"a\0b": "00"})
    (reports / "loop").symlink_to("loop")
    (reports / "latest").unlink()
    (reports / "latest").symlink_to("latest")
    assert fates(reports, 1, newest) == {old.name: ""}


def test_a_folder_in_use_stays_as_it_is(two, reports):
    old, newest = two
    with FolderLock(old):
        # The file of the lock is ours, and no reason of its own.
        assert "it is in use by" in fates(reports, 1, newest)[old.name]
    assert (old / "results.json").is_file()


def test_runs_of_other_kinds_do_not_count_and_stay(publish, reports):
    recorded = [publish(command=(command, "a.csv")) for command in ("evaluate", "log", "evaluate", "log")]
    old, newest = publish(), publish()
    assert fates(reports, 1, newest) == {old.name: ""}
    assert all(each.exists() for each in recorded)


@pytest.mark.parametrize(
    "content", [{}, {"manifest.json": "{"}, {"manifest.json": '{"schema": "theirs"}', "results.json": "{}"}]
)
def test_what_uictest_did_not_write_is_never_touched(publish, reports, content):
    damaged, newest = publish(), publish()
    (damaged / "results.json").write_text("{")
    foreign = reports / "20200101T000000Z-00000000"
    foreign.mkdir()
    for name, text in content.items():
        (foreign / name).write_text(text)
    assert fates(reports, 1, newest) == {}
    assert foreign.is_dir()
    assert damaged.is_dir()


def test_a_run_behind_a_link_stays(two, reports, tmp_path):
    old, newest = two
    elsewhere = old.rename(tmp_path / "archive")
    (reports / old.name).symlink_to(elsewhere)
    assert fates(reports, 1, newest) == {}
    assert (elsewhere / "results.json").is_file()


def test_a_removal_that_fails_is_a_reason(two, reports, monkeypatch):
    old, newest = two

    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "rename", refuse)
    assert fates(reports, 1, newest) == {old.name: "it cannot be removed: Permission denied"}
    assert (old / "results.json").is_file()


def test_a_removal_cut_short_is_completed_by_the_next_run(publish, two, reports, monkeypatch):
    """The rest has a hidden name, which no list shows, and belongs to nobody."""
    old, newest = two

    def stop(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("uictest.core.files.run_folder.remove_contents", stop)
        with pytest.raises(KeyboardInterrupt):
            fates(reports, 1, newest)
    assert not old.exists()
    assert len(list(reports.glob(".*.partial"))) == 1
    publish()
    assert list(reports.glob(".*.partial")) == []


def test_what_comes_while_a_run_is_removed_stays_under_its_name(two, reports, monkeypatch):
    old, newest = two
    rename = os.rename

    def written_first(path, *arguments, **places):
        monkeypatch.setattr(os, "rename", rename)
        (old / "notes.txt").write_text("mine")
        rename(path, *arguments, **places)

    monkeypatch.setattr(os, "rename", written_first)
    assert fates(reports, 1, newest) == {old.name: "it holds notes.txt, which uictest did not write"}
    assert (old / "notes.txt").read_text() == "mine"

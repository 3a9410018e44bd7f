"""What is listed of a folder of runs: entries, manifests, and the reason where a folder is no run."""

import json
import os
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from uictest import report
from uictest.judging import evaluation
from uictest.plans.scenario import PASS
from uictest.runs.history import ENTRY, ListedRun, Unlisted, read_folder
from uictest.runs.history.listing import RunEntry, entry_of, read_entry, started_in

from .conftest import case

CONTROLLERS = [
    {"name": "slip-band", "version": "uictest 1", "kind": ""},
    {"name": "x", "version": "", "kind": "c"},
]
SWEEP = {"schema": "uictest/result/2", "kind": "sweep", "name": "study", "cases": 3, "met": 2}
SWEEP |= {"controllers": CONTROLLERS}


def sweep(folder, **changes):
    folder.mkdir(parents=True)
    manifest = {"schema": "uictest/manifest/2", "kind": "sweep", "sweep": "study"}
    manifest |= {"file": "sweeps/study.sweep.yaml", "cases": 3, "inputs": {"../stop.yaml": "00"}}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    document = SWEEP | {"outcomes": {"pass": 2, "fail": 1}} | changes
    (folder / "results.json").write_text(json.dumps(document))
    return folder


def run_of(found):
    assert isinstance(found, ListedRun), found
    return found


def reason_of(found):
    assert isinstance(found, Unlisted), found
    return found.reason


def test_a_run_is_read_with_its_manifest_and_counts_and_without_a_verdict_where_its_entry_is_missing(publish):
    folder = publish(case("a"), case("b", "fail", 480.0), inputs={"a b.yaml": "00"})
    run = run_of(read_folder(folder))
    assert (run.kind, run.inputs, run.subject) == ("run", {"a b.yaml": "00"}, "dry")
    assert (run.counts, run.not_met) == ({"pass": 1, "fail": 1}, 1)
    assert run.page == f"{run.name}/index.html"
    assert run.distances == (470.0, 480.0)
    of_recordings = run_of(read_folder(publish(command=("evaluate", "stop.csv"), formats=())))
    assert (of_recordings.kind, of_recordings.page) == ("evaluate", "")
    (folder / ENTRY).unlink()
    without = run_of(read_folder(folder))
    assert (without.counts, without.note) == ({}, "not listed in full: its index-entry.json is missing")
    assert without.inputs == run.inputs
    assert abs((without.started - run.started).total_seconds()) <= 1.0


def test_a_renamed_run_keeps_its_start_and_a_link_to_it_is_no_run_of_its_own(publish, reports):
    folder = publish()
    started = run_of(read_folder(folder)).started
    os.utime(folder / "results.json", (0, 0))
    renamed = folder.rename(reports / "accepted")
    assert run_of(read_folder(renamed)).started == started == started_in(folder.name)
    (reports / "link").symlink_to("accepted")
    assert reason_of(read_folder(reports / "link")) == "a link to accepted"
    assert reason_of(read_folder(reports)) == "not of uictest: there is no manifest.json"


def test_a_sweep_is_read_with_its_counts_if_it_is_finished_and_no_earlier_one(tmp_path):
    folder = sweep(tmp_path / "study")
    run = run_of(read_folder(folder))
    assert (run.kind, run.counts, run.not_met) == ("sweep", {"pass": 2, "fail": 1}, 1)
    assert (run.subject, run.controllers) == ("study", "slip-band (built into uictest 1), x")
    assert run.inputs == {"sweeps/../stop.yaml": "00"}
    (folder / "results.json").unlink()
    assert "not finished" in reason_of(read_folder(folder))
    assert "earlier run" in reason_of(read_folder(sweep(tmp_path / "other", cases=4)))


@pytest.mark.parametrize("changes", [{"outcomes": 3}, {"met": "all"}, {"schema": "x"}, {"cases": True}])
def test_a_damaged_sweep_is_said_to_be_damaged(tmp_path, changes):
    assert "results.json is damaged" in reason_of(read_folder(sweep(tmp_path / "study", **changes)))


@pytest.mark.parametrize(
    ("file", "schema", "kind"),
    [
        ("fit.json", "uictest/fit/1", "fit"),
        ("validation.json", "uictest/result/2", "validation"),
        ("studies.json", "uictest/studies/1", "studies"),
    ],
)
def test_what_other_commands_write_is_listed(tmp_path, file, schema, kind):
    (tmp_path / file).write_text(json.dumps({"schema": schema, "kind": kind}))
    run = run_of(read_folder(tmp_path))
    assert (run.kind, run.page) == (kind, f"{tmp_path.name}/{file}")


OTHERS_MANIFEST = '{"name": "my web app", "icons": []}'
DAMAGED_MANIFEST = '{"schema": "uictest/manifest/2", "kind": "run", "command": 3}'
OLD_MANIFEST = '{"schema": "uictest/manifest/1", "command": ["uictest", "run"]}'


def _replace(file, make):
    file.unlink()
    make(file)


def _grow(file):
    file.write_bytes(file.read_bytes() + b" ")


_make_a_pipe = partial(_replace, make=os.mkfifo)
_make_a_folder = partial(_replace, make=Path.mkdir)
_let_it_lead_nowhere = partial(_replace, make=lambda file: file.symlink_to("gone"))


@pytest.mark.parametrize(
    ("file", "damage", "reason"),
    [
        ("results.json", Path.unlink, "there is no results.json"),
        ("results.json", "{", "results.json is not what the run wrote: 1 bytes, expected"),
        ("results.json", _grow, "results.json is not what the run wrote"),
        ("manifest.json", _make_a_pipe, "manifest.json is no file"),
        ("manifest.json", _make_a_folder, "manifest.json is no file"),
        ("manifest.json", _let_it_lead_nowhere, "manifest.json is no file"),
        ("manifest.json", "[" * 100_000, "manifest.json is damaged"),
        ("manifest.json", "[]", "manifest.json is damaged: expected an object"),
        ("manifest.json", OTHERS_MANIFEST, "not of uictest: manifest.json has no schema"),
        ("manifest.json", DAMAGED_MANIFEST, "manifest.json is damaged"),
        ("manifest.json", OLD_MANIFEST, "not read: manifest.json has schema 'uictest/manifest/1', written"),
        (ENTRY, "{}", "index-entry.json is damaged"),
        ("manifest.json", lambda file: os.truncate(file, 1 << 40), "manifest.json of 1048576 MB is not read"),
    ],
)
def test_a_damaged_folder_is_no_run_and_the_reason_is_given(publish, file, damage, reason):
    folder = publish()
    if isinstance(damage, str):
        (folder / file).write_text(damage)
    else:
        damage(folder / file)
    assert reason in reason_of(read_folder(folder))


@pytest.mark.parametrize(
    ("name", "started"),
    [
        ("20261122T154928Z-b5ea0345", datetime(2026, 11, 22, 15, 49, 28, tzinfo=UTC)),
        ("validation-20261122T154928Z-b5ea0345-2", datetime(2026, 11, 22, 15, 49, 28, tzinfo=UTC)),
        ("20269922T154928Z-b5ea0345", None),
        ("study", None),
    ],
)
def test_the_name_of_a_run_states_its_start(name, started):
    assert started_in(name) == started


words = st.sampled_from(report.CASE_WORDS)
names = st.text(st.characters(codec="utf-8"), min_size=1, max_size=20)
distances = st.floats(-1e9, 1e9)
entries = st.builds(
    RunEntry,
    **dict.fromkeys(("run", "baseline", "subject", "controllers"), names),
    complete=st.booleans(),
    results_bytes=st.integers(0, 2**40),
    **dict.fromkeys(("counts", "series"), st.dictionaries(words, st.integers(1, 10**6))),
    distances=st.none() | st.tuples(distances, distances),
)


@given(entry=entries)
def test_what_is_read_is_what_was_written(entry):
    assert read_entry(entry.model_dump_json(by_alias=True).encode()) == entry


def test_counts_distances_subject_and_controllers_are_those_of_the_results():
    results = case("a"), case("b", "fail", float("nan")), case("c", "fail", 480.0, expect="fail"), case("d")
    entry = entry_of(report.RunContent("", results), 10)
    assert entry.counts == {"pass": 2, "expected fail": 1, "fail": 1}
    assert entry.distances == (470.0, 480.0)
    assert entry_of(report.RunContent("", [case("b", "fail", float("nan"))]), 10).distances is None
    files = [f"tests/{name}.yaml" for name in ("slip-120", "dry-120", "slip-120", "low", "wet")]
    results = [evaluation.CaseResult(str(n), file, {}, PASS, "pass") for n, file in enumerate(files)]
    manifest = report.RunManifest(versions={"uictest": "0.1.0"})
    entry = entry_of(report.RunContent("", [*results, case("a")], manifest), 10)
    assert entry.subject == "slip-120, dry-120, low and 2 more"
    assert entry.controllers == "threshold (built into uictest 0.1.0)"


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"schema": "uictest/index/2"}, "schema"),
        ({"run": 3}, "run"),
        ({"counts": {"splendid": 1}}, "no verdict 'splendid'"),
        ({"counts": {"pass": -1}}, "counts.pass"),
        ({"distances": [470.0]}, "distances"),
        ({"distances": ["far", 470.0]}, "distances.0"),
        ({"distances": [470.0, float("inf")]}, "distances.1"),
        ({"more": 1}, "more"),
    ],
)
def test_a_damaged_entry_is_rejected_by_the_place_of_the_damage(publish, change, complaint):
    document = json.loads((publish() / ENTRY).read_bytes())
    with pytest.raises(ValueError, match=complaint):
        read_entry(json.dumps(document | change).encode())
    for text in (b"", b"\xff\xfe", b"[]", b"{", b"null", b"[" * 100_000):
        with pytest.raises(ValueError, match=r"\w"):
            read_entry(text)


def test_a_folder_whose_name_is_no_text_has_an_entry_all_the_same():
    """A file name of other bytes than UTF-8 holds lone surrogates, which no JSON file can."""
    baseline = report.BaselineComparison("old-\udcff", "00")
    results = [evaluation.CaseResult("a", "stop-\udcff.csv", {}, PASS, "pass")]
    entry = entry_of(report.RunContent("run-\udcff", results, baseline=baseline), 1)
    read = read_entry(entry.model_dump_json(by_alias=True).encode())
    assert (read.run, read.baseline, read.subject) == (r"run-\udcff", r"old-\udcff", r"stop-\udcff")

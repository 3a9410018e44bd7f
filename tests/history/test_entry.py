import json

import pytest
from hypothesis import given, strategies as st

from uictest import report
from uictest.judging import evaluation
from uictest.plans.scenario import PASS
from uictest.runs.history.listing import ENTRY, RunEntry, entry_of, read_entry

from .conftest import case

words = st.sampled_from(report.CASE_WORDS)
names = st.text(st.characters(codec="utf-8"), min_size=1, max_size=20)
distances = st.floats(-1e9, 1e9)
entries = st.builds(
    RunEntry,
    run=names,
    complete=st.booleans(),
    results_bytes=st.integers(0, 2**40),
    baseline=names,
    subject=names,
    controllers=names,
    counts=st.dictionaries(words, st.integers(1, 10**6)),
    series=st.dictionaries(words, st.integers(1, 100)),
    distances=st.none() | st.tuples(distances, distances),
)


@given(entry=entries)
def test_what_is_read_is_what_was_written(entry):
    assert read_entry(entry.model_dump_json(by_alias=True).encode()) == entry


def test_counts_and_distances_are_those_of_the_results():
    results = case("a"), case("b", "fail", float("nan")), case("c", "fail", 480.0, expect="fail"), case("d")
    entry = entry_of(report.RunContent("", results), 10)
    assert entry.counts == {"pass": 2, "expected fail": 1, "fail": 1}
    assert entry.distances == (470.0, 480.0)
    assert entry_of(report.RunContent("", [case("b", "fail", float("nan"))]), 10).distances is None


def test_the_subject_is_what_was_run_with_its_controllers():
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


def test_what_is_no_entry_is_rejected():
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

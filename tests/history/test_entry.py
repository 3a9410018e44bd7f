import json
from dataclasses import replace

import pytest
from hypothesis import given, strategies as st

from uictest import report
from uictest.judging.evaluation import RepeatedStop, Repeats
from uictest.runs.history.entry import ENTRY, CaseEntry, RunEntry, _written, entry_of, read_entry

from .conftest import case

STOPS = tuple(RepeatedStop(seed, "pass") for seed in range(3))
words = st.sampled_from(report.CASE_WORDS)
names = st.text(st.characters(codec="utf-8"), min_size=1, max_size=20)
entries = st.builds(
    RunEntry,
    name=names,
    complete=st.booleans(),
    results_bytes=st.integers(0, 2**40),
    baseline=names,
    counts=st.dictionaries(words, st.integers(1, 10**6)),
    series=st.dictionaries(words, st.integers(1, 100)),
    cases=st.lists(
        st.builds(
            CaseEntry, names, words, st.none() | st.floats(-1e9, 1e9), st.lists(names, max_size=3).map(tuple)
        )
    ),
)


@given(entry=entries)
def test_what_is_read_is_what_was_written(entry):
    assert read_entry(_written(entry).model_dump_json(by_alias=True).encode()) == entry


def test_counts_and_distances_are_those_of_the_results():
    results = case("a"), case("b", "fail", float("nan")), case("c", "fail", expect="fail"), case("d")
    entry = entry_of(report.RunContent("", results), 10)
    assert entry.counts == {"pass": 2, "expected fail": 1, "fail": 1}
    assert [each.distance for each in entry.cases] == [470.0, None, 470.0, 470.0]
    assert list(entry.cases[0].parts_by_kind) == ["vehicle", "controller", "expect"]


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"schema": "uictest/index-entry/2"}, "schema"),
        ({"run": 3}, "run"),
        ({"counts": {"splendid": 1}}, "no verdict 'splendid'"),
        ({"counts": {"pass": -1}}, "counts.pass"),
        ({"cases": [["a", "pass", None, [99]]]}, "found number 99"),
        ({"parts": ["x"], "cases": [["a", "pass", None, [1]]]}, "there are 1 parts, found number 1"),
        ({"cases": [["a", "splendid", None, []]]}, "no verdict 'splendid'"),
        ({"cases": [["a", "pass", "far", []]]}, "cases.0.2"),
        ({"cases": [["a", "pass", float("inf"), []]]}, "cases.0.2"),
        ({"cases": 3}, "cases"),
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
    entry = RunEntry("run-\udcff", True, 1, "old-\udcff", {}, {}, ())
    text = _written(entry).model_dump_json(by_alias=True).encode()
    assert (read_entry(text).name, read_entry(text).baseline) == (r"run-\udcff", r"old-\udcff")


def test_how_a_stop_is_repeated_stands_among_what_it_was_run_with():
    rules = {"all": Repeats("all", STOPS), "share": Repeats("at_least", STOPS, required_share=0.6)}
    results = [replace(case(name), repeats=repeats) for name, repeats in rules.items()]
    cases = entry_of(report.RunContent("", results), 10).cases
    parts = [entry.parts_by_kind["repeat"] for entry in cases]
    assert parts == [["repeat/3-all"], ["repeat/3-at_least-0.6"]]


def test_without_its_cases_an_entry_has_the_same_head(publish):
    text = (publish(case("a"), case("b", "fail")) / ENTRY).read_bytes()
    whole, head = read_entry(text), read_entry(text, with_cases=False)
    assert (head.counts, head.name, head.cases) == (whole.counts, whole.name, ())

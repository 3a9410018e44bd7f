"""`scripts/same_results.py`: every number and verdict over the shipped files is the one that was kept."""

import importlib
import math
from pathlib import Path

import pandas as pd
import pytest

REPOSITORY = Path(__file__).parents[1]
DISTANCE = 843.2029680025092


@pytest.fixture
def results(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "scripts")
    return importlib.import_module("same_results")


def record(distance, status="pass"):
    return f"status={status} distance={distance.hex()}"


def test_a_number_that_moved_in_its_last_bit_is_named(results):
    moved = math.nextafter(DISTANCE, math.inf)
    [line] = results.difference("run slip-120", record(DISTANCE), record(moved))
    assert line == f"run slip-120: distance 843.2029680025092 -> {moved!r}"


def test_a_status_that_turned_and_a_field_that_is_gone_are_named(results):
    lines = results.difference("fit slip-120", record(DISTANCE), "status=fail")
    assert lines == [
        "fit slip-120: status pass -> fail",
        "fit slip-120: distance 843.2029680025092 -> missing",
    ]


def test_numbers_of_a_solver_are_compared_to_a_millionth(results):
    assert results.difference("fit slip-120", record(DISTANCE), record(DISTANCE * (1 + 9e-7))) == []
    assert results.difference("fit slip-120", record(DISTANCE), record(DISTANCE * (1 + 2e-6)))
    assert results.difference("bench random", record(DISTANCE), record(DISTANCE * (1 + 9e-7)))


def test_a_count_is_no_number_of_a_solver(results):
    assert results.difference("fit slip-120", "windows=1000000", "windows=1000001")


def test_a_record_that_vanished_or_came_is_named_though_it_was_empty(results):
    assert results.difference("run a train", "", None) == ["run a train: missing"]
    assert results.difference("run a train", None, "") == ["run a train: new"]


def test_sentences_and_versions_of_a_sweep_do_not_count_and_numbers_and_outcomes_do(results):
    columns = {"outcome": ["pass"], "braking_distance_m": [DISTANCE], "reason": ["too long"], "met": [True]}
    kept = dict(results.column_records("s", pd.DataFrame({**columns, "controller_version": ["1.0"]})))
    assert kept.keys() == {"s column outcome", "s column braking_distance_m", "s column met"}
    columns["outcome"] = ["fail"]
    assert dict(results.column_records("s", pd.DataFrame(columns))) != kept


@pytest.fixture
def one_number(results, monkeypatch, tmp_path):
    """Two groups of one number each, kept as 1.0; set what they are found to be now."""
    now = {"a": 1.0, "b": 1.0}
    groups = {name: lambda name=name: iter([("stop", {"distance": now[name]})]) for name in now}
    monkeypatch.setattr(results, "GROUPS", groups)
    monkeypatch.setattr(results, "KEPT", tmp_path / "kept.txt")
    assert results.main(["--accept"]) == 0
    return now


def test_what_moved_is_printed_and_the_exit_code_is_one(results, one_number, capsys):
    assert results.main([]) == 0
    one_number["b"] = 2.0
    capsys.readouterr()
    assert results.main([]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "b stop: distance 1.0 -> 2.0",
        "2 records, differences: 1",
    ]


def test_accepting_one_group_leaves_what_is_kept_of_others(results, one_number):
    one_number |= {"a": 3.0, "b": 3.0}
    assert results.main(["-k", "a", "--accept"]) == 0
    assert results.KEPT.read_text() == f"a stop: distance={(3.0).hex()}\nb stop: distance={(1.0).hex()}\n"


def test_every_group_has_kept_records_and_no_other(results):
    kept = {line.partition(" ")[0] for line in results.KEPT.read_text("utf-8").splitlines()}
    assert kept == results.GROUPS.keys()


@pytest.mark.slow
def test_the_results_over_the_shipped_files_are_those_kept(results, capsys):
    code = results.main([])
    assert code == 0, capsys.readouterr().out

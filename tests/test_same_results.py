"""`scripts/same_results.py`: every number and verdict over the shipped files is the one that was kept."""

import importlib
import math
from pathlib import Path

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


def test_every_group_has_kept_records_and_no_other(results):
    kept = {line.partition(" ")[0] for line in results.KEPT.read_text("utf-8").splitlines()}
    assert kept == results.GROUPS.keys()


@pytest.mark.slow
def test_the_results_over_the_shipped_files_are_those_kept(results, capsys):
    code = results.main([])
    assert code == 0, capsys.readouterr().out

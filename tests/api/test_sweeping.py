"""Sweeps in Python are those of the command."""

import csv
from pathlib import Path

import pytest

import uictest
from uictest.running.chunked import ChunkStore

TEXT = """schema: uictest/scenario/1
name: study
extends: scenarios/stop.yaml
vary:
  matrix:
    rail.friction: [0.06, 0.1]
"""


@pytest.fixture
def study(write):
    write()
    path = Path("study.sweep.yaml")
    path.write_text(f"{TEXT}    brake.command: [80 %, 100 %]\n")
    return path


def same(value, text):
    """Return whether a cell of a CSV file is this value."""
    if isinstance(value, str | bool):
        return text.lower() == str(value).lower()
    return text == "" if value != value else float(text) == value


def test_rows_are_those_of_the_command(study, command):
    assert command("sweep", study, "-o", "out") == 0
    frame = uictest.sweep(study).frame()
    with Path("out/study/summary.csv").open(newline="") as file:
        written = list(csv.DictReader(file))
    rows = frame.reset_index().to_dict("records")
    assert len(rows) == len(written) == 4
    assert [set(row) for row in rows] == [set(row) for row in written]
    for row, line in zip(rows, written, strict=True):
        for column, value in row.items():
            assert same(value, line[column]), column
    assert {frame.attrs["units"][f"{name}_distance_m"] for name in ("braking", "deceleration")} == {"m"}
    assert list(frame["values.brake.command"]) == [0.8, 1.0, 0.8, 1.0]


def test_nothing_is_left_behind_without_output(study, workplace):
    before = sorted(workplace.rglob("*"))
    results = uictest.sweep(study, jobs=1)
    assert (len(results), results.met, results.folder) == (4, True, None)
    assert sorted(workplace.rglob("*")) == before
    assert repr(results).startswith("study: 4 cases")


def test_one_measure_may_stand_alone(study):
    name = "braking_time_s"
    alone, listed = (uictest.sweep(study, measures=each).result.maps for each in (name, [name]))
    assert alone == listed


def test_a_finished_sweep_is_not_run_again(study, monkeypatch):
    first = uictest.sweep(study, output="out")
    assert first.folder == Path("out/study").absolute()

    def fail(*_):
        raise AssertionError("a chunk was computed again")

    monkeypatch.setattr(ChunkStore, "write", fail)
    assert uictest.sweep(study, output="out").frame().equals(first.frame())
    with pytest.raises(ValueError, match="holds chunks of this sweep with other inputs"):
        uictest.sweep(study, output="out", seed=3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"select": "nothing"}, "nothing selected among 4 cases"),
        ({"measures": ["braking_distanc_m"]}, "did you mean 'braking_distance_m'"),
        ({"frontier": "rail.fric"}, "rail.fric"),
        ({"frontier": "rail.friction", "tolerance": "wide"}, "wide"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(study, arguments, message):
    with pytest.raises(ValueError, match=message):
        uictest.sweep(study, **arguments)


def test_errors_of_the_file_have_their_places(study):
    study.write_text(f"{TEXT}    brake.comand: [80 %]\n")
    with pytest.raises(uictest.ScenarioErrors, match=r"study\.sweep\.yaml:7:5: .*brake\.comand"):
        uictest.sweep(study)

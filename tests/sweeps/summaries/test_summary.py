"""What the rows of a sweep come to."""

import csv
import json
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries.trends import MOST_VALUES, MeasureSums, ReportedMeasure, reported_measures
from uictest.report import SweepContent, publication_of_sweep, publish, write_sweep_result
from uictest.report.sweep.result import read_sweep_document, sweep_document
from uictest.report.sweep.sweep_maps import map_lines
from uictest.running.chunked import CaseSelection, ChunkStore

from ..conftest import MATRIX, SCENARIO, formula, made_up, result_of, stored


def write(folder, result, file):
    """Write the files of a finished sweep."""
    write_sweep_result(folder, result)
    publish(publication_of_sweep(SweepContent(folder, result, {"file": str(file)})), ["csv", "junit"], folder)


@pytest.fixture
def finished(load, tmp_path):
    """The findings of a finished sweep and the folder they are written to."""

    def finish(text=MATRIX, stop=SCENARIO):
        selection = CaseSelection(load(text, stop=stop))
        store = stored(selection, made_up(selection.plan), tmp_path / "out")
        keys = selection.plan.keys
        result = result_of(selection, store, (keys[0], keys[1]))
        write(store.folder, result, selection.plan.file)
        return result, store.folder

    return finish


def unstopped(parameters, own, rail):
    """Stops of the formula, of which those on the slipperiest rail are not over when the simulation ends."""
    measures, wheelsets = formula(parameters, own, rail)
    running = rail[:, 1, 0] < 0.09
    measures["stopped"] = np.where(running, 0.0, 1.0)
    measures["end_speed"][running] = 2.0
    wheelsets["longest_lock"] = 0.0
    return measures, wheelsets


def test_stops_that_are_not_over_are_counted_as_inconclusive_and_never_as_met(load, tmp_path):
    selection = CaseSelection(load(MATRIX.replace("100 %]", "100 %]\n  simulation.maximum_duration: [60 s]")))
    runner = made_up(selection.plan, unstopped)
    store = stored(selection, runner, tmp_path / "out")
    result = result_of(selection, store)
    write(store.folder, result, selection.plan.file)
    assert result.outcomes["inconclusive"] == 2
    assert result.met == 4
    assert result.notes == ()
    heading, *rates = table(store.folder / "tables/rates.csv")
    counts = {row[1]: row[heading.index("inconclusive")] for row in rates if row[0] == "rail.friction"}
    assert counts == {"0.08": "2", "0.10": "0", "0.12": "0"}
    assert result.missed[0].outcome == "inconclusive"
    assert "the simulation ended after 60 s at 7.2 km/h" in result.missed[0].reason


def read_document(folder):
    return json.loads((folder / "results.json").read_text())


def table(path):
    with path.open(newline="") as file:
        return list(csv.reader(file))


def test_the_files_of_a_summary_hold_a_row_per_case_its_counts_maps_and_parameters_and_come_back(finished):
    result, folder = finished()
    assert result.cases == 6
    rates = table(folder / "tables/rates.csv")
    by_friction = {row[1]: (row[2], row[3]) for row in rates if row[0] == "rail.friction"}
    # Wheels lock where command - 9 friction exceeds 0.2.
    assert by_friction == {"0.08": ("2", "1"), "0.10": ("2", "2"), "0.12": ("2", "2")}
    assert [case.id for case in result.missed] == ["study[friction=0.08,command=100]"]
    document = read_document(folder)
    assert document["varied"] == ["rail.friction", "brake.command"]
    base = {role: document["parts"][part_id] for role, part_id in document["base"].items()}
    assert base["controller"]["name"] == "threshold"
    (friction,) = (each for each in base["scenario.rail"]["parameters"] if each["key"] == "rail.friction")
    assert (friction["value"], friction["library_value"]) == (0.1, 0.3)
    columns = set(pq.read_schema(folder / "summary.parquet").names)
    figures = [*document["measures"], *document["trends"]]
    assert {len(each["columns"]) for each in figures} == {1, 4}
    assert all(columns.issuperset(each["columns"]) for each in figures)
    assert table(folder / "tables/map-met.csv") == [
        ["rail.friction \\ brake.command", "80 %", "100 %"],
        ["0.08", "1.0", "0.0"],
        ["0.10", "1.0", "1.0"],
        ["0.12", "1.0", "1.0"],
    ]
    assert list(map_lines(result.maps[0], None))[1:] == [
        "      80 %  100 %",
        "0.08     .      #",
        "0.10     .      .",
        "0.12     .      .",
    ]
    binary = pd.read_parquet(folder / "summary.parquet")
    text = pd.read_csv(folder / "summary.csv", dtype={"parameters.rail.friction": str})
    assert len(binary) == len(text) == 6
    assert text["id"].tolist() == binary["id"].tolist()
    assert text["braking_distance_m"].tolist() == binary["braking_distance_m"].tolist()
    assert text["parameters.rail.friction"].tolist() == binary["parameters.rail.friction"].tolist()
    assert text["initial_adhesion_g"].isna().all()
    suite = ElementTree.parse(folder / "junit.xml").getroot()[0]
    assert (suite.get("tests"), suite.get("failures")) == ("3", "1")
    assert [case.get("name") for case in suite] == [
        f"study[rail.friction={mu}]" for mu in ("0.08", "0.10", "0.12")
    ]
    assert "1 of 2 cases did not meet their expectation" in (suite[0][0].text or "")
    assert {name for case in suite for name in case.attrib} == {"classname", "name"}  # no `file`, for Jenkins
    read_back = read_sweep_document(read_document(folder))
    assert sweep_document(read_back) == read_document(folder)
    assert replace(read_back, maps=()) == replace(result, maps=())
    others = dict.fromkeys(("invalid", "inconclusive", "error", "skipped"), 0)
    assert document["outcomes"] == {"pass": 5, "fail": 1, **others}
    assert document["maps"][0]["means"][0] == [1.0, 0.0]
    cases = binary.to_dict("records")
    trends = {tuple(row[:3]): row[3:] for row in table(folder / "tables/trends.csv")}
    for key, value in {
        (key, case[f"parameters.{key}"]) for case in cases for key in ("rail.friction", "brake.command")
    }:
        own = [case["braking_distance_m"] for case in cases if case[f"parameters.{key}"] == value]
        unit, count, *numbers = trends[key, value, "braking distance"]
        assert (unit, count) == ("m", str(len(own)))
        expected = [min(own), sum(own) / len(own), max(own)]
        assert [float(number) for number in numbers] == pytest.approx(expected)


def test_rows_of_a_zip_that_share_a_value_are_counted_together(finished):
    _, folder = finished("zip:\n  rail.friction: [0.08, 0.10, 0.12]\n  brake.command: [80 %, 100 %, 80 %]\n")
    rates = [row[1:3] for row in table(folder / "tables/rates.csv") if row[0] == "brake.command"]
    assert rates == [["80 %", "2"], ["100 %", "1"]]
    assert [row[0] for row in table(folder / "tables/map-met.csv")[1:]] == ["0.08", "0.10", "0.12"]
    assert table(folder / "tables/map-met.csv")[0][1:] == ["80 %", "100 %"]


def test_a_parameter_of_too_many_values_has_no_trend(finished):
    many = ", ".join(str(round(0.05 + k * 1e-4, 4)) for k in range(MOST_VALUES + 1))
    _, folder = finished(MATRIX.replace("[0.08, 0.10, 0.12]", f"[{many}]"))
    assert {row[0] for row in table(folder / "tables/trends.csv")[1:]} == {"brake.command"}


@pytest.mark.parametrize(("count", "times"), [(MOST_VALUES, 2), (MOST_VALUES + 1, 1)])
def test_chunks_are_read_again_for_trends_alone(load, tmp_path, monkeypatch, count, times):
    text = f"ranges:\n  brake.command: {{first: 60 %, last: 100 %, count: {count}}}\n"
    selection = CaseSelection(load(text))
    store = stored(selection, made_up(selection.plan), tmp_path / "out")
    read = []
    monkeypatch.setattr(ChunkStore, "tables", counting(ChunkStore.tables, read))
    assert bool(result_of(selection, store).trends) == (times == 2)
    assert len(read) == times * selection.chunks


def counting(tables, read):
    """Return the method of a store that notes each table which it yields."""

    def counted(store, chunks, columns=None):
        for table in tables(store, chunks, columns):
            read.append(table)
            yield table

    return counted


def test_a_large_map_is_shown_coarser_and_drawn_parameters_are_counted_in_intervals(finished):
    result, folder = finished(
        "ranges:\n  rail.friction: {first: 0.05, last: 0.15, count: 60}\n"
        "  brake.command: {first: 70 %, last: 100 %, step: 30 %}\n"
    )
    assert len(list(map_lines(result.maps[0], None))) == 3 + 20
    assert len(table(folder / "tables/map-met.csv")) == 1 + 60
    result, _ = finished(
        "sample:\n  method: sobol\n  size: 64\n  parameters:\n    rail.friction: {uniform: [0.05, 0.15]}\n"
        "    rig.topology: {choice: [one-caliper, four-caliper]}\n"
    )
    counts = result.rates["rail.friction"]
    assert [count.value.label for count in counts][:2] == ["0.05 .. 0.06", "0.06 .. 0.07"]
    assert sum(count.cases for count in counts) == 64
    assert [count.cases for count in result.rates["rig.topology"]] == [32, 32]


def test_the_requirements_of_the_scenario_are_those_of_every_testcase(finished):
    _, folder = finished()
    assert not (folder / "junit-properties.xml").exists()
    result, folder = finished(MATRIX, f"{SCENARIO}requirements: [BR-1, BR-2]\ntest_case: WSP-TC-7\n")
    assert (result.requirements, result.test_case) == (("BR-1", "BR-2"), "WSP-TC-7")
    assert result.notes[0] == "requirements that the scenario and its criteria name: BR-1, BR-2"
    assert read_sweep_document(read_document(folder)).requirements == ("BR-1", "BR-2")
    suite = ElementTree.parse(folder / "junit.xml").getroot()[0]
    assert [each.attrib for each in suite.findall("properties/property")] == [
        {"name": "requirements", "value": "BR-1,BR-2"}
    ]
    assert not suite.findall("testcase/properties")
    with_properties = ElementTree.parse(folder / "junit-properties.xml").getroot()[0]
    for testcase in with_properties.findall("testcase"):
        assert [
            (each.get("name"), each.get("value")) for each in testcase.findall("properties/property")
        ] == [("polarion-testcase-id", "WSP-TC-7"), ("test_key", "WSP-TC-7"), ("requirements", "BR-1,BR-2")]


def test_sensitivities_of_a_saltelli_sample(finished):
    result, folder = finished(
        "sample:\n  method: saltelli\n  size: 64\n  parameters:\n    rail.friction: {uniform: [0.08, 0.12]}\n"
        "    brake.command: {uniform: [80 %, 100 %]}\n"
    )
    # The formula's distance depends on friction alone.
    distance = [each for each in result.sensitivities if each.measure == "braking_distance_m"]
    assert [each.total.value for each in distance] == pytest.approx([1.0, 0.0], abs=0.05)
    assert table(folder / "tables/sensitivity.csv")[0][:3] == ["measure", "parameter", "first"]
    assert "rail.friction: the scenario's own 0.1 lies inside the range 0.08 .. 0.12" in result.notes


MEASURE = ReportedMeasure("slide", "%", ("a", "b"), 100.0)
values = st.one_of(st.none(), st.floats(-1e6, 1e6))
rows = st.lists(st.tuples(values, values), min_size=1, max_size=60)


def table_of(found):
    a, b = ([row[place] for row in found] for place in range(2))
    return pa.table({"a": pa.array(a, pa.float64()), "b": pa.array(b, pa.float64())})


@given(rows, st.integers(0, 60))
def test_every_case_with_the_figure_counts_once_in_any_parts(found, cut):
    sums = MeasureSums(MEASURE)
    for chunk in (found[:cut], found[cut:]):
        sums.add(table_of(chunk))
    known = [100.0 * max(x for x in row if x is not None) for row in found if row != (None, None)]
    assert sums.cases == len(known)
    if known:
        result = sums.range()
        assert (result.minimum, result.maximum) == (min(known), max(known))
        assert result.mean == pytest.approx(np.mean(known), rel=1e-9, abs=1e-6)


def test_a_measure_that_is_asked_for_and_usual_stands_once():
    asked = reported_measures(["braking_distance_m", "locked_time_s_3"], "10 km/h")
    names = [measure.name for measure in asked]
    assert names.count("braking distance") == 1
    assert names[-1] == "locked_time_s_3"

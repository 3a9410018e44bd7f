"""Series as users meet them: run, listed, checked, reported again, evaluated from recordings."""

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from uictest.core import recording
from uictest.core.recording.formats import writer_of
from uictest.judging import series

from ..conftest import results_of, verdicts_in

DRY = "tags: [reference]\nrail: {condition: dry}\ncriteria: uictest-stop\n"
WET = "rail: {condition: wet, friction: 0.06}\ncriteria: uictest-stop\n"
PROFILE = """schema: uictest/criteria/1
name: own
criteria:
  - {id: stopping-distance, layer: requirement, scope: series, measure: median_braking_distance, upper: LIMIT}
"""
SERIES = """schema: uictest/series/1
name: small
tags: [acceptance]
repeat: 2
dry: {scenario: dry.yaml, repeat: 1}
wet: wet.yaml
criteria: own.yaml
"""


@pytest.fixture
def campaign(scenario):
    """scenarios/small.series.yaml with a dry stop and two wet ones from 30 km/h, and its own criteria."""

    def write(limit="900 % of the dry stop", text=""):
        scenario("dry", DRY)
        scenario("wet", WET)
        Path("scenarios/own.yaml").write_text(PROFILE.replace("LIMIT", limit))
        path = Path("scenarios/small.series.yaml")
        path.write_text(SERIES + text)
        return path

    return write


def test_a_series_and_its_requirements_are_listed_and_a_dry_run_names_its_stops(call, campaign):
    path = campaign(text="requirements: [BR-1, BR-2]\n")
    answer = call("list", path, "--requirements")
    assert answer.out == "covered\tBR-1\tseries small (1 series)\ncovered\tBR-2\tseries small (1 series)\n"
    (first, _) = json.loads(call("list", path, "--requirements", "--format", "json").out)
    assert first["verified_by"] == [{"series": "small", "cases": [], "series_ids": ["small"]}]
    path = campaign()
    for arguments in (("run", path, "--dry-run"), ("list", path)):
        assert call(*arguments).out.splitlines() == ["small", "  dry small.dry", "  wet small.wet x 2"]
    (listed,) = json.loads(call("list", path, "--format", "json").out)
    assert [(stop["role"], stop["repeat"]) for stop in listed["stops"]] == [("dry", 1), ("wet", 2)]


def test_a_series_is_run_judged_and_reported_and_reported_again(call, campaign):
    answer = call("run", campaign(), "--report", "csv,html,md", code=0)
    lines = answer.out.splitlines()
    [criterion] = [line for line in lines if line.startswith("stopping-distance")]  # on one line
    assert " of the dry stop (limit 900 %)" in criterion
    assert max(map(len, lines)) <= 100
    assert "Valid stops from 30 km/h: dry 1 of 1, wet 2 of 2" in answer.out
    assert "PASSED: 1 series: 1 pass; 1 of 1 criteria of series not certain; took" in answer.out
    tables = {path.name for path in Path("reports/latest/tables").iterdir()}
    assert tables == {"series.csv", "series-criteria.csv", "series-stops.csv"}
    (testcase,) = ElementTree.parse("reports/latest/junit.xml").iter("testcase")
    assert testcase.get("name") == "small: stopping-distance"
    # Its stops are no cases of the run: a wet stop that fails is a figure, not a failure.
    assert results_of()["cases"] == []
    assert call("report", "reports/latest", "--format", "junit,md,csv", "-o", "again").code == 0
    for name in tables:
        assert Path("again/tables", name).read_text() == Path("reports/latest/tables", name).read_text()


def test_a_series_stands_beside_the_scenarios_of_a_folder_and_a_miss_is_one(call, campaign):
    campaign()
    answer = call("run", "scenarios", code=0)
    assert "PASSED: 2 cases: 2 pass; 1 series: 1 pass; 1 of 1 criteria of series not certain;" in answer.out
    assert verdicts_in(answer.out) == {"dry": "pass", "wet": "pass"}
    assert re.search("^pass small", answer.out, re.MULTILINE)
    assert [case["id"] for case in results_of()["cases"]] == ["dry", "wet"]
    answer = call("run", campaign("101 % of the dry stop"), "--format", "github", code=1)
    assert "FAILED: 1 of 1 series is not as expected: small" in answer.out
    assert "::error file=scenarios/small.series.yaml,title=fail small::fail: " in answer.out
    assert call("run", "scenarios", "--lf", "--dry-run").out.splitlines()[0] == "small"
    assert call("run", campaign("101 % of the dry stop", "expect: fail\n")).code == 0


def test_set_seed_and_repeat_reach_all_stops_and_json_prints_the_document(call, campaign):
    document = json.loads(call("run", campaign(), "--format", "json").out)
    (read,) = series.series_results_of(document["series"])
    assert (read.id, read.outcome) == ("small", "pass")
    assert [stop.seed for stop in series.observed_stops(read.cases, 3.0)] == [None, 0, 1]
    path = campaign()
    assert call("run", path, "--set", "rig.wsp=bypassed", "--seed", "40", "--repeat", "3").code in (0, 1)
    (read,) = series.series_results_of(results_of()["series"])
    assert [stop.seed for stop in series.observed_stops(read.cases, 3.0)] == [40, 41, 42, 40, 41, 42]
    parts = [part for stop in read.cases for part in stop.case.parts.values()]
    assert {p.value for part in parts for p in part.parameters if p.key == "rig.wsp"} == {"bypassed"}


@pytest.mark.parametrize(
    ("option", "word", "name"),
    [
        ("-k", "small", "small"),
        ("-k", "wet", "wet"),
        ("-m", "acceptance", "small"),
        ("-m", "reference", "dry"),
    ],
)
def test_series_are_selected_like_cases(call, campaign, option, word, name):
    campaign()
    listed = call("list", "scenarios", option, word).out.splitlines()
    assert [line for line in listed if not line.startswith(" ")] == [name]


def test_the_first_series_that_is_missed_ends_the_run(call, campaign):
    path = campaign("101 % of the dry stop", "matrix: {controller: [threshold, slip-band]}\n")
    assert "fail small[controller=slip-band]" not in call("run", path, "-x").out
    (read,) = series.series_results_of(results_of()["series"])
    assert read.id == "small[controller=threshold]"
    assert results_of()["complete"] is False


@pytest.mark.parametrize(("maxfail", "series_run"), [(1, 0), (2, 1), (3, 2)])
def test_cases_that_are_missed_count_towards_the_series_that_may_be(
    call, scenario, campaign, maxfail, series_run
):
    path = campaign("101 % of the dry stop", "matrix: {controller: [threshold, slip-band]}\n")
    alone = scenario("alone", "criteria: uictest-stop\nexpect: fail\n")
    assert call("run", alone, path, "--maxfail", str(maxfail)).code == 1
    written = results_of()
    assert [case["id"] for case in written["cases"]] == ["alone"]
    assert len(series.series_results_of(written["series"]) if series_run else ()) == series_run
    assert ("series" in written) == (series_run > 0)


def test_a_series_is_compared_with_its_baseline(call, campaign):
    path = campaign()
    assert call("run", path, "--baseline", "kept", "--accept").code == 0
    call("run", path, "--baseline", "kept", code=0, says="compared with the baseline kept: no difference")
    changed = call("run", path, "--baseline", "kept", "--set", "brake.command=90 %", "--format", "github")
    assert changed.code == 1
    assert "small differs from the baseline" in changed.out
    title = "::error file=scenarios/small.series.yaml,title=differs small::baseline: "
    assert any(line.startswith(title) for line in changed.out.splitlines())
    call("run", Path("scenarios/dry.yaml"), "--baseline", "kept", "--accept")
    both = results_of("kept")
    assert [each["id"] for each in both["series"]["series"]] == ["small"]
    assert call("run", path, "--baseline", "kept").code == 0


def test_recorded_stops_give_the_figures_of_the_simulated_ones(call, campaign):
    path = campaign()
    call("run", path, "--repeat", "1", "--record", "all", "--record-rate", "250")
    (simulated,) = series.series_results_of(results_of()["series"])
    folder = Path("reports/latest/recordings")
    for name in ("dry", "wet"):
        written = recording.read_parquet(folder / f"small.{name}.parquet")
        writer_of("csv")(written, Path(f"scenarios/{name}.csv"))
    path.write_text(
        SERIES.replace("dry.yaml, repeat: 1", "dry.yaml, recordings: [dry.csv]").replace(
            "wet: wet.yaml", "wet: {scenario: wet.yaml, recordings: [wet.csv], map: uictest}"
        )
    )
    call("evaluate", path, code=0)
    (recorded,) = series.series_results_of(results_of()["series"])
    assert [each.case.id for each in recorded.cases] == ["small.dry.dry", "small.wet.wet"]
    for name in ("stopping_distance_extension", "k_wet", "worst_slid_distance", "median_air_consumed"):
        one, other = (each.measures[name].estimate for each in (simulated, recorded))
        if other is not None:  # no record holds every measure
            assert other.value == pytest.approx(one.value, rel=5e-3), name
    assert recorded.measures["k_wet"].estimate is not None
    # A copy of a recording is no second stop.
    copy = Path(path.parent, "copy.csv")
    copy.write_bytes(Path(path.parent, "dry.csv").read_bytes())
    path.write_text(path.read_text().replace("[dry.csv]", "[dry.csv, copy.csv]"))
    assert "copy.csv is a copy of" in call("evaluate", path, code=4).err

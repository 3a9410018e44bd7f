"""Series files: one item per criterion."""

from pathlib import Path

import pytest

from .conftest import SCENARIO, junit_testcases, properties

CRITERIA = ["k-wet", "stopping-distance"]
PROFILE = """\
schema: uictest/criteria/1
name: two
sources: {{ours: {{mark: chosen, text: Limits for these tests}}}}
criteria:
  - {{id: k-wet, title: K_wet, source: ours, scope: series, layer: requirement, measure: k_wet,
     lower: {{value: {k_wet}, source: ours}}}}
  - {{id: stopping-distance, title: Extension, source: ours, scope: series, layer: requirement,
     measure: stopping_distance_extension, requirements: [BR-9], upper: {{value: 900 %, source: ours}}}}
"""


@pytest.fixture
def series(write):
    """Write a series of two short stops that its criteria are kept or missed by."""

    def to(expect, k_wet):
        write("scenarios/_dry.yaml", SCENARIO.format(name="dry", text="criteria: uictest-stop\n"))
        wet = "rail: {condition: wet, friction: 0.05}\ncriteria: uictest-stop\n"
        write("scenarios/_wet.yaml", SCENARIO.format(name="wet", text=wet))
        write("two.yaml", PROFILE.format(k_wet=k_wet))
        text = f"schema: uictest/series/1\nname: acceptance\ntags: [slow-one]\nexpect: {expect}\n"
        text += "test_case: TC-9\ndry: _dry.yaml\nwet: _wet.yaml\ncriteria: ../two.yaml\n"
        return write("scenarios/wsp.series.yaml", text)

    return to


def test_one_item_per_criterion(run, series):
    series("pass", "0.99")
    ids = [f"scenarios/wsp.series.yaml::acceptance::{name}" for name in CRITERIA]
    assert run("--collect-only", "-q", "-m", "slow-one", "--strict-markers").node_ids == ids
    done = run("--junitxml", "junit.xml")
    assert done.summary == "1 failed, 1 passed"
    assert run("--lf", "--collect-only", "-q").node_ids == ids[:1]
    assert any(line.startswith("k-wet (requirement) fail:") for line in done.lines)
    found = junit_testcases(Path("junit.xml"))
    told = {"status": "pass", "unit": "%", "requirements": "BR-9", "test_key": "TC-9"}
    assert properties(found["stopping-distance"]).items() >= told.items()
    assert float(properties(found["k-wet"])["margin"]) < 0.0


def test_the_series_of_a_matrix_are_told_apart_by_their_values(run, series):
    path = series("pass", "0.01")
    with path.open("a", encoding="utf-8") as file:
        file.write("matrix: {controller: [threshold, slip-band]}\n")
    at = "scenarios/wsp.series.yaml::acceptance"
    first, second = f"{at}::k-wet[controller=threshold]", f"{at}::k-wet[controller=slip-band]"
    assert run("--collect-only", "-q", f"{at}::k-wet").node_ids == [first, second]
    assert run(second).summary == "1 passed"


@pytest.mark.parametrize(("k_wet", "summary"), [("0.99", "1 passed"), ("0.01", "1 failed")])
def test_a_series_that_should_fail_is_one_item(run, series, k_wet, summary):
    series("fail", k_wet)
    done = run("-v")
    assert done.summary == summary
    assert any("wsp.series.yaml::acceptance::outcome" in line for line in done.lines)


def test_a_series_that_no_criterion_judges_is_a_failed_item(run, series):
    """It had no item at all, so that nothing was red."""
    path = series("pass", "0.99")
    path.write_text(path.read_text().replace("../two.yaml", "uic-541-05-appendix-b"))
    done = run()
    assert done.summary == "1 failed"
    assert "skipped. Expected: pass" in done.lines


def test_an_invalid_series_is_an_error_of_collection(run, write):
    write("scenarios/wsp.series.yaml", "schema: uictest/series/1\nname: x\ndry: none.yaml\nwet: none.yaml\n")
    done = run()
    assert done.code == 2
    assert any(line.startswith("scenarios/wsp.series.yaml:3:6: ") for line in done.lines)

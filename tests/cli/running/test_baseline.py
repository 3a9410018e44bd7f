import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

DIFFERENT = "tags: [fail]\nexpect: fail\n"
"""A case that meets its expectation, and comes out otherwise than the baseline has it."""


@pytest.fixture
def baseline(call, scenario, made_up):
    """The accepted results of the cases a and b."""
    scenario("a")
    scenario("b")
    assert call("run", "--baseline", "accepted", "--accept").code == 0
    return "accepted"


def junit_suite():
    (suite,) = ElementTree.parse("reports/latest/junit.xml").iter("testsuite")
    return suite


def accepted():
    return [case["id"] for case in json.loads(Path("accepted/results.json").read_text())["cases"]]


def test_a_run_like_its_baseline_exits_0_and_every_report_says_what_differs(call, scenario, baseline):
    call("run", "--baseline", baseline, code=0)
    scenario("a", DIFFERENT)
    answer = call("run", "--baseline", baseline, "--report", "html,md", "--junitxml", "own.xml", code=1)
    assert "differs a outcome=fail" in answer.out
    assert "outcome was pass, is fail" in answer.out
    assert "50 quantities compared with the baseline accepted: 1 out of tolerance" in answer.err
    headline = "2 cases: 1 pass, 1 different from the baseline"
    page = Path("reports/latest/index.html").read_text()
    assert f">{headline}</h1>" in page
    differences = page[page.index("Differences from the baseline") :]
    assert re.search(r">outcome</t[dh]>\s*<td[^>]*>pass</td>", differences)
    summary = Path("reports/latest/summary.md").read_text()
    assert f"## uictest: {headline}" in summary
    assert "| `a` | `outcome` | pass | fail |" in summary
    assert Path("own.xml").read_text() == Path("reports/latest/junit.xml").read_text()
    compared = json.loads(Path("reports/latest/results.json").read_text())["baseline"]
    assert (compared["folder"], compared["agrees"], compared["compared"]) == ("accepted", False, 50)
    assert len(compared["sha256"]) == 64
    (difference,) = compared["differences"]
    assert (difference["case"], difference["quantity"]) == ("a", "outcome")
    assert (difference["first"], difference["second"]) == ("pass", "fail")
    call("report", "reports/latest", "--format", "md", "-o", "again")
    assert Path("again/summary.md").read_text() == summary
    call("run", "--baseline", baseline, "--accept", code=0)
    call("run", "--baseline", baseline, code=0)


@pytest.mark.parametrize(
    ("text", "first_line"),
    [(DIFFERENT, ""), ("tags: [fail]\n", "fail. Expected: pass. Differs from the baseline\n")],
)
def test_a_case_that_differs_is_one_failure_in_junit_with_all_its_reasons(
    call, scenario, baseline, text, first_line
):
    scenario("a", text)
    call("run", "--baseline", baseline)
    suite = junit_suite()
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    (failure,) = suite.findall("testcase[@name='a']/failure")
    assert (failure.get("type") == "baseline") is (text == DIFFERENT)
    assert str(failure.text).startswith(first_line)
    assert "baseline: outcome was pass, is fail" in str(failure.text)


def test_github_shows_an_error_for_each_case_that_differs(call, scenario, baseline):
    scenario("a", DIFFERENT)
    Path("scenarios/b.yaml").unlink()
    shown = call("run", "--baseline", baseline, "--format", "github").out
    errors = [line.partition("::fail")[0] for line in shown.splitlines() if line.startswith("::error")]
    assert errors[0] == "::error file=scenarios/a.yaml,title=differs a"
    assert errors[1].startswith("::error file=scenarios/b.yaml,title=differs b::baseline: case was pass")


def test_a_terminal_table_marks_the_case_that_differs(call, scenario, baseline, monkeypatch):
    scenario("a", DIFFERENT)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr("uictest.cli.run_display.interactive", lambda stream: True)
    shown = call("run", "--baseline", baseline).out
    assert ["a", "differs", "-", "-"] in [line.split()[:4] for line in shown.splitlines()]
    assert "baseline: outcome was pass, is fail" in shown


@pytest.mark.parametrize("selection", [("-k", "a"), ("scenarios/a.yaml",), ("--lf",)])
def test_a_selection_compares_what_was_selected(call, baseline, scenario, selection):
    if selection == ("--lf",):
        scenario("a", "tags: [fail]\n")
        call("run")
        scenario("a")
    answer = call("run", *selection, "--baseline", baseline)
    assert (answer.code, junit_suite().get("tests")) == (0, "1")
    assert "not compared with the baseline: 1 case not selected (b)" in answer.err


@pytest.mark.parametrize("paths", [(), ("scenarios",), ("scenarios/b.yaml", "scenarios/a.yaml")])
def test_a_case_that_its_file_no_longer_has_is_a_failure_where_the_file_is_run(
    call, scenario, baseline, paths
):
    scenario("renamed", file="b.yaml")
    answer = call("run", *paths, "--baseline", baseline, code=1)
    names = {each.get("name"): each.find("failure") is not None for each in junit_suite().iter("testcase")}
    assert names == {"a": False, "renamed": True, "b": True}
    assert "1 different from the baseline; 1 case of the baseline missing" in answer.err


def test_where_a_run_stops_early_what_was_run_is_compared(call, scenario, baseline):
    scenario("a", "tags: [fail]\n")
    answer = call("run", "-x", "--baseline", baseline, code=1)
    assert "not compared with the baseline: 1 case not run (b)" in answer.err
    assert "baseline: outcome was pass, is fail" in answer.out


def test_accepting_a_selection_keeps_the_other_cases_and_everything_drops_those_that_are_gone(
    call, scenario, baseline
):
    scenario("b", DIFFERENT)
    says = "1 case that did not run are unchanged"
    call("run", "-k", "b", "--baseline", baseline, "--accept", says=says)
    assert accepted() == ["a", "b"]
    call("run", "--baseline", baseline, code=0)
    Path("scenarios/a.yaml").unlink()
    scenario("c")
    call("run", "--baseline", baseline, "--accept")
    assert accepted() == ["b", "c"]


def test_the_latest_run_as_a_baseline_is_the_one_before(call, scenario, baseline):
    scenario("a", DIFFERENT)
    call("run", "--baseline", "reports/latest", code=1)


def test_neither_a_difference_nor_accepting_it_hides_an_error_or_a_missed_case(call, scenario, baseline):
    scenario("a", "tags: [error]\n")
    call("run", "--baseline", baseline, code=3)
    assert junit_suite().get("errors") == "1"
    scenario("a", "tags: [fail]\n")
    call("run", "--baseline", baseline, "--accept", code=1)


@pytest.mark.parametrize("content", [None, "{}", "[]", "no JSON"])
def test_what_is_no_baseline_is_refused_before_anything_is_simulated(call, scenario, made_up, content):
    scenario("a")
    if content is not None:
        Path("other").mkdir()
        Path("other/results.json").write_text(content)
    answer = call("run", "--baseline", "other")
    assert (answer.code, made_up, Path("reports").exists()) == (4, [], False)
    first = "" if content is None else "remove other first: "
    assert f"; {first}--accept makes a run the baseline\n" in answer.err
    assert call("run", "--accept").code == 4
    assert call("run", "--baseline", "other", "--accept").code == (0 if content is None else 4)

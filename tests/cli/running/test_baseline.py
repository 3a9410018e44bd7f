import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from ..conftest import Call, Write

DIFFERENT = "tags: [fail]\nexpect: fail\n"
"""A case that meets its expectation, and comes out otherwise than the baseline has it."""


@pytest.fixture
def baseline(call: Call, scenario: Write, made_up: list[str]) -> str:
    """The accepted results of the cases a and b."""
    scenario("a")
    scenario("b")
    assert call("run", "--baseline", "accepted", "--accept").code == 0
    return "accepted"


def _suite() -> ElementTree.Element:
    (suite,) = ElementTree.parse("reports/latest/junit.xml").iter("testsuite")
    return suite


def _accepted() -> list[str]:
    return [case["id"] for case in json.loads(Path("accepted/results.json").read_text())["cases"]]


def test_a_run_like_its_baseline_exits_0_and_a_changed_one_1(
    call: Call, scenario: Write, baseline: str
) -> None:
    assert call("run", "--baseline", baseline).code == 0
    scenario("a", DIFFERENT)
    answer = call("run", "--baseline", baseline)
    assert answer.code == 1
    assert "differs a outcome=fail" in answer.out
    assert "outcome was pass, is fail" in answer.out
    assert "40 quantities compared with the baseline accepted: 1 out of tolerance" in answer.err
    assert call("run", "--baseline", baseline, "--accept").code == 0
    assert call("run", "--baseline", baseline).code == 0


def test_every_report_of_a_run_says_what_differs_from_the_baseline(
    call: Call, scenario: Write, baseline: str
) -> None:
    scenario("a", DIFFERENT)
    call("run", "--baseline", baseline, "--report", "html,md", "--junitxml", "own.xml")
    headline = "2 cases: 1 pass, 1 different from the baseline"
    page = Path("reports/latest/index.html").read_text()
    assert f"<h1>{headline}</h1>" in page
    assert "<td>outcome</td><td" in page[page.index("Differences from the baseline") :]
    summary = Path("reports/latest/summary.md").read_text()
    assert f"## uictest: {headline}" in summary
    assert "| `a` | `outcome` | pass | fail |" in summary
    assert Path("own.xml").read_text() == Path("reports/latest/junit.xml").read_text()
    call("report", "reports/latest", "--format", "md", "-o", "again")
    assert Path("again/summary.md").read_text() == summary


@pytest.mark.parametrize(
    ("text", "first_line"),
    [(DIFFERENT, ""), ("tags: [fail]\n", "fail. Expected: pass. Differs from the baseline\n")],
)
def test_a_case_that_differs_is_one_failure_in_junit_with_all_its_reasons(
    call: Call, scenario: Write, baseline: str, text: str, first_line: str
) -> None:
    scenario("a", text)
    call("run", "--baseline", baseline)
    suite = _suite()
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    (failure,) = suite.findall("testcase[@name='a']/failure")
    assert (failure.get("type") == "baseline") is (text == DIFFERENT)
    assert str(failure.text).startswith(first_line)
    assert "baseline: outcome was pass, is fail" in str(failure.text)


def test_github_shows_an_error_for_each_case_that_differs(call: Call, scenario: Write, baseline: str) -> None:
    scenario("a", DIFFERENT)
    Path("scenarios/b.yaml").unlink()
    shown = call("run", "--baseline", baseline, "--format", "github").out
    errors = [line.partition("::fail")[0] for line in shown.splitlines() if line.startswith("::error")]
    assert errors[0] == "::error file=scenarios/a.yaml,title=differs a"
    assert errors[1].startswith("::error file=scenarios/b.yaml,title=differs b::baseline: case was pass")


def test_the_results_hold_the_comparison_as_data(call: Call, scenario: Write, baseline: str) -> None:
    scenario("a", DIFFERENT)
    document = json.loads(call("run", "--baseline", baseline, "--format", "json").out)
    compared = document["baseline"]
    assert (compared["folder"], compared["agrees"], compared["compared"]) == ("accepted", False, 40)
    assert len(compared["sha256"]) == 64
    (difference,) = compared["differences"]
    assert (difference["case"], difference["quantity"]) == ("a", "outcome")
    assert (difference["first"], difference["second"]) == ("pass", "fail")


def test_a_terminal_table_marks_the_case_that_differs(
    call: Call, scenario: Write, baseline: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario("a", DIFFERENT)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr("uictest.cli.running.display.interactive", lambda stream: True)
    shown = call("run", "--baseline", baseline, "--color", "never").out
    assert ["a", "differs", "fail"] in [line.split()[:3] for line in shown.splitlines()]
    assert "baseline: outcome was pass, is fail" in shown


@pytest.mark.parametrize("selection", [("-k", "a"), ("scenarios/a.yaml",), ("--lf",)])
def test_a_selection_compares_what_was_selected(
    call: Call, baseline: str, scenario: Write, selection: tuple[str, ...]
) -> None:
    if selection == ("--lf",):
        scenario("a", "tags: [fail]\n")
        call("run")
        scenario("a")
    answer = call("run", *selection, "--baseline", baseline)
    assert (answer.code, _suite().get("tests")) == (0, "1")
    assert "not compared with the baseline: 1 case not selected (b)" in answer.err


@pytest.mark.parametrize("paths", [(), ("scenarios",), ("scenarios/b.yaml", "scenarios/a.yaml")])
def test_a_case_that_its_file_no_longer_has_is_a_failure_where_the_file_is_run(
    call: Call, scenario: Write, baseline: str, paths: tuple[str, ...]
) -> None:
    scenario("renamed", file="b.yaml")
    answer = call("run", *paths, "--baseline", baseline)
    assert answer.code == 1
    names = {each.get("name"): each.find("failure") is not None for each in _suite().iter("testcase")}
    assert names == {"a": False, "renamed": True, "b": True}
    assert "1 different from the baseline; 1 case of the baseline missing" in answer.err


def test_where_a_run_stops_early_what_was_run_is_compared(call: Call, scenario: Write, baseline: str) -> None:
    scenario("a", "tags: [fail]\n")
    answer = call("run", "-x", "--baseline", baseline)
    assert answer.code == 1
    assert "not compared with the baseline: 1 case not run (b)" in answer.err
    assert "baseline: outcome was pass, is fail" in answer.out


def test_accepting_a_selection_keeps_the_other_cases(call: Call, scenario: Write, baseline: str) -> None:
    scenario("b", DIFFERENT)
    answer = call("run", "-k", "b", "--baseline", baseline, "--accept")
    assert "1 case that did not run are unchanged" in answer.err
    assert _accepted() == ["a", "b"]
    assert call("run", "--baseline", baseline).code == 0


def test_accepting_everything_drops_the_cases_that_are_gone(
    call: Call, scenario: Write, baseline: str
) -> None:
    Path("scenarios/a.yaml").unlink()
    scenario("c")
    call("run", "--baseline", baseline, "--accept")
    assert _accepted() == ["b", "c"]


def test_the_latest_run_as_a_baseline_is_the_one_before(call: Call, scenario: Write, baseline: str) -> None:
    scenario("a", DIFFERENT)
    assert call("run", "--baseline", "reports/latest").code == 1


def test_an_error_outweighs_a_difference(call: Call, scenario: Write, baseline: str) -> None:
    scenario("a", "tags: [error]\n")
    assert call("run", "--baseline", baseline).code == 3
    assert _suite().get("errors") == "1"


def test_accepting_does_not_make_a_missed_case_met(call: Call, scenario: Write, baseline: str) -> None:
    scenario("a", "tags: [fail]\n")
    assert call("run", "--baseline", baseline, "--accept").code == 1


@pytest.mark.parametrize("content", [None, "{}", "[]", "no JSON"])
def test_what_is_no_baseline_is_refused_before_anything_is_simulated(
    call: Call, scenario: Write, made_up: list[str], content: str | None
) -> None:
    scenario("a")
    if content is not None:
        Path("other").mkdir()
        Path("other/results.json").write_text(content)
    answer = call("run", "--baseline", "other")
    assert (answer.code, made_up, Path("reports").exists()) == (4, [], False)
    assert "--accept makes the results of a run the baseline" in answer.err
    assert call("run", "--accept").code == 4

"""Earlier runs: `--baseline` compares, `--lf` selects what failed last, `--keep` removes the oldest."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.core.recording.formats import writer_of
from uictest.runs import history

from .conftest import STATED, manifest_of, results_of, rolling_train, verdicts_in

pytestmark = pytest.mark.usefixtures("made_up")
DIFFERENT = "tags: [fail]\nexpect: fail\n"
"""A case that meets its expectation, and comes out otherwise than the baseline has it."""


@pytest.fixture
def baseline(call, scenario, made_once):
    """The accepted results of the cases a and b."""

    def make():
        scenario("a")
        scenario("b")
        call("run", "--baseline", "accepted", "--accept", code=0)

    made_once(make)
    return "accepted"


def junit_suite():
    (suite,) = ElementTree.parse("reports/latest/junit.xml").iter("testsuite")
    return suite


def accepted():
    return [case["id"] for case in results_of("accepted")["cases"]]


def test_a_run_like_its_baseline_exits_0_and_every_report_says_what_differs(call, scenario, baseline):
    call("run", "--baseline", baseline, code=0)
    scenario("a", DIFFERENT)
    answer = call("run", "--baseline", baseline, "--report", "html,md", code=1)
    assert verdicts_in(answer.out) == {"a": "differs", "b": "pass"}
    assert "a differs from the baseline\n  baseline: outcome was pass, is fail\n" in answer.out
    assert "50 quantities compared with the baseline accepted: 1 out of tolerance" in answer.err
    assert (
        "uictest: 1 of 2 cases differs from the baseline: a" in Path("reports/latest/summary.md").read_text()
    )
    for name in ("index.html", "summary.md"):
        text = Path("reports/latest", name).read_text()
        assert "1 out of tolerance" in text, name
    compared = results_of()["baseline"]
    assert (compared["folder"], compared["agrees"], compared["compared"]) == ("accepted", False, 50)
    assert len(compared["sha256"]) == 64
    (difference,) = compared["differences"]
    assert (difference["case"], difference["quantity"]) == ("a", "outcome")
    assert (difference["first"], difference["second"]) == ("pass", "fail")
    summary = Path("reports/latest/summary.md").read_text()
    assert "uictest: 1 of 2 cases differs from the baseline: a" in summary
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


def test_github_and_a_terminal_mark_the_cases_that_differ(call, scenario, baseline, monkeypatch):
    scenario("a", DIFFERENT)
    Path("scenarios/b.yaml").unlink()
    shown = call("run", "--baseline", baseline, "--format", "github").out
    errors = [line.partition("::fail")[0] for line in shown.splitlines() if line.startswith("::error")]
    assert errors[0] == "::error file=scenarios/a.yaml,title=differs a"
    assert errors[1].startswith("::error file=scenarios/b.yaml,title=differs b::baseline: case was pass")
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
    says = "not compared with the baseline: 1 case not selected (b)"
    call("run", *selection, "--baseline", baseline, code=0, says=says)
    assert junit_suite().get("tests") == "1"


@pytest.mark.parametrize("paths", [(), ("scenarios",), ("scenarios/b.yaml", "scenarios/a.yaml")])
def test_a_case_that_its_file_no_longer_has_is_a_failure_where_the_file_is_run(
    call, scenario, baseline, paths
):
    scenario("renamed", file="b.yaml")
    shown = call("run", *paths, "--baseline", baseline, code=1).out
    assert "b is in the baseline and missing here" in shown
    assert "renamed differs from the baseline" in shown
    names = {each.get("name"): each.find("failure") is not None for each in junit_suite().iter("testcase")}
    assert names == {"a": False, "renamed": True, "b": True}


def test_where_a_run_stops_early_what_was_run_is_compared(call, scenario, baseline):
    scenario("a", "tags: [fail]\n")
    says = "not compared with the baseline: 1 case not run (b)"
    answer = call("run", "-x", "--baseline", baseline, code=1, says=says)
    assert "a misses requirements" in answer.out


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


def test_the_latest_run_is_compared_as_the_one_before_and_no_difference_hides_an_error_or_a_missed_case(
    call, scenario, baseline
):
    scenario("a", DIFFERENT)
    call("run", "--baseline", "reports/latest", code=1)
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
    first = "" if content is None else "remove other first: "
    call("run", "--baseline", "other", code=4, says=f"; {first}--accept makes a run the baseline\n")
    assert (made_up, Path("reports").exists()) == ([], False)
    call("run", "--baseline", "other", "--accept", code=0 if content is None else 4)


@pytest.fixture(params=["evaluate", "log"])
def evaluate(call, request):
    """Judge a recording, or the stops in a log (here none), whose results lie beside those of the runs."""

    def run():
        train = rolling_train()
        channels = {**train.channels, "brake_command": np.zeros(len(train))}
        units = {**train.units, "brake_command": "1"}
        writer_of("csv")(Recording(channels, units, train.metadata), Path("recorded.csv"))
        call(request.param, "recorded.csv", *STATED, code=0 if request.param == "evaluate" else 5)
        command = manifest_of()["command"]
        assert command[1] == request.param

    return run


def test_what_failed_last_is_selected_whatever_was_evaluated_since(call, scenario, made_up, evaluate):
    scenario("a")
    scenario("b", "tags: [fail]\n")
    call("run", "-q")
    evaluate()
    made_up.clear()
    call("run", "--lf", code=1)
    assert made_up == ["b"]
    scenario("b")
    call("run", "--lf", code=0)
    made_up.clear()
    call("run", "--lf", says="all are selected")
    assert sorted(made_up) == ["a", "b"]


def test_without_an_earlier_run_all_are_selected_and_evaluations_are_none(call, scenario, made_up, evaluate):
    scenario("a")
    evaluate()
    call("run", "--lf", code=0, says="no earlier run")
    assert made_up == ["a"]


@pytest.mark.parametrize("content", ["", "{", "[]", '{"schema": "other"}', '{"schema": "uictest/result/1"}'])
def test_results_that_cannot_be_read_exit_4(call, scenario, content):
    scenario("a")
    call("run")
    Path("reports/latest/results.json").write_text(content)
    call("run", "--lf", code=4, says="results.json")


def test_of_several_runs_the_newest_counts(call, scenario, made_up, evaluate):
    """Within a second, too, and whatever the hash in their names."""
    for failing in ("a", "b", "c"):
        for name in ("a", "b", "c"):
            scenario(name, "tags: [fail]\n" if name == failing else "")
        call("run")
    evaluate()
    made_up.clear()
    call("run", "--lf")
    assert made_up == ["c"]


def run_folders():
    folders = (path for path in Path("reports").iterdir() if path.is_dir() and not path.is_symlink())
    return {path.name for path in folders}


def test_older_runs_are_removed_and_named(call, scenario):
    scenario("stop")
    for _ in range(3):
        call("run", "-q")
    before = run_folders()
    assert len(before) == 3  # nothing is removed without the option
    answer = call("run", "-q", "--keep", "2", code=0)
    gone = before - run_folders()
    assert (len(run_folders()), len(gone)) == (2, 2)
    for name in gone:
        assert f"uictest: --keep 2: removed {name}, older than the newest 2\n" in answer.err
        assert f'"./{name}/index.html"' not in Path("reports", "index.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("outcome", "code", "left", "said"), [("fail", 1, 1, "removed"), ("error", 3, 2, "nothing is removed")]
)
def test_a_case_that_is_not_as_expected_is_a_result_too_and_an_error_is_none(
    call, scenario, outcome, code, left, said
):
    scenario("stop", f"tags: [{outcome}]")
    call("run")
    call("run", "--keep", "1", code=code, says=said)
    assert len(run_folders()) == left


@pytest.mark.parametrize("named", ["reports/{first}", "reports/latest"])
def test_the_baseline_stays_under_whatever_name_it_was_given(call, scenario, named):
    scenario("stop")
    call("run")
    [first] = run_folders()
    call("run", "--baseline", named.format(first=first), "--keep", "1", says=f"{first} stays: ")
    assert first in run_folders()
    assert f"reports/{first}" in Path("reports", "latest", "results.json").read_text("utf-8")


def accepted_run():
    [run] = [run for run in history.list_runs(Path("reports")).runs if run.name == "baseline"]
    return run


def test_accepted_results_are_listed_with_their_verdict_and_stay(call, scenario):
    scenario("dry", "tags: [pass]\n")
    wet = scenario("wet", "tags: [fail]\n")
    call("run", "--baseline", "reports/baseline", "--accept", code=1)
    assert accepted_run().counts == {"pass": 1, "fail": 1}
    scenario("dry", "tags: [fail]\n")
    call("run", "scenarios/dry.yaml", "--baseline", "reports/baseline", "--accept", code=1)
    assert (accepted_run().subject, accepted_run().counts) == ("dry, wet", {"fail": 2})
    wet.unlink()
    call("run", code=1)
    call("run", "--keep", "1", says="baseline stays: ")
    assert Path("reports", "baseline", "results.json").is_file()

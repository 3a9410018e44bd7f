"""JUnit of series: one testcase per criterion, in the form that Jenkins' xUnit plugin checks."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree

from uictest.judging import series
from uictest.report import junit_text, run_suites

from ..builders import make_result
from .made_up import MISSED, make_series


def suites(*results: series.SeriesResult) -> list[ElementTree.Element]:
    return list(ElementTree.fromstring(junit_text(run_suites([], series=results))))


def test_every_criterion_is_a_testcase() -> None:
    (suite,) = suites(make_series())
    (testcase,) = suite
    assert suite.get("name") == "uictest series: acceptance"
    assert (testcase.get("classname"), testcase.get("name")) == (
        "tests.acceptance.series",
        "acceptance: k-wet",
    )
    assert [child.tag for child in testcase] == ["system-out"]


def test_a_missed_criterion_is_a_failure_that_says_everything() -> None:
    (suite,) = suites(MISSED)
    assert suite.get("failures") == "1"
    text = suite.findtext("testcase/failure") or ""
    assert "k-wet (requirement) fail: 0.86957 from 120 km/h, lower limit 0.9, margin -0.03" in text
    assert "dry 1 of 1, wet 5 of 6" in text
    assert "1 stop invalid, not counted" in text


def test_an_expected_failure_is_none() -> None:
    (suite,) = suites(replace(MISSED, expect="fail"))
    assert suite.get("failures") == "0"


def test_an_unexpected_pass_and_an_error_have_a_testcase_of_their_own() -> None:
    (unexpected,) = suites(make_series(expect="fail"))
    assert [case.get("name") for case in unexpected] == ["acceptance: k-wet", "acceptance: outcome"]
    assert unexpected.get("failures") == "1"
    (error,) = suites(make_series(outcome="error", reason="1 of 7 stops failed to run; it broke"))
    assert (error.get("errors"), error.get("failures")) == ("1", "0")
    assert "it broke" in (error.findtext("testcase/error") or "")


def test_an_inconclusive_criterion_is_a_failure() -> None:
    result = make_series()
    (each,) = result.criteria
    open_verdict = replace(
        each.verdict, status="inconclusive", value=None, margin=None, reason="too few stops"
    )
    criteria = (series.SeriesVerdict(open_verdict),)
    (suite,) = suites(replace(result, criteria=criteria, outcome="inconclusive", reason="too few stops"))
    assert suite.get("failures") == "1"


def test_series_stand_behind_the_cases() -> None:
    root = ElementTree.fromstring(junit_text(run_suites([make_result()], series=[make_series()])))
    assert [suite.get("name") for suite in root] == ["uictest", "uictest series: acceptance"]

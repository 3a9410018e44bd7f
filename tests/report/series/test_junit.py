"""JUnit of series: one testcase per criterion, in the form that Jenkins' xUnit plugin checks."""

from dataclasses import replace
from xml.etree import ElementTree

from uictest.judging import series
from uictest.plans.scenario import expectation_of
from uictest.report import junit_text, run_suites

from ..builders import make_result
from .made_up import MISSED, make_series


def suites(*results):
    return list(ElementTree.fromstring(junit_text(run_suites([], series=results))))


def test_every_criterion_is_a_testcase_behind_the_cases():
    text = junit_text(run_suites([make_result()], series=[make_series()]))
    of_cases, suite = ElementTree.fromstring(text)
    (testcase,) = suite
    assert [each.get("name") for each in (of_cases, suite)] == ["uictest", "uictest series: acceptance"]
    named = (testcase.get("classname"), testcase.get("name"))
    assert named == ("tests.acceptance.series", "acceptance: k-wet")
    assert [child.tag for child in testcase] == ["system-out"]


def test_a_missed_criterion_is_a_failure_that_says_everything_unless_it_is_expected():
    (expected,) = suites(replace(MISSED, expect=expectation_of("fail")))
    (suite,) = suites(MISSED)
    assert (suite.get("failures"), expected.get("failures")) == ("1", "0")
    text = suite.findtext("testcase/failure") or ""
    assert "k-wet (requirement) fail: 0.86957 from 120 km/h, lower limit 0.9, margin -0.03" in text
    assert "dry 2 of 2, wet 5 of 6" in text
    assert "1 stop invalid, not counted" in text


def test_an_unexpected_pass_and_an_error_have_a_testcase_of_their_own():
    (unexpected,) = suites(make_series(expect="fail"))
    assert [case.get("name") for case in unexpected] == ["acceptance: k-wet", "acceptance: outcome"]
    assert unexpected.get("failures") == "1"
    (error,) = suites(make_series(outcome="error", reason="1 of 7 stops failed to run; it broke"))
    assert (error.get("errors"), error.get("failures")) == ("1", "0")
    assert "it broke" in (error.findtext("testcase/error") or "")


def test_an_inconclusive_criterion_is_a_failure():
    result = make_series()
    (each,) = result.criteria
    open_verdict = replace(
        each.verdict, status="inconclusive", value=None, margin=None, reason="too few stops"
    )
    criteria = (series.SeriesVerdict(open_verdict),)
    (suite,) = suites(replace(result, criteria=criteria, outcome="inconclusive", reason="too few stops"))
    assert suite.get("failures") == "1"

from __future__ import annotations

from collections.abc import Callable
from xml.etree import ElementTree

import pytest

from uictest.judging.evaluation import CaseResult, Verdict
from uictest.report import junit_text, run_suites

MakeResult = Callable[..., CaseResult]
MakeVerdict = Callable[..., Verdict]


def _suite(results: list[CaseResult]) -> ElementTree.Element:
    suite = ElementTree.fromstring(junit_text(run_suites(results))).find("testsuite")
    assert suite is not None
    return suite


def test_one_testcase_per_case_named_after_file_and_id(make_result: MakeResult) -> None:
    (testcase,) = _suite([make_result()])
    assert testcase.attrib == {
        "classname": "scenarios.dry.120",
        "name": "dry-120[command=90]",
        "time": "0.250",
    }
    assert len(testcase) == 0


def test_a_missed_case_is_a_failure_whose_text_says_everything(
    make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    broken = make_verdict(status="fail", value=500.0, margin=-10.0, reason="500 m misses 440 .. 490 m")
    suite = _suite([make_result(outcome="invalid", criteria=(broken,), reason="braking-distance: ...")])
    text = suite.findtext("testcase/failure")
    assert text is not None
    assert "invalid: braking-distance. Expected: pass" in text
    assert "braking-distance (validity) fail: 500 m misses 440 .. 490 m" in text


def test_an_expected_failure_is_no_failure(make_result: MakeResult) -> None:
    suite = _suite([make_result(expect="fail", outcome="fail"), make_result(expect="fail", outcome="pass")])
    assert [len(testcase) for testcase in suite] == [0, 1]


@pytest.mark.parametrize(
    ("expect", "tag", "text"),
    [("skipped", "skipped", "skipped (as expected)"), ("pass", "failure", "skipped. Expected: pass")],
)
def test_a_case_that_nothing_judged_is_skipped_only_if_expected(
    make_result: MakeResult, expect: str, tag: str, text: str
) -> None:
    ((child,),) = _suite([make_result(expect=expect, outcome="skipped")]).findall("testcase")
    assert child.tag == tag
    assert text in (child.text or "")


def test_counts_agree_with_the_elements(make_result: MakeResult) -> None:
    outcomes = ("pass", "fail", "invalid", "inconclusive", "error", "skipped")
    suite = _suite([make_result(outcome=outcome) for outcome in outcomes])
    counts = {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": "6", "failures": "4", "errors": "1", "skipped": "0"}
    assert suite.get("time") == "1.500"


def test_hostile_names_and_reasons_leave_a_document_that_parses(
    make_result: MakeResult, hostile: str
) -> None:
    result = make_result(
        id=hostile, scenario=f"a/{hostile}.yaml", outcome="error", reason=hostile, criteria=()
    )
    (testcase,) = _suite([result])
    assert "\x1b" not in testcase.attrib["name"]
    assert "<b>&" in testcase.attrib["name"]

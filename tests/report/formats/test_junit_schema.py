"""JUnit as others read it: the rules of the schema that Jenkins' xUnit plugin checks, and junitparser."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from xml.etree import ElementTree

import pytest

from uictest.evaluation import CaseResult
from uictest.report.formats.junit import junit_xml

MakeResult = Callable[..., CaseResult]

_REASON = {"type", "message"}
ATTRIBUTES = {
    "testsuites": {"name", "time", "tests", "failures", "errors"},
    "testsuite": {"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname"}
    | {"id", "package", "file", "log", "url", "version"},
    "testcase": {"name", "time", "classname", "group"},
    "failure": _REASON,
    "error": _REASON,
    "skipped": _REASON,
}
"""What junit-10.xsd of the plugin (its release of November 2025) lets an element have."""

REQUIRED = {"testsuite": {"name", "tests", "failures", "errors"}, "testcase": {"name"}}
CHILDREN = {
    "testsuites": {"testsuite"},
    "testsuite": {"testsuite", "properties", "testcase", "system-out", "system-err"},
    "testcase": {"skipped", "error", "failure", "system-out", "system-err"},
}
TIME = re.compile(r"(([0-9]{0,3},)*[0-9]{3}|[0-9]{0,3})*(\.[0-9]*)?")


def _check(element: ElementTree.Element) -> None:
    assert set(element.attrib) <= ATTRIBUTES[element.tag]
    assert set(element.attrib) >= REQUIRED.get(element.tag, set())
    assert TIME.fullmatch(element.get("time", ""))
    assert {child.tag for child in element} <= CHILDREN.get(element.tag, set())
    for child in element:
        _check(child)


@pytest.fixture
def results(make_result: MakeResult, hostile: str) -> list[CaseResult]:
    outcomes = ("pass", "fail", "invalid", "error", "skipped")
    ordinary = [make_result(id=outcome, outcome=outcome, duration=1234.5) for outcome in outcomes]
    bad = {"outcome": "error", "criteria": (), "reason": hostile, "scenario": f"a/{hostile}.yaml"}
    return [*ordinary, make_result(id=hostile, **bad), make_result(id="x" * 5000, **bad)]


def test_every_element_is_as_jenkins_wants_it(results: list[CaseResult]) -> None:
    _check(ElementTree.fromstring(junit_xml(results)))


def test_junitparser_reads_back_what_was_written(results: list[CaseResult]) -> None:
    junitparser = pytest.importorskip("junitparser")
    (suite,) = junitparser.JUnitXml.fromfile(io.StringIO(junit_xml(results).partition("\n")[2]))
    assert (suite.tests, suite.failures, suite.errors, suite.skipped) == (7, 2, 3, 1)
    found = {case.name: case for case in suite}
    assert found["pass"].is_passed
    assert found["fail"].is_failure
    assert found["skipped"].is_skipped
    assert found["error"].is_error
    assert "expected pass, got invalid" in found["invalid"].result[0].text
    assert any("<b>&" in name for name in found)

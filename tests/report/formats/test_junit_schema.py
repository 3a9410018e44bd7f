"""JUnit as others read it: the rules of the schema that Jenkins' xUnit plugin checks, and junitparser."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from xml.etree import ElementTree

import pytest

from uictest.evaluation import CaseResult, EffectivePart, Parameter
from uictest.report.formats.junit import junit_xml

MakeResult = Callable[..., CaseResult]

_REASON = {"type", "message"}
ATTRIBUTES = {
    "testsuites": {"name", "time", "tests", "failures", "errors"},
    "testsuite": {"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname"}
    | {"id", "package", "file", "log", "url", "version"},
    "testcase": {"name", "time", "classname", "group"},
    "properties": set(),
    "property": {"name", "value"},
    "failure": _REASON,
    "error": _REASON,
    "skipped": _REASON,
}
"""What junit-10.xsd of the plugin (its release of November 2025) lets an element have."""

REQUIRED = {
    "testsuite": {"name", "tests", "failures", "errors"},
    "testcase": {"name"},
    "property": {"name", "value"},
}
CHILDREN = {
    "testsuites": {"testsuite"},
    "testsuite": {"testsuite", "properties", "testcase", "system-out", "system-err"},
    "testcase": {"skipped", "error", "failure", "system-out", "system-err"},
    "properties": {"property"},
}
TIME = re.compile(r"(([0-9]{0,3},)*[0-9]{3}|[0-9]{0,3})*(\.[0-9]*)?")


def _check(element: ElementTree.Element) -> None:
    assert set(element.attrib) <= ATTRIBUTES[element.tag]
    assert set(element.attrib) >= REQUIRED.get(element.tag, set())
    assert TIME.fullmatch(element.get("time", ""))
    assert {child.tag for child in element} <= CHILDREN.get(element.tag, set())
    for child in element:
        _check(child)


def _controller(name: str, **facts: str) -> EffectivePart:
    parameters = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    return EffectivePart("controller", "controller", name, None, tuple(parameters))


@pytest.fixture
def results(make_result: MakeResult, hostile: str) -> list[CaseResult]:
    outcomes = ("pass", "fail", "invalid", "error", "skipped")
    ordinary = [make_result(id=outcome, outcome=outcome, duration=1234.5) for outcome in outcomes]
    bad = {"outcome": "error", "criteria": (), "reason": hostile, "scenario": f"a/{hostile}.yaml"}
    foreign = {"controller": _controller(hostile, library=hostile, version=hostile, sha256="0" * 64)}
    return [
        *ordinary,
        make_result(id=hostile, **bad, parts=foreign),
        make_result(id="x" * 5000, **bad),
    ]


def test_every_element_is_as_jenkins_wants_it(results: list[CaseResult]) -> None:
    _check(ElementTree.fromstring(junit_xml(results)))


def test_cases_of_each_controller_from_outside_have_a_suite_that_says_which_it_is(
    make_result: MakeResult,
) -> None:
    one = _controller("Wsp", python="wsp.py", sha256="1" * 64, version="2.1")
    other = _controller("tcp://rig:5025", connect="tcp://rig:5025")
    own = _controller("threshold", algorithm="threshold")
    parts = {"a": one, "b": own, "c": other, "d": one}
    text = junit_xml([make_result(id=name, parts={"controller": part}) for name, part in parts.items()])
    suites = {
        suite.get("name"): (
            [case.get("name") for case in suite.iter("testcase")],
            {each.get("name"): each.get("value") for each in suite.iter("property")},
        )
        for suite in ElementTree.fromstring(text)
    }
    assert suites == {
        "uictest: Wsp": (
            ["a", "d"],
            {
                "controller": "Wsp",
                "controller.kind": "python",
                "controller.source": "wsp.py",
                "controller.version": "2.1",
                "controller.sha256": "1" * 64,
            },
        ),
        "uictest": (["b"], {}),
        "uictest: tcp://rig:5025": (
            ["c"],
            {
                "controller": "tcp://rig:5025",
                "controller.kind": "connect",
                "controller.source": "tcp://rig:5025",
            },
        ),
    }


def test_junitparser_reads_back_what_was_written(results: list[CaseResult]) -> None:
    junitparser = pytest.importorskip("junitparser")
    suites = list(junitparser.JUnitXml.fromfile(io.StringIO(junit_xml(results).partition("\n")[2])))
    counts = [(suite.tests, suite.failures, suite.errors, suite.skipped) for suite in suites]
    assert counts == [(6, 2, 2, 1), (1, 0, 1, 0)]
    found = {case.name: case for suite in suites for case in suite}
    assert found["pass"].is_passed
    assert found["fail"].is_failure
    assert found["skipped"].is_skipped
    assert found["error"].is_error
    assert "expected pass, got invalid" in found["invalid"].result[0].text
    assert any("<b>&" in name for name in found)

"""JUnit as others read it: the rules of the schema that Jenkins' xUnit plugin checks, and junitparser."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping
from xml.etree import ElementTree

import pytest

from uictest.judging.evaluation import CaseResult, EffectivePart, Parameter, Verdict
from uictest.report import RunContent, junit_text, run_suites
from uictest.report.formats.junit import FORMAT

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


WITH_TEST_PROPERTIES = CHILDREN | {"testcase": CHILDREN["testcase"] | {"properties"}}
"""The one thing in which `junit-properties.xml` goes beyond that schema."""


def _check(element: ElementTree.Element, children: Mapping[str, set[str]] = CHILDREN) -> None:
    assert set(element.attrib) <= ATTRIBUTES[element.tag]
    assert set(element.attrib) >= REQUIRED.get(element.tag, set())
    assert TIME.fullmatch(element.get("time", ""))
    assert {child.tag for child in element} <= children.get(element.tag, set())
    for child in element:
        _check(child, children)


def _controller(name: str, **facts: str) -> EffectivePart:
    parameters = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    return EffectivePart("controller", "controller", name, None, tuple(parameters))


@pytest.fixture
def results(make_result: MakeResult, hostile: str) -> list[CaseResult]:
    outcomes = ("pass", "fail", "invalid", "error", "skipped")
    expected = {"skipped": "skipped"}
    ordinary = [
        make_result(id=outcome, outcome=outcome, expect=expected.get(outcome, "pass"), duration=1234.5)
        for outcome in outcomes
    ]
    bad = {"outcome": "error", "criteria": (), "reason": hostile, "scenario": f"a/{hostile}.yaml"}
    foreign = {"controller": _controller(hostile, library=hostile, version=hostile, sha256="0" * 64)}
    named = make_result(id="named", test_case="TC-7", requirements=("BR-1",), outcome="fail")
    return [
        *ordinary,
        named,
        make_result(id=hostile, **bad, parts=foreign),
        make_result(id="x" * 5000, **bad),
    ]


def test_every_element_is_as_jenkins_wants_it(results: list[CaseResult]) -> None:
    _check(ElementTree.fromstring(junit_text(run_suites(results))))


def test_the_file_with_test_properties_is_the_other_one_with_nothing_but_these(
    results: list[CaseResult],
) -> None:
    root = ElementTree.fromstring(junit_text(run_suites(results, with_properties=True)))
    _check(root, WITH_TEST_PROPERTIES)
    for testcase in root.iter("testcase"):
        for properties in testcase.findall("properties"):
            testcase.remove(properties)
    ElementTree.indent(root)
    other = ElementTree.fromstring(junit_text(run_suites(results)))
    ElementTree.indent(other)
    assert ElementTree.tostring(root) == ElementTree.tostring(other)


def _test_properties(text: str) -> dict[str, list[tuple[str, str]]]:
    """What importers see: the `property` elements right below `testcase/properties`."""
    return {
        testcase.attrib["name"]: [
            (each.attrib["name"], each.attrib["value"]) for each in testcase.findall("properties/property")
        ]
        for testcase in ElementTree.fromstring(text).iter("testcase")
    }


def test_polarion_and_xray_find_the_test_case_and_xray_the_requirements(
    make_result: MakeResult, make_verdict: Callable[..., Verdict]
) -> None:
    """Names: Polarion's xUnit importer; Xray, "Import Execution Results", a comma list of requirements."""
    criteria = (make_verdict(requirements=("BR-2", "BR-1")),)
    results = [
        make_result(id="both", outcome="fail", test_case="WSP-7", requirements=("BR-1",), criteria=criteria),
        make_result(id="requirements", requirements=("BR-10", "BR-9")),
        make_result(id="test-case", test_case="WSP-8"),
        make_result(id="neither"),
    ]
    assert _test_properties(junit_text(run_suites(results, with_properties=True))) == {
        "both": [("polarion-testcase-id", "WSP-7"), ("test_key", "WSP-7"), ("requirements", "BR-1,BR-2")],
        "requirements": [("requirements", "BR-10,BR-9")],
        "test-case": [("polarion-testcase-id", "WSP-8"), ("test_key", "WSP-8")],
        "neither": [],
    }
    first = ElementTree.fromstring(junit_text(run_suites(results, with_properties=True))).findall(
        "testsuite/testcase"
    )[0]
    assert first[0].tag == "properties"  # where pytest writes them
    assert not any(_test_properties(junit_text(run_suites(results))).values())
    suite = ElementTree.fromstring(junit_text(run_suites(results))).find("testsuite/properties/property")
    assert suite is not None
    assert suite.attrib == {"name": "requirements", "value": "BR-1,BR-2,BR-9,BR-10"}


def test_junitparser_reads_the_test_properties(make_result: MakeResult) -> None:
    junitparser = pytest.importorskip("junitparser")
    text = junit_text(
        run_suites([make_result(test_case="WSP-7", requirements=("BR-1",))], with_properties=True)
    )
    ((testcase,),) = junitparser.JUnitXml.fromfile(io.StringIO(text.partition("\n")[2]))
    found = {
        each.name: each.value
        for properties in testcase.iterchildren(junitparser.Properties)
        for each in properties
    }
    assert found == {"polarion-testcase-id": "WSP-7", "test_key": "WSP-7", "requirements": "BR-1"}


def test_the_second_file_is_there_only_where_an_importer_finds_something_in_it(
    make_result: MakeResult, make_content: Callable[..., RunContent]
) -> None:
    def files(**changes: object) -> set[str]:
        return set(FORMAT.files(make_content(make_result(**changes))))

    assert files() == {"junit.xml"}
    assert files(test_case="TC-1") == files(requirements=("BR-1",)) == {"junit.xml", "junit-properties.xml"}


def test_cases_of_each_controller_from_outside_have_a_suite_that_says_which_it_is(
    make_result: MakeResult,
) -> None:
    one = _controller("Wsp", python="wsp.py", sha256="1" * 64, version="2.1")
    other = _controller("tcp://rig:5025", connect="tcp://rig:5025")
    own = _controller("threshold", algorithm="threshold")
    parts = {"a": one, "b": own, "c": other, "d": one}
    text = junit_text(
        run_suites([make_result(id=name, parts={"controller": part}) for name, part in parts.items()])
    )
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
        "uictest": (["b"], {"controller": "threshold"}),
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
    suites = list(
        junitparser.JUnitXml.fromfile(io.StringIO(junit_text(run_suites(results)).partition("\n")[2]))
    )
    counts = [(suite.tests, suite.failures, suite.errors, suite.skipped) for suite in suites]
    assert counts == [(7, 3, 2, 1), (1, 0, 1, 0)]
    found = {case.name: case for suite in suites for case in suite}
    assert found["pass"].is_passed
    assert found["fail"].is_failure
    assert found["skipped"].is_skipped
    assert found["error"].is_error
    assert "invalid. Expected: pass" in found["invalid"].result[0].text
    assert any("<b>&" in name for name in found)

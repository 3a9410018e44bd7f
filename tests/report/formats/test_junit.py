"""JUnit of a run, as servers, importers and junitparser read it."""

from __future__ import annotations

import io
from xml.etree import ElementTree

import pytest

from uictest.judging.evaluation import CaseResult, EffectivePart, Parameter
from uictest.report import junit_text, run_suites
from uictest.report.formats.junit import FORMAT

from ..builders import HOSTILE, make_content, make_result, make_verdict
from ..junit_schema import check


def _suite(results: list[CaseResult]) -> ElementTree.Element:
    suite = ElementTree.fromstring(junit_text(run_suites(results))).find("testsuite")
    assert suite is not None
    return suite


def test_one_testcase_per_case_named_after_file_and_id() -> None:
    (testcase,) = _suite([make_result()])
    assert testcase.attrib == {
        "classname": "scenarios.dry.120",
        "name": "dry-120[command=90]",
        "time": "0.250",
    }
    assert len(testcase) == 0


def test_a_missed_case_is_a_failure_whose_text_says_everything() -> None:
    broken = make_verdict(status="fail", value=500.0, margin=-10.0, reason="500 m misses 440 .. 490 m")
    suite = _suite([make_result(outcome="invalid", criteria=(broken,), reason="braking-distance: ...")])
    text = suite.findtext("testcase/failure")
    assert text is not None
    assert "invalid: braking-distance. Expected: pass" in text
    assert "braking-distance (validity) fail: 500 m misses 440 .. 490 m" in text


def test_an_expected_failure_is_no_failure() -> None:
    suite = _suite([make_result(expect="fail", outcome="fail"), make_result(expect="fail", outcome="pass")])
    assert [len(testcase) for testcase in suite] == [0, 1]


@pytest.mark.parametrize(
    ("expect", "tag", "text"),
    [("skipped", "skipped", "skipped (as expected)"), ("pass", "failure", "skipped. Expected: pass")],
)
def test_a_case_that_nothing_judged_is_skipped_only_if_expected(expect: str, tag: str, text: str) -> None:
    ((child,),) = _suite([make_result(expect=expect, outcome="skipped")]).findall("testcase")
    assert child.tag == tag
    assert text in (child.text or "")


def test_counts_agree_with_the_elements() -> None:
    outcomes = ("pass", "fail", "invalid", "inconclusive", "error", "skipped")
    suite = _suite([make_result(outcome=outcome) for outcome in outcomes])
    counts = {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": "6", "failures": "4", "errors": "1", "skipped": "0"}
    assert suite.get("time") == "1.500"


def _controller(name: str, **facts: str) -> EffectivePart:
    parameters = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    return EffectivePart("controller", "controller", name, None, tuple(parameters))


@pytest.fixture
def results() -> list[CaseResult]:
    outcomes = ("pass", "fail", "invalid", "error", "skipped")
    expected = {"skipped": "skipped"}
    ordinary = [
        make_result(id=outcome, outcome=outcome, expect=expected.get(outcome, "pass"), duration=1234.5)
        for outcome in outcomes
    ]
    bad = {"outcome": "error", "criteria": (), "reason": HOSTILE, "scenario": f"a/{HOSTILE}.yaml"}
    foreign = {"controller": _controller(HOSTILE, library=HOSTILE, version=HOSTILE, sha256="0" * 64)}
    named = make_result(id="named", test_case="TC-7", requirements=("BR-1",), outcome="fail")
    return [
        *ordinary,
        named,
        make_result(id=HOSTILE, **bad, parts=foreign),
        make_result(id="x" * 5000, **bad),
    ]


def test_the_file_with_test_properties_is_the_other_one_with_nothing_but_these(
    results: list[CaseResult],
) -> None:
    """The other one keeps to the schema of Jenkins' plugin, which has none."""
    root = ElementTree.fromstring(junit_text(run_suites(results, with_properties=True)))
    for testcase in root.iter("testcase"):
        for properties in testcase.findall("properties"):
            testcase.remove(properties)
    ElementTree.indent(root)
    other = ElementTree.fromstring(junit_text(run_suites(results)))
    check(other)
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


def test_polarion_and_xray_find_the_test_case_and_xray_the_requirements() -> None:
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


def test_junitparser_reads_the_test_properties() -> None:
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


def test_the_second_file_is_there_only_where_an_importer_finds_something_in_it() -> None:
    def files(**changes: object) -> set[str]:
        return set(FORMAT.files(make_content(make_result(**changes))))

    assert files() == {"junit.xml"}
    assert files(test_case="TC-1") == files(requirements=("BR-1",)) == {"junit.xml", "junit-properties.xml"}


def test_cases_of_each_controller_from_outside_have_a_suite_that_says_which_it_is() -> None:
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

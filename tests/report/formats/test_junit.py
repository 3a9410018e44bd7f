"""JUnit of a run, as servers, importers and junitparser read it."""

import io
from xml.etree import ElementTree

import pytest

from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report import junit_text, run_suites
from uictest.report.formats.junit import FORMAT, suites_of_run

from ..builders import HOSTILE, make_content, make_result, make_verdict
from ..junit_schema import check


def _suite(results):
    return ElementTree.fromstring(junit_text(run_suites(results))).find("testsuite")


def test_one_testcase_per_case_named_after_file_and_id():
    (testcase,) = _suite([make_result()])
    shown = {"classname": "scenarios.dry.120", "name": "dry-120[command=90]", "time": "0.250"}
    assert (testcase.attrib, [child.tag for child in testcase]) == (shown, ["system-out"])
    assert testcase.findtext("system-out") == "test validity: valid; requirements: not judged"


def test_a_missed_case_is_a_failure_whose_text_says_everything():
    broken = make_verdict(status="fail", value=500.0, margin=-10.0, reason="500 m misses 440 .. 490 m")
    suite = _suite([make_result(outcome="invalid", criteria=(broken,), reason="braking-distance: ...")])
    failure = suite.find("testcase/failure")
    text = failure.text
    assert failure.get("message") == "invalid: braking-distance 500 m, limits 440 .. 490 m. Expected: pass"
    assert text.splitlines()[:2] == [
        failure.get("message"),
        "test validity: not valid (braking-distance); requirements: not judged",
    ]
    assert "braking-distance (validity) fail: 500 m misses 440 .. 490 m" in text


def test_what_is_not_as_expected_comes_first():
    good, bad = make_result(id="a"), make_result(id="b", outcome="fail")
    (suite,) = suites_of_run(make_content(good, bad))
    assert [testcase.name for testcase in suite.testcases] == ["b", "a"]


def test_an_expected_failure_is_no_failure():
    suite = _suite([make_result(expect="fail", outcome="fail"), make_result(expect="fail", outcome="pass")])
    assert [[child.tag for child in testcase] for testcase in suite] == [["system-out"], ["failure"]]


@pytest.mark.parametrize(
    ("expect", "tag", "text"),
    [("skipped", "skipped", "skipped (as expected)"), ("pass", "failure", "skipped. Expected: pass")],
)
def test_a_case_that_nothing_judged_is_skipped_only_if_expected(expect, tag, text):
    ((child,),) = _suite([make_result(expect=expect, outcome="skipped")]).findall("testcase")
    assert child.tag == tag
    assert text in (child.text or "")


def test_counts_agree_with_the_elements():
    outcomes = ("pass", "fail", "invalid", "inconclusive", "error", "skipped")
    suite = _suite([make_result(outcome=outcome) for outcome in outcomes])
    counts = {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": "6", "failures": "4", "errors": "1", "skipped": "0"}
    assert suite.get("time") == "1.500"


def _controller(name, **facts):
    parameters = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    return EffectivePart("controller", "controller", name, None, tuple(parameters))


@pytest.fixture
def results():
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


def test_the_file_with_test_properties_is_the_other_one_with_nothing_but_these(results):
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


def _test_properties(text):
    """What importers see: the `property` elements right below `testcase/properties`."""
    return {
        testcase.attrib["name"]: [
            (each.attrib["name"], each.attrib["value"]) for each in testcase.findall("properties/property")
        ]
        for testcase in ElementTree.fromstring(text).iter("testcase")
    }


def test_polarion_and_xray_find_the_test_case_and_xray_the_requirements():
    """Names: Polarion's xUnit importer; Xray, "Import Execution Results", a comma list of requirements."""
    criteria = (make_verdict(requirements=("BR-2", "BR-1")),)
    results = [
        make_result(id="both", outcome="fail", test_case="WSP-7", requirements=("BR-1",), criteria=criteria),
        make_result(id="requirements", requirements=("BR-10", "BR-9")),
        make_result(id="test-case", test_case="WSP-8"),
        make_result(id="neither"),
    ]
    text = junit_text(run_suites(results, with_properties=True))
    assert _test_properties(text) == {
        "both": [("polarion-testcase-id", "WSP-7"), ("test_key", "WSP-7"), ("requirements", "BR-1,BR-2")],
        "requirements": [("requirements", "BR-10,BR-9")],
        "test-case": [("polarion-testcase-id", "WSP-8"), ("test_key", "WSP-8")],
        "neither": [],
    }
    assert ElementTree.fromstring(text).find("testsuite/testcase")[0].tag == "properties"  # as pytest does
    assert not any(_test_properties(junit_text(run_suites(results))).values())
    suite = _suite(results).find("properties/property")
    assert suite.attrib == {"name": "requirements", "value": "BR-1,BR-2,BR-9,BR-10"}


def test_the_second_file_is_there_only_where_an_importer_finds_something_in_it():
    def files(**changes):
        return set(FORMAT.files(make_content(make_result(**changes))))

    assert files() == {"junit.xml"}
    assert files(test_case="TC-1") == files(requirements=("BR-1",)) == {"junit.xml", "junit-properties.xml"}


def test_cases_of_each_controller_from_outside_have_a_suite_that_says_which_it_is():
    one = _controller("Wsp", python="wsp.py", sha256="1" * 64, version="2.1")
    other = _controller("tcp://rig:5025", connect="tcp://rig:5025")
    own = _controller("threshold", algorithm="threshold")
    parts = {"a": one, "b": own, "c": other, "d": one}
    results = [make_result(id=name, parts={"controller": part}) for name, part in parts.items()]
    suites = list(ElementTree.fromstring(junit_text(run_suites(results))))
    cases = {suite.get("name"): [case.get("name") for case in suite.iter("testcase")] for suite in suites}
    assert cases == {"uictest: Wsp": ["a", "d"], "uictest": ["b"], "uictest: tcp://rig:5025": ["c"]}
    told = [{each.get("name"): each.get("value") for each in suite.iter("property")} for suite in suites]
    python = {"kind": "python", "source": "wsp.py", "version": "2.1", "sha256": "1" * 64}
    at_socket = {"kind": "connect", "source": "tcp://rig:5025"}
    assert told == [
        {"controller": "Wsp"} | {f"controller.{key}": text for key, text in python.items()},
        {"controller": "threshold"},
        {"controller": "tcp://rig:5025"} | {f"controller.{key}": text for key, text in at_socket.items()},
    ]


def test_junitparser_reads_back_what_was_written(results):
    junitparser = pytest.importorskip("junitparser")
    text = junit_text(run_suites(results, with_properties=True)).partition("\n")[2]
    suites = list(junitparser.JUnitXml.fromfile(io.StringIO(text)))
    counts = [(suite.tests, suite.failures, suite.errors, suite.skipped) for suite in suites]
    assert counts == [(7, 3, 2, 1), (1, 0, 1, 0)]
    found = {case.name: case for suite in suites for case in suite}
    assert found["pass"].is_passed
    assert found["fail"].is_failure
    assert found["skipped"].is_skipped
    assert found["error"].is_error
    assert "invalid. Expected: pass" in found["invalid"].result[0].text
    assert any("<b>&" in name for name in found)
    (properties,) = found["named"].iterchildren(junitparser.Properties)
    named = {each.name: each.value for each in properties}
    assert named == {"polarion-testcase-id": "TC-7", "test_key": "TC-7", "requirements": "BR-1"}

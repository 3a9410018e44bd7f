"""JUnit XML: the rules of the schema that Jenkins' xUnit plugin checks, whatever the texts."""

import io
from xml.etree import ElementTree

import pytest
from hypothesis import example, given, strategies as st

from uictest.core.document import Suite, Testcase, class_name
from uictest.report.formats.junit import junit_text
from uictest.report.words import xml_text

from ..junit_schema import WITH_TEST_PROPERTIES, check
from .made_up import ANY_TEXT, TEXTS

STATUS = st.sampled_from(["passed", "failure", "error", "skipped"])
TIME = st.none() | st.floats(0.0, 1e6)
PROPERTIES = st.dictionaries(ANY_TEXT, ANY_TEXT, max_size=2)
LINES = st.lists(ANY_TEXT, min_size=1, max_size=3)
TESTCASES = st.builds(
    Testcase, ANY_TEXT, ANY_TEXT, STATUS, LINES, kind=st.just(""), duration=TIME, properties=PROPERTIES
)


def test_a_failure_says_its_kind_and_what_is_unknown_is_left_out():
    text = junit_text([Suite("s", [Testcase("c", "n", "failure", ["why", "more"], kind="baseline")])])
    (suite,) = ElementTree.fromstring(text)
    assert suite.find("testcase/failure").attrib == {"message": "why", "type": "baseline"}
    assert suite.findtext("testcase/failure") == "why\nmore"
    assert not suite.findall(".//properties")
    assert all("time" not in element.attrib for element in suite.iter())


def test_properties_stand_first_and_none_is_empty():
    testcase = Testcase(
        "c", "n", "passed", duration=1234.5, properties={"test_key": "TC-7", "requirements": ""}
    )
    text = junit_text([Suite("s", [testcase], properties={"controller": "x"})])
    (suite,) = ElementTree.fromstring(text)
    assert [child.tag for child in suite] == ["properties", "testcase"]  # as pytest does
    assert [(each.get("name"), each.get("value")) for each in suite.findall("testcase/properties/")] == [
        ("test_key", "TC-7")
    ]
    assert suite.find("testcase").get("time") == "1234.500"


@given(st.builds(Suite, ANY_TEXT, st.lists(TESTCASES, max_size=4), TIME, PROPERTIES))
@example(
    Suite(
        "x", [Testcase(text, text, "error", [text]) for text in TEXTS], None, {text: text for text in TEXTS}
    )
)
def test_whatever_is_told_the_file_keeps_to_the_schema_and_says_it(suite):
    root = ElementTree.fromstring(junit_text([suite]))
    check(root, WITH_TEST_PROPERTIES)
    (element,) = root
    statuses = [testcase.status for testcase in suite.testcases]
    counts = [str(statuses.count(status)) for status in ("failure", "error", "skipped")]
    assert [element.get(name) for name in ("failures", "errors", "skipped")] == counts
    assert element.get("tests") == str(len(statuses))
    for shown, told in zip(element.iter("testcase"), suite.testcases, strict=True):
        tag = "system-out" if told.status == "passed" else told.status
        lines = "\n".join(map(xml_text, told.lines)).replace("\r\n", "\n").replace("\r", "\n")
        assert (shown.findtext(tag) or "") == lines


def test_junitparser_reads_back_what_was_written():
    junitparser = pytest.importorskip("junitparser")
    statuses = ("passed", "failure", "error", "skipped")
    named = {"polarion-testcase-id": "TC-7"}
    testcases = [Testcase("a.b", status, status, [f"why {status}"], properties=named) for status in statuses]
    text = junit_text([Suite("s", testcases)]).partition("\n")[2]
    (suite,) = junitparser.JUnitXml.fromfile(io.StringIO(text))
    assert (suite.tests, suite.failures, suite.errors, suite.skipped) == (4, 1, 1, 1)
    found = {case.name: case for case in suite}
    assert found["passed"].is_passed
    assert (found["failure"].is_failure, found["error"].is_error, found["skipped"].is_skipped) == (True,) * 3
    assert found["failure"].result[0].text == "why failure"
    (properties,) = found["skipped"].iterchildren(junitparser.Properties)
    assert {each.name: each.value for each in properties} == named


@pytest.mark.parametrize(
    ("file", "name"),
    [("scenarios/dry/120.yaml", "scenarios.dry.120"), ("../a.yaml", "a"), ("/x/y.series.yaml", "x.y.series")],
)
def test_servers_group_by_the_path_of_the_file(file, name):
    assert class_name(file) == name

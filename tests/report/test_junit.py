"""JUnit XML: the rules of the schema that Jenkins' xUnit plugin checks, whatever the texts."""

from xml.etree import ElementTree

from hypothesis import given, strategies as st

from uictest.core.document import Suite, Testcase
from uictest.report import junit_text
from uictest.report.escaping import xml_text

from .junit_schema import WITH_TEST_PROPERTIES, check

_ANY = st.text(st.characters(codec=None, exclude_categories=[]), max_size=30)
_LINES = st.lists(_ANY, min_size=1, max_size=3)
_STATUS = st.sampled_from(["passed", "failure", "error", "skipped"])
_TIME = st.none() | st.floats(0.0, 1e6)
_PROPERTIES = st.dictionaries(_ANY, _ANY, max_size=2)
_TESTCASES = st.builds(
    Testcase, _ANY, _ANY, _STATUS, _LINES, kind=st.just(""), duration=_TIME, properties=_PROPERTIES
)


def test_a_failure_says_its_kind_and_what_is_unknown_is_left_out():
    text = junit_text([Suite("s", [Testcase("c", "n", "failure", ["why", "more"], kind="baseline")])])
    (suite,) = ElementTree.fromstring(text)
    assert suite.find("testcase/failure").attrib == {"message": "why", "type": "baseline"}
    assert not suite.findall(".//properties")
    assert all("time" not in each.attrib for each in suite.iter())


@given(st.builds(Suite, _ANY, st.lists(_TESTCASES, max_size=4), _TIME, _PROPERTIES))
def test_whatever_is_told_the_file_keeps_to_the_schema_and_says_it(suite):
    root = ElementTree.fromstring(junit_text([suite]))
    check(root, WITH_TEST_PROPERTIES)
    (element,) = root
    statuses = [each.status for each in suite.testcases]
    counts = [str(statuses.count(status)) for status in ("failure", "error", "skipped")]
    assert [element.get(name) for name in ("failures", "errors", "skipped")] == counts
    assert element.get("tests") == str(len(statuses))
    for shown, told in zip(element.iter("testcase"), suite.testcases, strict=True):
        tag = "system-out" if told.status == "passed" else told.status
        lines = "\n".join(map(xml_text, told.lines)).replace("\r\n", "\n").replace("\r", "\n")
        assert (shown.findtext(tag) or "") == lines

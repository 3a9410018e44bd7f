"""A result in its formats: files, JUnit by the schema of Jenkins' xUnit plugin, a summary for GitHub."""

import io
from xml.etree import ElementTree

import pytest
from hypothesis import example, given, strategies as st

from uictest.core.document import Suite, Testcase, class_name
from uictest.report.formats import (
    DRAWING,
    FORMATS,
    IN_EVERY_RUN,
    LIMIT,
    Publication,
    append_step_summary,
    publish,
)
from uictest.report.formats.junit import junit_text
from uictest.report.words import xml_text

from ..junit_schema import WITH_TEST_PROPERTIES, check
from .made_up import ANY_TEXT, DOCUMENT, TABLE, TEXTS, table_of_texts


def publication(**changes):
    def suites(named):
        return [Suite("s", [Testcase("c", "n", "passed", properties={"id": "1"} if named else {})])]

    content = {"document": DOCUMENT, "tables": [TABLE, table_of_texts(["a"])], "page": lambda: "<p>"}
    content |= {"suites": suites, "texts": {"results.json": '{"name": "a\udcff"}'}}
    return Publication(**content | changes)


FILES = {"html": ["index.html"], "junit": ["junit.xml"], "md": ["summary.md"], "xlsx": ["report.xlsx"]}
FILES["csv"] = ["tables/cells.csv", "tables/texts.csv"]


@pytest.mark.parametrize("formats", [*([name] for name in FILES), ["csv", "junit", "csv"], []])
def test_every_format_becomes_files_once_and_documents_are_always_there(tmp_path, formats):
    paths = publish(publication(), formats, tmp_path)
    wanted = [file for name in dict.fromkeys(formats) for file in FILES[name]]
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == wanted
    assert all(path.stat().st_size for path in paths)
    # A name that is no UTF-8 is an escape.
    assert (tmp_path / "results.json").read_text() == '{"name": "a\\udcff"}'


def test_the_formats_of_every_run_are_there_and_only_the_page_draws():
    assert set(FILES) == set(FORMATS)
    assert (("csv", "junit"), {"html"}) == (IN_EVERY_RUN, DRAWING)


def test_the_file_with_properties_of_testcases_is_there_only_where_an_importer_finds_something_in_it(
    tmp_path,
):
    assert len(publish(publication(), ["junit"], tmp_path)) == 1
    plain, named = publish(publication(named_in_tests=True), ["junit"], tmp_path)
    assert (plain.name, named.name) == ("junit.xml", "junit-properties.xml")
    assert ("<property " in plain.read_text(), "<property " in named.read_text()) == (False, True)


def test_what_cannot_be_finished_leaves_nothing(tmp_path):
    def page():
        raise OSError("no recording")

    with pytest.raises(OSError, match="no recording"):
        publish(publication(page=page, texts={}), ["html"], tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("there", "room"), [(0, LIMIT), (600_000, 400_000), (999_500, 2_000)])
def test_a_summary_has_the_room_that_others_left(tmp_path, monkeypatch, there, room):
    path = tmp_path / "summary"
    if there:
        path.write_bytes(b"x" * (there - 1) + b"\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(path))
    append_step_summary(
        publication(tables=[], document=DOCUMENT._replace(sections=[table_of_texts(["é" * 90] * 9999)]))
    )
    assert path.read_bytes()[there:].startswith(b"## A run\n")
    assert room - 2_000 < path.stat().st_size - there <= room


@pytest.mark.parametrize("value", ["", None])
def test_without_github_no_summary_is_made(value, monkeypatch):
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    if value is not None:
        monkeypatch.setenv("GITHUB_STEP_SUMMARY", value)
    append_step_summary(publication(document=None))


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

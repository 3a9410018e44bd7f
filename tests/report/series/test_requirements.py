"""Series are evidence on requirements, like cases, in every report."""

import csv
import io
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from uictest.plans.scenario import expectation_of
from uictest.report import junit_text, run_suites, write_formats
from uictest.report.formats.junit import FORMAT
from uictest.report.formats.md import markdown_summary
from uictest.report.requirements import Evidence, verified_requirements

from ..builders import make_content, make_result
from .made_up import make_series

BY_CRITERION = ("BR-1",)


def naming(result, status="pass", **changes):
    """The series with a criterion of this status that names BR-1."""
    (each,) = result.criteria
    verdict = replace(each.verdict, status=status, requirements=BY_CRITERION)
    return replace(result, criteria=(replace(each, verdict=verdict),), **changes)


@pytest.fixture
def named():
    """A series that names BR-9 and the test case WSP-TC-7, with a criterion that names BR-1."""
    return naming(make_series(requirements=("BR-9",), test_case="WSP-TC-7"))


@pytest.mark.parametrize(
    ("expect", "outcome", "word", "status"),
    [
        ("pass", "pass", "pass", "met"),
        ("pass", "fail", "fail", "not met"),
        ("pass", "inconclusive", "inconclusive", "not met"),
        ("pass", "error", "error", "not met"),
        ("pass", "skipped", "unexpected skip", "not tested"),
        ("skipped", "skipped", "skipped", "not tested"),
        ("fail", "fail", "expected fail", "met"),
    ],
)
def test_a_requirement_of_a_series_follows_its_outcome_against_the_expectation(expect, outcome, word, status):
    result = make_series(expect=expect, outcome=outcome, requirements=("BR-9",))
    (requirement,) = verified_requirements([], [result])
    assert requirement.evidence == (Evidence("series", "acceptance", word),)
    assert requirement.status == status


@pytest.mark.parametrize(
    ("status", "outcome", "word"),
    [
        ("pass", "pass", "pass"),
        ("pass", "fail", "pass"),
        ("fail", "fail", "fail"),
        ("inconclusive", "inconclusive", "inconclusive"),
        ("not_applicable", "skipped", "not applicable"),
        ("pass", "error", "error"),
    ],
)
def test_a_requirement_of_a_criterion_follows_its_verdict_unless_stops_failed_to_run(status, outcome, word):
    (requirement,) = verified_requirements([], [naming(make_series(), status, outcome=outcome)])
    assert requirement.evidence == (Evidence("series", "acceptance", word, ("k-wet",)),)


def test_stops_of_a_series_and_criteria_of_one_that_must_not_pass_are_no_evidence():
    assert not verified_requirements(
        [], [naming(make_series(), "fail", expect=expectation_of("fail"), outcome="fail")]
    )
    result = make_series()
    cases = tuple(replace(each, case=replace(each.case, requirements=("BR-5",))) for each in result.cases)
    assert not verified_requirements([], [replace(result, cases=cases)])


def test_a_case_and_a_series_of_the_same_id_stand_apart_in_every_table(named, tmp_path):
    case = make_result(id="acceptance", requirements=("BR-9",), outcome="fail")
    content = make_content(case, series=[named])
    write_formats(tmp_path, content, ["csv", "html"])
    rows = list(csv.reader(io.StringIO((tmp_path / "requirements.csv").read_text())))
    assert rows[1:] == [
        ["BR-1", "met", "series", "acceptance", "pass", "k-wet"],
        ["BR-9", "not met", "case", "acceptance", "fail", ""],
        ["BR-9", "not met", "series", "acceptance", "pass", ""],
    ]
    assert "| `BR-9` | **not met** | 2 | acceptance (fail) |" in markdown_summary(content)
    page = (tmp_path / "index.html").read_text()
    assert "1 case, 1 series" in page
    assert '<a href="#series-acceptance">series acceptance</a>' in page
    assert "WSP-TC-7: BR-9" in page


def test_tables_of_series_name_requirements(named, tmp_path):
    write_formats(tmp_path, make_content(series=[named]), ["csv"])
    (row,) = csv.DictReader(io.StringIO((tmp_path / "series-criteria.csv").read_text()))
    assert row["requirements"] == "BR-1"


def _properties(element):
    return {each.get("name"): each.get("value") for each in element.findall("properties/property")}


def test_testcases_name_the_requirements_of_their_criterion_and_of_the_series(named):
    unexpected = replace(named, expect=expectation_of("fail"))
    suite = ElementTree.fromstring(junit_text(run_suites([], series=[unexpected], with_properties=True)))[0]
    of_criterion, outcome = suite.findall("testcase")
    ids = {"polarion-testcase-id": "WSP-TC-7", "test_key": "WSP-TC-7"}
    assert _properties(of_criterion) == {**ids, "requirements": "BR-9,BR-1"}
    assert _properties(outcome) == {**ids, "requirements": "BR-9"}
    assert _properties(suite) == {"requirements": "BR-1,BR-9"}
    plain = ElementTree.fromstring(junit_text(run_suites([], series=[unexpected])))[0]
    assert _properties(plain) == {"requirements": "BR-1,BR-9"}
    assert not plain.findall("testcase/properties")


def test_the_file_for_test_management_is_there_where_a_series_has_something_for_it():
    def files(result):
        return set(FORMAT.files(make_content(series=[result])))

    both = {"junit.xml", "junit-properties.xml"}
    assert files(make_series()) == {"junit.xml"}
    assert files(make_series(test_case="WSP-TC-7")) == files(naming(make_series())) == both

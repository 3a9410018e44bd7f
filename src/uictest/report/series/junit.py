"""JUnit for series: a suite for each, with one testcase per criterion."""

from __future__ import annotations

from typing import Final

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.judging import evaluation
from uictest.judging.series import SeriesResult, SeriesVerdict
from uictest.plans.scenario import in_order_of_ids
from uictest.report.junit import suite_properties, test_properties
from uictest.report.part_wording import controller_of
from uictest.report.requirements import requirements_of
from uictest.report.series.series_sentences import (
    count_sentences,
    not_counted_sentences,
    series_explanation,
    series_verdict_sentence,
)

_STATUSES: Final[dict[str, TestcaseStatus]] = {
    "fail": "failure",
    "inconclusive": "failure",
    "not_applicable": "skipped",
}


def series_suite(result: SeriesResult, with_properties: bool, uictest_version: str) -> Suite:
    """Return the suite of a series.

    A criterion that is not met is a failure unless the series has its expected outcome. Where it has not and
    every criterion is met, or stops failed to run, a testcase `outcome` says so. With `with_properties` each
    testcase has the test case and the requirements of the series, and the requirements of its criterion.
    """
    testcases = [_testcase(result, each, with_properties) for each in result.criteria]
    if not result.met and not any(each.status == "failure" for each in testcases):
        testcases.append(_outcome(result, with_properties))
    return Suite(
        f"uictest series: {result.id}",
        testcases,
        sum(each.case.duration for each in result.cases),
        suite_properties(
            evaluation.program_in(result.cases[0].case.parts) if result.cases else None,
            dict.fromkeys(each.case.controller_version for each in result.cases),
            in_order_of_ids(requirements_of(result)),
            [controller_of(each.case)[0] for each in result.cases],
            uictest_version,
        ),
    )


def _testcase(result: SeriesResult, each: SeriesVerdict, with_properties: bool) -> Testcase:
    status = _STATUSES.get(each.verdict.status, "passed")
    if status == "failure" and (result.met or result.outcome == "error"):
        status = "passed"
    lines = [
        series_verdict_sentence(each, result.confidence),
        *count_sentences(result),
        *not_counted_sentences(result),
    ]
    own = test_properties(result.test_case, dict.fromkeys((*result.requirements, *each.verdict.requirements)))
    return _named(result, each.verdict.id, status, lines, own if with_properties else {})


def _outcome(result: SeriesResult, with_properties: bool) -> Testcase:
    status: TestcaseStatus = "error" if result.outcome == "error" else "failure"
    own = test_properties(result.test_case, result.requirements) if with_properties else {}
    return _named(result, "outcome", status, series_explanation(result), own)


def _named(
    result: SeriesResult, name: str, status: TestcaseStatus, lines: list[str], properties: dict[str, str]
) -> Testcase:
    title = f"{result.id}: {name}"
    return Testcase(class_name(result.file), title, status, lines, duration=0.0, properties=properties)

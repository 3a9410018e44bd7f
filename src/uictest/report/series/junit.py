"""JUnit for series: a suite for each, with one testcase per criterion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath
from xml.etree import ElementTree

from uictest.judging import evaluation
from uictest.judging.series import SeriesResult, SeriesVerdict
from uictest.plans.scenario import in_order_of_ids
from uictest.report.escaping import xml_text
from uictest.report.junit_properties import add_suite_properties, add_test_properties
from uictest.report.part_wording import controller_of
from uictest.report.requirements import requirements_of
from uictest.report.series.wording import (
    count_sentences,
    not_counted_sentences,
    series_explanation,
    series_verdict_sentence,
)


def series_testsuites(
    results: Sequence[SeriesResult], test_properties: bool, uictest_version: str
) -> Iterator[ElementTree.Element]:
    """Yield the suite of every series.

    A criterion that is not met is a failure unless the series has its expected outcome. Where it has not and
    every criterion is met, or stops failed to run, a testcase `outcome` says so. With `test_properties` each
    testcase has the test case and the requirements of the series, and the requirements of its criterion.
    """
    for result in results:
        testcases = [_testcase(result, each) for each in result.criteria]
        if not result.met and not any(each.find("failure") is not None for each in testcases):
            testcases.append(_outcome(result))
        if test_properties:
            _add_test_properties(testcases, result)
        suite = ElementTree.Element(
            "testsuite", name=xml_text(f"uictest series: {result.id}"), tests=str(len(testcases))
        )
        _add_properties(suite, result, uictest_version)
        suite.extend(testcases)
        for attribute, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            suite.set(attribute, str(len(suite.findall(f"testcase/{tag}"))))
        suite.set("time", f"{sum(each.case.duration for each in result.cases):.3f}")
        yield suite


def _add_properties(suite: ElementTree.Element, result: SeriesResult, uictest_version: str) -> None:
    """Add which controller was tested, and which requirements the series and its criteria verify."""
    program = evaluation.program_in(result.cases[0].case.parts) if result.cases else None
    told = dict.fromkeys(each.case.controller_version for each in result.cases)
    names = [controller_of(each.case)[0] for each in result.cases]
    requirements = in_order_of_ids(requirements_of(result))
    add_suite_properties(suite, program, told, requirements, names, uictest_version)


def _add_test_properties(testcases: Sequence[ElementTree.Element], result: SeriesResult) -> None:
    """Add them to the testcases of the criteria, and to `outcome` behind them where there is one."""
    own_of_each = [*(each.verdict.requirements for each in result.criteria), ()]
    for testcase, own in zip(testcases, own_of_each, strict=False):
        add_test_properties(testcase, result.test_case, dict.fromkeys((*result.requirements, *own)))


def _testcase(result: SeriesResult, each: SeriesVerdict) -> ElementTree.Element:
    element = _empty(result, each.verdict.id)
    lines = [
        series_verdict_sentence(each, result.confidence),
        *count_sentences(result),
        *not_counted_sentences(result),
    ]
    tag = {"fail": "failure", "inconclusive": "failure", "not_applicable": "skipped"}.get(each.verdict.status)
    if tag is None or (tag == "failure" and (result.met or result.outcome == "error")):
        ElementTree.SubElement(element, "system-out").text = xml_text("\n".join(lines))
    else:
        _add(element, tag, lines)
    return element


def _outcome(result: SeriesResult) -> ElementTree.Element:
    element = _empty(result, "outcome")
    _add(element, "error" if result.outcome == "error" else "failure", series_explanation(result))
    return element


def _empty(result: SeriesResult, name: str) -> ElementTree.Element:
    path = PurePosixPath(result.file).with_suffix("")
    class_name = ".".join(part for part in path.parts if part not in ("/", "..", "."))
    return ElementTree.Element(
        "testcase", classname=xml_text(class_name), name=xml_text(f"{result.id}: {name}"), time="0.000"
    )


def _add(element: ElementTree.Element, tag: str, texts: Sequence[str]) -> None:
    lines = [xml_text(text) for text in texts]
    # GitLab shows the text and ignores the message, so the text has to say everything.
    ElementTree.SubElement(element, tag, message=lines[0]).text = "\n".join(lines)

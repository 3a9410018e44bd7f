"""JUnit XML: one testcase per case, the explanation as the element's text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import PurePosixPath
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from uictest.judging import evaluation
from uictest.plans.scenario import in_order_of_ids
from uictest.report import series as series_views
from uictest.report.content import RunContent
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    case_explanation,
    case_word,
    difference_sentences,
)
from uictest.report.escaping import xml_text
from uictest.report.format_registry import ReportFormat
from uictest.report.junit_properties import (
    WITH_TEST_PROPERTIES,
    add_suite_properties,
    add_test_properties,
)
from uictest.report.part_wording import changes_line, controller_of, controllers_text, domain_sentences
from uictest.report.repeat_wording import repeat_sentences
from uictest.report.requirements import requirements_of
from uictest.report.wording import DIFFERS, real_time_sentences

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult


def junit_xml(
    results: Sequence[evaluation.CaseResult],
    baseline: BaselineComparison | None = None,
    series: Sequence[SeriesResult] = (),
    *,
    test_properties: bool = False,
    uictest_version: str = "",
) -> str:
    """Return the results as a JUnit document, characters that XML forbids left out.

    A case that differs from the baseline is a failure; a case of the baseline that is missing and a series
    that differs have a failed testcase of their own beside the cases. Cases with a controller from outside
    have a suite of their own for each such program, whose properties say which it is. A series is a suite of
    its own, with one testcase per criterion.

    It keeps to the schema that Jenkins' xUnit plugin checks against: a testcase has neither `file` nor
    properties there. With `test_properties` a testcase has properties nevertheless: those by which Polarion
    and Xray know the test case and its requirements. `uictest_version` is that of built-in controllers.
    """
    root = ElementTree.Element("testsuites")
    differences = baseline.differences if baseline else {}
    missing = [
        _missing_testcase(case_id, scenario, differences[case_id])
        for case_id, scenario in (baseline.beside_cases if baseline else {}).items()
    ]
    own: dict[evaluation.Program | None, list[evaluation.CaseResult]] = {None: []} if missing else {}
    for result in results:
        own.setdefault(evaluation.program_in(result.parts), []).append(result)
    for program, of_program in (own or ({} if series else {None: []})).items():
        told = dict.fromkeys(result.controller_version for result in of_program)
        testcases = [
            _testcase(result, differences.get(result.id, ()), uictest_version) for result in of_program
        ]
        if test_properties:
            _add_test_properties(testcases, of_program)
        duration = sum(result.duration for result in of_program)
        suite = _testsuite(program, [*testcases, *(missing if program is None else ())], duration)
        names = [controller_of(result)[0] for result in of_program]
        add_suite_properties(suite, program, told, _requirements(of_program), names, uictest_version)
        root.append(suite)
    if series:
        root.extend(series_views.series_testsuites(series, test_properties, uictest_version))
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _testsuite(
    program: evaluation.Program | None,
    testcases: Sequence[ElementTree.Element],
    duration: float,
) -> ElementTree.Element:
    name = "uictest" if program is None else xml_text(f"uictest: {program.name}")
    suite = ElementTree.Element("testsuite", name=name, tests=str(len(testcases)))
    suite.extend(testcases)
    for attribute, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(attribute, str(len(suite.findall(f"testcase/{tag}"))))
    suite.set("time", f"{duration:.3f}")
    return suite


def _requirements(results: Iterable[evaluation.CaseResult]) -> list[str]:
    return in_order_of_ids({each for result in results for each in requirements_of(result)})


def _add_test_properties(
    testcases: Iterable[ElementTree.Element], results: Iterable[evaluation.CaseResult]
) -> None:
    for testcase, result in zip(testcases, results, strict=True):
        add_test_properties(testcase, result.test_case, requirements_of(result))


def _testcase(
    result: evaluation.CaseResult, differences: Sequence[Difference], uictest_version: str
) -> ElementTree.Element:
    element = _empty_testcase(result.id, result.scenario, result.duration)
    tag = _child_tag(result, differs=bool(differences))
    remarks = [*real_time_sentences(result), *domain_sentences(result), *changes_line(result)]
    if tag is not None:
        kind = "baseline" if case_word(result, differences) == DIFFERS else ""
        tested = [f"controller: {text}"] if (text := controllers_text([result], uictest_version)) else []
        _add_child(element, tag, [*case_explanation(result, differences), *tested, *remarks], kind)
    elif remarks := [*repeat_sentences(result), *remarks]:
        ElementTree.SubElement(element, "system-out").text = xml_text("\n".join(remarks))
    return element


def _missing_testcase(case_id: str, scenario: str, differences: Sequence[Difference]) -> ElementTree.Element:
    element = _empty_testcase(case_id, scenario, 0.0)
    _add_child(element, "failure", difference_sentences(differences), "baseline")
    return element


def _empty_testcase(case_id: str, scenario: str, duration: float) -> ElementTree.Element:
    return ElementTree.Element(
        "testcase",
        classname=xml_text(_dotted(scenario)),
        name=xml_text(case_id),
        time=f"{duration:.3f}",
    )


def _add_child(element: ElementTree.Element, tag: str, texts: Sequence[str], kind: str = "") -> None:
    lines = [xml_text(text) for text in texts]
    child = ElementTree.SubElement(element, tag, message=lines[0])
    if kind:
        child.set("type", kind)
    # GitLab shows the text and ignores the message, so the text has to say everything.
    child.text = "\n".join(lines)


def _child_tag(result: evaluation.CaseResult, *, differs: bool) -> str | None:
    if result.outcome == "error":
        return "error"
    if not result.met or differs:
        return "failure"
    return "skipped" if result.outcome == "skipped" else None


def _dotted(scenario: str) -> str:
    path = PurePosixPath(scenario)
    return ".".join(part for part in path.with_suffix("").parts if part not in ("/", "..", "."))


def _files(content: RunContent) -> dict[str, bytes]:
    of_run = partial(
        junit_xml,
        content.results,
        content.baseline,
        content.series,
        uictest_version=content.uictest_version,
    )
    files = {"junit.xml": of_run()}
    judged: list[evaluation.CaseResult | SeriesResult] = [*content.results, *content.series]
    if any(result.test_case or requirements_of(result) for result in judged):
        files[WITH_TEST_PROPERTIES] = of_run(test_properties=True)
    return {name: text.encode() for name, text in files.items()}


FORMAT = ReportFormat(_files)

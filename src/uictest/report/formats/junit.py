"""JUnit XML of a run: one testcase per case, the explanation as the element's text."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.judging import evaluation
from uictest.plans.scenario import in_order_of_ids
from uictest.report import series as series_views
from uictest.report.car_wording import implausible_sentences
from uictest.report.case_words import DIFFERS
from uictest.report.content import RunContent
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    case_explanation,
    case_word,
    difference_sentences,
)
from uictest.report.firmness_sentences import firmness_property, firmness_sentences
from uictest.report.formats import ReportFormat
from uictest.report.junit import WITH_TEST_PROPERTIES, junit_text, suite_properties, test_properties
from uictest.report.part_wording import changes_line, controller_of, controllers_text, domain_sentences
from uictest.report.repeat_wording import repeat_sentences
from uictest.report.requirements import requirements_of
from uictest.report.verdict_sentences import allowed_sentences, real_time_sentences, statement_sentence

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult


def run_suites(
    results: Sequence[evaluation.CaseResult],
    baseline: BaselineComparison | None = None,
    series: Sequence[SeriesResult] = (),
    *,
    with_properties: bool = False,
    uictest_version: str = "",
    explain: Callable[[evaluation.CaseResult], list[str]] | None = None,
) -> Iterator[Suite]:
    """Yield the testcases of a run.

    A case that differs from the baseline is a failure; a case of the baseline that is missing and a series
    that differs have a failed testcase of their own beside the cases. Cases with a controller from outside
    have a suite of their own for each such program, whose properties say which it is. A series is a suite of
    its own, with one testcase per criterion.

    With `with_properties` testcases have those by which Polarion and Xray know the test case and its
    requirements. `uictest_version` is that of built-in controllers. `explain` gives the reasons for an
    outcome where more is known of a stop than its result.
    """
    differences = baseline.differences if baseline else {}
    missing = [
        Testcase(
            class_name(file), own_id, "failure", difference_sentences(differences[own_id]), "baseline", 0.0
        )
        for own_id, file in (baseline.beside_cases if baseline else {}).items()
    ]
    own: dict[evaluation.Program | None, list[evaluation.CaseResult]] = {None: []} if missing else {}
    for result in results:
        own.setdefault(evaluation.program_in(result.parts), []).append(result)
    for program, of_program in (own or ({} if series else {None: []})).items():
        testcases = [
            _testcase(result, differences.get(result.id, ()), uictest_version, with_properties, explain)
            for result in of_program
        ]
        yield Suite(
            "uictest" if program is None else f"uictest: {program.name}",
            [*testcases, *(missing if program is None else ())],
            sum(result.duration for result in of_program),
            suite_properties(
                program,
                dict.fromkeys(result.controller_version for result in of_program),
                in_order_of_ids({each for result in of_program for each in requirements_of(result)}),
                [controller_of(result)[0] for result in of_program],
                uictest_version,
            ),
        )
    yield from (series_views.series_suite(each, with_properties, uictest_version) for each in series)


def _testcase(
    result: evaluation.CaseResult,
    differences: Sequence[Difference],
    uictest_version: str,
    with_properties: bool,
    explain: Callable[[evaluation.CaseResult], list[str]] | None,
) -> Testcase:
    status = _status(result, differs=bool(differences))
    remarks = [*real_time_sentences(result), *domain_sentences(result), *implausible_sentences(result)]
    remarks += changes_line(result)
    remarks += firmness_sentences(result)
    is_of_baseline = status != "passed" and case_word(result, differences) == DIFFERS
    if status != "passed":
        controllers = controllers_text([result], uictest_version)
        tested = [f"controller: {controllers}"] if controllers else []
        reasons = explain(result) if explain else case_explanation(result, differences)
        remarks = [*reasons, *tested, *remarks]
    else:
        statements = [statement_sentence(result)] if result.criteria else []
        remarks = [*allowed_sentences([result]), *repeat_sentences(result), *remarks, *statements]
    return Testcase(
        class_name(result.scenario),
        result.id,
        status,
        remarks,
        "baseline" if is_of_baseline else "",
        result.duration,
        {
            **(test_properties(result.test_case, requirements_of(result)) if with_properties else {}),
            **firmness_property(result),
        },
    )


def _status(result: evaluation.CaseResult, *, differs: bool) -> TestcaseStatus:
    if result.outcome == "error":
        return "error"
    if not result.met or differs:
        return "failure"
    return "skipped" if result.outcome == "skipped" else "passed"


def _files(content: RunContent) -> dict[str, bytes]:
    judged: list[evaluation.CaseResult | SeriesResult] = [*content.results, *content.series]
    named = any(result.test_case or requirements_of(result) for result in judged)
    files = {"junit.xml": False} | ({WITH_TEST_PROPERTIES: True} if named else {})
    return {
        name: junit_text(suites_of_run(content, with_properties=with_properties)).encode()
        for name, with_properties in files.items()
    }


def suites_of_run(content: RunContent, *, with_properties: bool = False) -> Iterator[Suite]:
    """Yield the testcases of what a run is reported by, in the order of the other reports."""
    return run_suites(
        content.ranked,
        content.baseline,
        content.series,
        with_properties=with_properties,
        uictest_version=content.uictest_version,
        explain=content.explanation,
    )


FORMAT = ReportFormat(_files)

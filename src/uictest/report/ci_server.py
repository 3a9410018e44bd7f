"""What a CI server is told of results: the testcases of JUnit, and the annotations of GitHub."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, Literal

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.judging import evaluation
from uictest.plans.scenario import in_order_of_ids
from uictest.report.case_conditions import (
    changes_line,
    controller_of,
    controllers_text,
    domain_sentences,
    implausible_sentences,
)
from uictest.report.content import RunContent
from uictest.report.difference import BaselineComparison, difference_sentences
from uictest.report.requirements import requirements_of
from uictest.report.rerun import rerun_command
from uictest.report.robustness import firmness_property, firmness_sentences, repeat_sentences, stops_text
from uictest.report.series_report import series_explanation, series_verdict_sentence, stops_sentences
from uictest.report.summary import case_causes
from uictest.report.verdict_sentences import allowed_sentences, real_time_sentences, statement_sentence
from uictest.report.words import DIFFERS, result_word, workflow_message, workflow_property

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

_STATUS_OF_CRITERION: Final[Mapping[str, TestcaseStatus]] = {
    "fail": "failure",
    "inconclusive": "failure",
    "not_applicable": "skipped",
}


def run_suites(content: RunContent, *, with_properties: bool = False) -> Iterator[Suite]:
    """Yield the testcases of a run, in the order of the other reports.

    A case that differs from the baseline is a failure; a case of the baseline that is missing and a series
    that differs have a failed testcase of their own besides the cases. A programme has a testcase for each of
    its tests, and for each stop that could not be run or fails a check. Cases with a controller from outside
    have a suite of their own for each such program, whose properties say which it is. A series is a suite of
    its own, with one testcase per criterion. With `with_properties` testcases have those by which Polarion
    and Xray know the test case and its requirements. Where a run ended before all of it was run and nothing
    in it failed, a testcase says so.
    """
    suites = list(_suites_of_run(content, with_properties=with_properties))
    yield from suites
    statuses = {testcase.status for suite in suites for testcase in suite.testcases}
    if not content.complete and statuses.isdisjoint(("failure", "error")):
        lines = ["incomplete: not all that was selected was run"]
        yield Suite("uictest", [Testcase("uictest", "uictest run", "error", lines)])


def _suites_of_run(content: RunContent, *, with_properties: bool) -> Iterator[Suite]:
    baseline = content.baseline
    missing = [
        Testcase(
            *(class_name(file), case_id, "failure", difference_sentences(content.differences(case_id))),
            kind="baseline",
            duration=0.0,
        )
        for case_id, file in (baseline.beside_cases if baseline else {}).items()
    ]
    if content.campaign is not None and content.campaign.tests:
        of_tests = [
            Testcase("programme", test.name, test.status, test.lines) for test in content.campaign.tests
        ]
        stops = [result for result in content.ranked if not content.passes(result)]
        of_stops = [_testcase(content, result, with_properties) for result in stops]
        yield _suite(
            "uictest", [*of_tests, *of_stops, *missing], content.results, (), content.uictest_version
        )
        return
    # A run without any case has an empty suite.
    by_program: dict[evaluation.Program | None, list[evaluation.CaseResult]] = {}
    if missing or not (content.results or content.series):
        by_program[None] = []
    for result in content.ranked:
        by_program.setdefault(evaluation.program_in(result.parts), []).append(result)
    for program, cases in by_program.items():
        testcases = [_testcase(content, result, with_properties) for result in cases]
        yield _suite(
            "uictest" if program is None else f"uictest: {program.name}",
            [*testcases, *(missing if program is None else ())],
            cases,
            {requirement for result in cases for requirement in requirements_of(result)},
            content.uictest_version,
        )
    for series in content.series:
        yield series_suite(series, content.uictest_version, with_properties=with_properties)


def _suite(
    name: str,
    testcases: Sequence[Testcase],
    cases: Sequence[evaluation.CaseResult],
    requirements: Iterable[str],
    uictest_version: str,
) -> Suite:
    """Return testcases on cases of one controller, with what is known of it and of them."""
    program = evaluation.program_in(cases[0].parts) if cases else None
    if program is not None:
        controller = program_properties(program, {case.controller_version: None for case in cases})
    else:
        names = ", ".join(dict.fromkeys(filter(None, (controller_of(case)[0] for case in cases))))
        version = f"uictest {uictest_version}" if names and uictest_version else ""
        controller = {"controller": names, "controller.version": version}
    joined = ",".join(in_order_of_ids(requirements))
    duration = sum(case.duration for case in cases)
    return Suite(name, testcases, duration, controller | {"requirements": joined})


def program_properties(program: evaluation.Program, told: Iterable[str] = ()) -> dict[str, str]:
    """Return `controller` and, where known, `controller.kind`, `.source`, `.version` and `.sha256`.

    `told` has the versions that the program said of itself in some cases, empty where it said none. Where its
    scenario or file states another one, they are `controller.told_version`.
    """
    facts = dataclasses.asdict(program.telling(", ".join(filter(None, told))))
    return {"controller": facts.pop("name"), **{f"controller.{name}": text for name, text in facts.items()}}


def test_properties(test_case: str, requirements: Iterable[str]) -> dict[str, str]:
    """Return the properties by which test management tools know a testcase.

    Polarion reads `polarion-testcase-id`, Xray `test_key` and `requirements`.
    """
    joined = ",".join(requirements)
    return {"polarion-testcase-id": test_case, "test_key": test_case, "requirements": joined}


def _testcase(content: RunContent, result: evaluation.CaseResult, with_properties: bool) -> Testcase:
    differs = bool(content.differences(result.id))
    status: TestcaseStatus = "skipped" if result.outcome == "skipped" else "passed"
    if result.outcome == "error":
        status = "error"
    elif not content.passes(result):
        status = "failure"
    lines = [*real_time_sentences(result), *domain_sentences(result), *implausible_sentences(result)]
    lines += [*changes_line(result), *firmness_sentences(result)]
    if status == "passed":
        statements = [statement_sentence(result)] if result.criteria else []
        lines = [*allowed_sentences([result]), *repeat_sentences(result), *lines, *statements]
    else:
        controllers = controllers_text([result], content.uictest_version)
        tested = [f"controller: {controllers}"] if controllers else []
        lines = [*content.explanation(result), *wsp_lines(content, result), *tested, *lines]
    named = test_properties(result.test_case, requirements_of(result)) if with_properties else {}
    return Testcase(
        class_name(result.scenario),
        result.id,
        status,
        lines,
        "baseline" if differs and content.expected(result) else "",
        result.duration,
        named | firmness_property(result),
    )


def wsp_lines(content: RunContent, result: evaluation.CaseResult) -> list[str]:
    """Return what the recording shows of why a case failed, and the command that runs it again."""
    command = rerun_command(content, result.scenario, result.id)
    causes = [f"cause: {cause}" for cause in case_causes(result, content.traces.get(result.id))]
    return [*causes, *([f"run again: {command}"] if command else [])]


def series_suite(result: SeriesResult, uictest_version: str = "", *, with_properties: bool = False) -> Suite:
    """Return the suite of a series.

    A criterion that is not met is a failure unless the series has its expected outcome. Where it has not and
    every criterion is met, or stops failed to run, a testcase `outcome` says so. With `with_properties` each
    testcase has the test case and the requirements of the series, and the requirements of its criterion.
    """

    def make_testcase(
        name: str, status: TestcaseStatus, lines: Sequence[str], requirements: Sequence[str] = ()
    ) -> Testcase:
        verified = dict.fromkeys((*result.requirements, *requirements))
        return Testcase(
            *(class_name(result.file), f"{result.id}: {name}", status, lines),
            duration=0.0,
            properties=test_properties(result.test_case, verified) if with_properties else {},
        )

    testcases = []
    for judged in result.criteria:
        status = _STATUS_OF_CRITERION.get(judged.verdict.status, "passed")
        if status == "failure" and (result.met or result.outcome == "error"):
            status = "passed"
        lines = [series_verdict_sentence(judged, result.confidence), *stops_sentences(result)]
        testcases.append(make_testcase(judged.verdict.id, status, lines, judged.verdict.requirements))
    if not result.met and all(testcase.status != "failure" for testcase in testcases):
        of_outcome: TestcaseStatus = "error" if result.outcome == "error" else "failure"
        lines = [*series_explanation(result), *stops_sentences(result)]
        testcases.append(make_testcase("outcome", of_outcome, lines))
    cases = [each.case for each in result.cases]
    name = f"uictest series: {result.id}"
    return _suite(name, testcases, cases, requirements_of(result), uictest_version)


def annotation(
    file: str,
    title: str,
    message: str,
    line: int | None = None,
    column: int | None = None,
    level: Literal["error", "notice"] = "error",
) -> str:
    """Return one workflow command; `line` and `column` count from 1."""
    properties = {"file": file, "line": line, "col": column, "title": title}
    shown = ",".join(
        f"{name}={workflow_property(str(value))}" for name, value in properties.items() if value is not None
    )
    return f"::{level} {shown}::{workflow_message(message)}"


def run_annotations(content: RunContent) -> Iterator[str]:
    """Yield the annotations of a run: of cases, tests of a programme, what only the baseline has, series."""
    for result in content.all_results:
        yield from case_annotations(content, result)
    for test in content.campaign.tests if content.campaign else ():
        if test.status == "failure":  # its stops are of the file of the programme
            yield annotation(content.results[0].scenario, f"fail {test.name}", "\n".join(test.lines))
    if content.baseline is not None:
        yield from missing_annotations(content.baseline)
    for series in content.series:
        yield from series_annotations(series)


def case_annotations(content: RunContent, result: evaluation.CaseResult) -> Iterator[str]:
    """Yield an `::error` command for a case that misses its expectation or differs from the baseline.

    A case that uses an allowance, or that is as expected while some of its stops are not, has a `::notice`.
    """
    title = f"{content.word(result)} {result.id}"
    if not content.passes(result):
        lines = [*content.explanation(result), *wsp_lines(content, result), *changes_line(result)]
        yield annotation(result.scenario, title, "\n".join(lines))
    elif result.allowed:
        yield annotation(result.scenario, title, "\n".join(content.explanation(result)), level="notice")
    elif result.repeats is not None and result.repeats.turns:
        title = f"{stops_text(result)} {result.id}"
        yield annotation(result.scenario, title, "\n".join(repeat_sentences(result)), level="notice")


def missing_annotations(baseline: BaselineComparison) -> Iterator[str]:
    """Yield an `::error` command for each missing case of the baseline and each series that differs."""
    for case_id, file in baseline.beside_cases.items():
        lines = difference_sentences(baseline.differences[case_id])
        yield annotation(file, f"{DIFFERS} {case_id}", "\n".join(lines))


def series_annotations(result: SeriesResult) -> Iterator[str]:
    """Yield an `::error` command for a series that misses its expectation."""
    if not result.met:
        title = f"{result_word(result)} {result.id}"
        yield annotation(result.file, title, "\n".join(series_explanation(result)))

"""What a CI server is told of a sweep: a testcase per value of its first parameter, the worst cases."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.judging import evaluation
from uictest.report.github import annotation
from uictest.report.junit import suite_properties, test_properties
from uictest.report.sweep.result import OutcomeCount, SweepResult
from uictest.report.sweep.sweep_sentences import notable_cases, sweep_tally


def sweep_suite(result: SweepResult, file: str, *, with_properties: bool = False) -> Suite:
    """Return the counts of a sweep as testcases; `file` is the sweep file as shown to users."""
    parameter, counts = next(iter(result.rates.items()))
    own = test_properties(result.test_case, result.requirements) if with_properties else {}
    testcases = [
        Testcase(
            class_name(file),
            f"{result.name}[{parameter}={count.value.label}]",
            *_outcome(result, count),
            properties=own,
        )
        for count in counts
    ]
    about = suite_properties(evaluation.program_in(result.base), (), result.requirements)
    return Suite(result.name, testcases, properties=about)


def _outcome(result: SweepResult, count: OutcomeCount) -> tuple[TestcaseStatus, list[str]]:
    status: TestcaseStatus = "passed"
    if count.cases == 0 or count.outcomes["skipped"] == count.cases == count.met:
        status = "skipped"
    elif count.outcomes["error"]:
        status = "error"
    elif count.met < count.cases:
        status = "failure"
    return status, [] if status == "passed" else list(_explanation(result, count))


def _explanation(result: SweepResult, count: OutcomeCount) -> Iterator[str]:
    yield f"{count.cases - count.met} of {count.cases} cases did not meet their expectation"
    yield ", ".join(f"{name}: {number}" for name, number in count.outcomes.items() if number)
    if result.missed and count.met < count.cases:
        yield "the first of the whole sweep:"
        yield from (f"{case.id}: {case.outcome}, {case.reason}" for case in result.missed)


MOST_ANNOTATED: Final = 10
"""GitHub shows ten annotations of one kind per step."""


def sweep_annotations(result: SweepResult, file: str) -> Iterator[str]:
    """Yield an `::error` for each of the worst cases that are not met, and a `::notice` with the counts."""
    missed = [case for case in notable_cases(result) if not case.met]
    for case in missed[:MOST_ANNOTATED]:
        yield annotation(file, f"{case.word} {case.id}", case.why)
    title = f"uictest sweep {result.name}"
    yield annotation(file, title, sweep_tally(result), level="notice")

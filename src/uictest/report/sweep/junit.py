"""JUnit of a sweep: one testcase per value of its first parameter, never one per case."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.judging import evaluation
from uictest.report.junit import suite_properties, test_properties
from uictest.report.sweep.result import OutcomeCount, SweepResult


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

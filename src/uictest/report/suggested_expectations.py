"""The lines of a scenario that expect what a run came to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from uictest.judging import evaluation
from uictest.plans.scenario import Expectation
from uictest.report.escaping import printable


def expectation_lines(results: Iterable[evaluation.CaseResult]) -> Iterator[str]:
    """Yield for each scenario the line to paste, once where all of its cases come to the same."""
    files: dict[str, dict[str, str]] = {}
    for result in results:
        files.setdefault(result.scenario, {})[result.id] = _line(result)
    for file, lines in files.items():
        alike = len(set(lines.values())) == 1
        for case_id, line in list(lines.items())[: 1 if alike else None]:
            yield printable(f"# {file}{'' if alike else f': {case_id}'}")
            yield line


def _line(result: evaluation.CaseResult) -> str:
    if (expect := suggested(result)) is None:
        return printable(f"# nothing to expect: {result.outcome}: {result.reason}")
    names = [f"{key}: [{', '.join(own)}]" for key in ("fail", "invalid") if (own := getattr(expect, key))]
    return f"expect: {{{', '.join(names)}}}" if names else f"expect: {expect.outcome}"


def suggested(result: evaluation.CaseResult) -> Expectation | None:
    """Return the expectation that a case meets, by name; None where nothing of the kind can be expected."""
    expect = Expectation(result.outcome) if result.outcome in ("pass", "skipped") else _missed(result)
    return expect if replace(result, expect=expect).as_expected else None


def _missed(result: evaluation.CaseResult) -> Expectation:
    stops = [stop.decided for stop in result.repeats.stops] if result.repeats else [result.decided]
    missed = dict.fromkeys(each.id for own in stops for each in evaluation.missed_requirements(own))
    no_test = dict.fromkeys(
        each.id
        for own in stops
        for each in evaluation.why_no_test(own)
        if each.layer == "validity" and each.status == "fail"
    )
    return Expectation("fail" if missed else "invalid", tuple(missed), tuple(no_test))

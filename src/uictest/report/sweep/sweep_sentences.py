"""The result of a sweep in words, the same in every format; its notable cases; what a CI server is told."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.judging import evaluation
from uictest.report.case_conditions import deviation_text
from uictest.report.ci_server import annotation, program_properties, test_properties
from uictest.report.sweep.result import (
    Circumstances,
    Flip,
    OutcomeCount,
    SurveyStep,
    SweepDomain,
    SweepResult,
)
from uictest.report.sweep.values import DrawnInterval, SweptValue, range_label
from uictest.report.verdict_sentences import counts_text, explanation
from uictest.report.words import argument, counted, outcome_word, percent, printable, result_word

_MOST_LISTED: Final = 3
"""Values that are listed rather than counted; chosen."""
_MOST_CONDITIONS: Final = 6
"""Conditions outside of what was validated that a note lists before the rest is counted; chosen."""
_LEAST_BIAS: Final = 1e-4
"""Share below which biases of the survey step are only counted; chosen."""
MOST_ANNOTATED: Final = 10
"""GitHub shows ten annotations of one kind per step."""


def sweep_tally(result: SweepResult) -> str:
    """Return the counts of a sweep, e.g. `75 cases: 70 pass, 4 fail, 1 error; 5 not as expected`."""
    return f"{counted(result.cases, 'case')}: {counts_text(result.outcomes, result.cases - result.met)}"


def command_alone(manifest: Mapping[str, Any]) -> str:
    """Return the command that runs one `CASE` of a sweep alone, as the sweep did."""
    file = argument(str(manifest.get("file", "FILE")))
    words = [word for text in manifest.get("set") or () for word in ("--set", str(text))]
    if (seed := manifest.get("seed")) is not None:
        words += ["--seed", str(seed)]
    # A folder holds the chunks of one selection: not the sweep's own folder, nor that of another case.
    options = f"{shlex.join(words)} " if words else ""
    return f"uictest sweep {file} {options}-k 'CASE' -o 'alone/CASE'"


def swept_words(values: Sequence[SweptValue]) -> str:
    """Return the values of a parameter in words, e.g. `0.02 .. 0.16 (15 values)`."""
    if values and all(isinstance(value, DrawnInterval) for value in values):
        return f"{range_label(values)}, drawn"
    if len(values) <= _MOST_LISTED:
        return ", ".join(value.label for value in values)
    if len({value.unit for value in values}) == 1 and all(value.number is not None for value in values):
        return range_label(sorted(values, key=lambda value: value.number or 0.0))
    # Texts, and numbers of several units, have no ends.
    return f"{', '.join(value.label for value in values[:_MOST_LISTED])}, … ({len(values)} values)"


def share_words(met: int, cases: int) -> str:
    """Return the share met in percent; `100` and `0` only where no case is an exception."""
    return str(_rounded_share(100, met, cases)) if cases else "-"


def bar(met: int, cases: int) -> str:
    """Return the share met as ten blocks, full and empty; all or none only where no case is an exception."""
    full = _rounded_share(10, met, cases) if cases else 0
    return full * "█" + (10 - full) * "░" if cases else ""


def _rounded_share(whole: int, met: int, cases: int) -> int:
    share = round(whole * met / cases)
    # One case of a thousand that misses must be seen.
    return share if met in (0, cases) else min(max(share, 1), whole - 1)


def circumstances_words(circumstances: Circumstances) -> str:
    """Return the values of the other parameters at which something was found."""
    return ", ".join(f"{key} = {value.text}" for key, value in circumstances.items()) or "all cases"


def flip_words(flip: Flip) -> str:
    """Return the values between which a verdict flips, e.g. `met up to 0.10, not met from 0.11`."""
    before, after = ("met", "not met") if flip.met_at_low else ("not met", "met")
    return f"{before} up to {flip.low.text}, {after} from {flip.high.text}"


@dataclass(frozen=True, slots=True)
class NotableCase:
    """A case of a sweep as one line of a report.

    Args:
        id: id of the case.
        met: whether the case met its expectation.
        label: verdict for readers, one of `CASE_WORDS`.
        outcome: outcome of the case.
        reason: why the case is not met; empty where it is.
        distance: braking distance, m.
        margin: narrowest margin over its bound, %.
        criterion: id of the criterion with this margin.
    """

    id: str
    met: bool
    label: str
    outcome: str
    reason: str
    distance: float | None = None
    margin: float | None = None
    criterion: str = ""


def notable_cases(result: SweepResult) -> list[NotableCase]:
    """Return the worst cases and the first missed ones, each once, missed cases first."""
    cases = []
    for case in result.worst:
        margin, criterion = evaluation.narrowest_margin(case)
        cases.append(
            NotableCase(
                *(case.id, case.met, result_word(case), case.outcome),
                reason="" if case.met else "; ".join(explanation(case)),
                distance=(case.measures or {}).get("braking_distance_m"),
                margin=None if margin is None else 100.0 * margin,
                criterion=criterion,
            )
        )
    listed_ids = {case.id for case in result.worst}
    for missed in result.missed:
        if missed.id not in listed_ids:
            reason = printable(": ".join(filter(None, (f"got {missed.outcome}", missed.reason))))
            label = outcome_word(missed.outcome, met=False)
            cases.append(NotableCase(missed.id, False, label, missed.outcome, reason))
    return sorted(cases, key=lambda case: case.met)


def sweep_suite(result: SweepResult, file: str, *, with_properties: bool = False) -> Suite:
    """Return the counts of a sweep as testcases; `file` is the sweep file as shown to users."""
    parameter, counts = next(iter(result.rates.items()))
    named = test_properties(result.test_case, result.requirements) if with_properties else {}
    testcases = []
    for count in counts:
        status = _testcase_status(count)
        lines = [] if status == "passed" else list(_missed_lines(result, count))
        name = f"{result.name}[{parameter}={count.value.label}]"
        testcases.append(Testcase(class_name(file), name, status, lines, properties=named))
    program = evaluation.program_in(result.base)
    controller = program_properties(program) if program is not None else {}
    return Suite(
        result.name, testcases, properties=controller | {"requirements": ",".join(result.requirements)}
    )


def _testcase_status(count: OutcomeCount) -> TestcaseStatus:
    if count.cases == 0 or count.outcomes["skipped"] == count.cases == count.met:
        return "skipped"
    if count.outcomes["error"]:
        return "error"
    return "failure" if count.met < count.cases else "passed"


def _missed_lines(result: SweepResult, count: OutcomeCount) -> Iterator[str]:
    yield f"{count.cases - count.met} of {count.cases} cases did not meet their expectation"
    yield ", ".join(f"{name}: {number}" for name, number in count.outcomes.items() if number)
    if result.missed and count.met < count.cases:
        yield "the first of the whole sweep:"
        yield from (f"{case.id}: {case.outcome}, {case.reason}" for case in result.missed)


def sweep_annotations(result: SweepResult, file: str) -> Iterator[str]:
    """Yield an `::error` for each of the worst cases that are not met, and a `::notice` with the counts."""
    missed = [case for case in notable_cases(result) if not case.met]
    for case in missed[:MOST_ANNOTATED]:
        yield annotation(file, f"{case.label} {case.id}", case.reason)
    yield annotation(file, f"uictest sweep {result.name}", sweep_tally(result), level="notice")


def domain_notes(domain: SweepDomain | None, cases: int) -> Iterator[str]:
    """Yield the number of `cases` outside of what was validated, with the conditions; else nothing."""
    if domain is None:
        return
    among = f"{domain.outside} of {counted(cases, 'case')} outside of what {domain.validation} validated"
    first = domain.conditions[:_MOST_CONDITIONS]
    listed = [f"{deviation_text(condition.deviation)} in {condition.cases}" for condition in first]
    not_listed = len(domain.conditions) - len(listed)
    remainder = f"; {counted(not_listed, 'more condition')} in results.json" if not_listed else ""
    yield f"{among}: {'; '.join(listed)}{remainder}" if listed else among


def survey_notes(survey: SurveyStep | None, cases: int) -> Iterator[str]:
    """Yield the number of cases that were repeated in regular steps, and the bias of each measure."""
    if survey is None:
        return
    begin = f"survey in steps of {survey.time_step}, which"
    if survey.repeated:
        repeated = f"these were repeated in steps of {survey.regular_step}"
        yield f"{begin} could not settle {survey.repeated} of {counted(cases, 'case')}: {repeated}"
    else:
        yield f"{begin} settled all of {counted(cases, 'case')}"
    if survey.unknown:
        yield f"bias of the survey step: not known of {', '.join(survey.unknown)}"
    noted = [bias for bias in survey.biases if bias.bias >= _LEAST_BIAS]
    for bias in noted:
        on_average = f"at most {_percent_text(bias.bias)} on average ({bias.case})"
        of_stops = f"{_percent_text(bias.of_single_stops)} in 95 % of single stops"
        yield f"bias of the survey step: {bias.measure} {on_average}, {of_stops}"
    if others := len(survey.biases) - len(noted):
        below = f"below {_percent_text(_LEAST_BIAS)} in {counted(others, 'other measure')} judged or mapped"
        yield f"bias of the survey step: {below}"


def _percent_text(share: float) -> str:
    return percent(share, 2) if share < 1.0 else f"{100.0 * share:.0f} %"

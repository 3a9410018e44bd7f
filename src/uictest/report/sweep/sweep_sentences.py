"""The result of a sweep in words, the same in every format; its notable cases; what a CI server is told."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, Final

from uictest.core.document import Block, Suite, Testcase, TestcaseStatus, Tone, class_name
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
from uictest.report.verdict_sentences import (
    MISSES,
    MissKind,
    counts_text,
    decisive_verdicts,
    miss_kind,
    missed_sentence,
)
from uictest.report.words import argument, counted, listed, percent, printable

_MOST_LISTED: Final = 3
"""Values that are listed rather than counted; chosen."""
_MOST_CONDITIONS: Final = 6
"""Conditions outside of what was validated that a note lists before the rest is counted; chosen."""
_LEAST_BIAS: Final = 1e-4
"""Share below which biases of the survey step are only counted; chosen."""


def sweep_tally(result: SweepResult) -> str:
    """Return the counts of a sweep, e.g. `75 cases: 70 pass, 4 fail, 1 error; 5 not as expected`."""
    return f"{counted(result.cases, 'case')}: {counts_text(result.outcomes, result.cases - result.met)}"


OUTCOME_HEADINGS: Final = {"inconclusive": "no data", "skipped": "not judged"}
"""What a column of counts is called, where not by its outcome."""
_OUTCOMES: Final[tuple[evaluation.Outcome, ...]] = (
    *("error", "fail", "invalid", "inconclusive", "skipped", "pass"),
)
"""Outcomes of cases that are not as expected, in the order in which they are read."""
_MOST_CRITERIA: Final = 3
"""Criteria that a block names of its worst case; chosen."""


def where_met(result: SweepResult) -> str:
    """Return where the cases are as expected, by the parameter that decides most.

    E.g. `11 of 24 cases as expected, by rail.friction: all at 0.12, 0.14; none at 0.03 .. 0.08 (4 values)`.
    """
    begin = f"{result.met} of {counted(result.cases, 'case')} as expected"
    if result.met in (0, result.cases):
        return begin
    rates = {key: [count for count in counts if count.cases] for key, counts in result.rates.items()}
    shares = {key: [_share_word(count) for count in counts] for key, counts in rates.items()}
    key = max(shares, key=lambda key: sum(word != "in part" for word in shares[key]) / len(shares[key]))
    counts, words = rates[key], shares[key]
    if set(words) == {"in part"}:
        return f"{begin}; no value of {listed(list(shares))} decides alone"
    found = [
        f"{word} at {_values_where(counts, [own == word for own in words])}"
        for word in ("all", "in part", "none")
        if word in words
    ]
    return f"{begin}, by {key}: {'; '.join(found)}"


def _share_word(count: OutcomeCount) -> str:
    return "all" if count.met == count.cases else "in part" if count.met else "none"


def _values_where(counts: Sequence[OutcomeCount], holds: Sequence[bool]) -> str:
    """Return the values at which something holds, neighbours as a range: `0.03 .. 0.06 (3 values), 0.2`."""
    runs = groupby(zip(counts, holds, strict=True), key=lambda pair: pair[1])
    return ", ".join(swept_words([count.value for count, _ in run]) for held, run in runs if held)


def missed_blocks(result: SweepResult, manifest: Mapping[str, Any]) -> list[tuple[Block, str]]:
    """Return what is not as expected, by outcome: how many cases, where, the worst, how to run it again.

    Beside each stands the id of that case, empty where none is known.
    """
    blocks = []
    for outcome, count in _missed_counts(result).items():
        if count > 0:
            name, line = _example(result, outcome)
            one, several = MISSES[_kind(result, outcome)]
            words = f"{counted(count, 'case')} {one if count == 1 else several}"
            heading = f"{words}{_where(result, outcome)}"
            command = command_alone(manifest, name) if name else ""
            tone: Tone = "odd" if outcome == "error" else "bad"
            blocks.append((Block(heading, [line] if line else [], command, tone), name))
    return blocks


def _missed_counts(result: SweepResult) -> dict[evaluation.Outcome, int]:
    """Return how many cases are not as expected, by outcome: all cases of a sweep expect the same."""
    expected = next((case.expect.outcome for case in result.worst), "pass")
    missed = result.cases - result.met
    counts = {name: min(result.outcomes.get(name, 0), missed) for name in _OUTCOMES if name != expected}
    return {name: counts.get(name, missed - sum(counts.values())) for name in _OUTCOMES}


def _kind(result: SweepResult, outcome: evaluation.Outcome) -> MissKind:
    """Return in what way the cases of an outcome are not as expected."""
    for case in result.worst:
        if case.outcome == outcome and case.as_expected and not case.met:  # something in it is open
            return miss_kind(case)
    return "unexpected" if outcome == "pass" else outcome


def _example(result: SweepResult, outcome: str) -> tuple[str, str]:
    """Return the id of the worst case of an outcome, or of the first known one, and what it misses."""
    for case in result.worst:
        if case.outcome == outcome and not case.met:
            verdicts = decisive_verdicts(case)[:_MOST_CRITERIA]
            misses = "; ".join(map(missed_sentence, verdicts)) or case.reason
            return case.id, printable(f"worst {case.id}{misses and f': {misses}'}")
    for missed in result.missed:
        if missed.outcome == outcome:
            return missed.id, printable(f"first {missed.id}{missed.reason and f': {missed.reason}'}")
    return "", ""


def _where(result: SweepResult, outcome: str) -> str:
    """Return the values of parameters, besides which an outcome does not occur: `: friction 0.02, 0.03`."""
    wheres = []
    for key, counts in result.rates.items():
        holds = [bool(count.outcomes.get(outcome)) for count in counts]
        if sum(holds) < sum(count.cases > 0 for count in counts):
            wheres.append(f"{key} {_values_where(counts, holds)}")
    return f": {', '.join(wheres)}" if wheres else ""


def command_alone(manifest: Mapping[str, Any], case: str = "CASE") -> str:
    """Return the command that runs one case of a sweep alone, as the sweep did."""
    file = argument(str(manifest.get("file", "FILE")))
    words = [word for text in manifest.get("set") or () for word in ("--set", str(text))]
    if (seed := manifest.get("seed")) is not None:
        words += ["--seed", str(seed)]
    # A folder holds the chunks of one selection: not the sweep's own folder, nor that of another case.
    options = f"{shlex.join(words)} " if words else ""
    return f"uictest sweep {file} {options}-k '{printable(case)}' -o 'alone/{printable(case)}'"


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


def sweep_annotations(result: SweepResult, manifest: Mapping[str, Any]) -> Iterator[str]:
    """Yield an `::error` for what is not as expected, by outcome, and a `::notice` with the counts."""
    file = str(manifest.get("file", ""))
    for block, _ in missed_blocks(result, manifest):
        yield annotation(file, block.heading, "; ".join([*block.lines, block.command]))
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

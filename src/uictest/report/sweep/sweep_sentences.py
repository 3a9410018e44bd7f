"""The result of a sweep in words, the same in every format; its notable cases; what a CI server is told."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from uictest.core.document import Suite, Testcase, TestcaseStatus, class_name
from uictest.core.measures import column_unit
from uictest.judging import evaluation
from uictest.report.case_words import outcome_word, result_word
from uictest.report.counts import counted
from uictest.report.escaping import argument, printable
from uictest.report.github import annotation
from uictest.report.junit import suite_properties, test_properties
from uictest.report.measure_heading import measure_heading
from uictest.report.sweep.result import Circumstances, Flip, MissedCase, OutcomeCount, SweepResult
from uictest.report.sweep.values import DrawnInterval, SweptValue, range_label
from uictest.report.verdict_sentences import counts_text, explanation

_MOST_LISTED = 3  # values that are listed rather than counted


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
    if not cases:
        return "–"  # noqa: RUF001 - a dash on paper
    return str(_rounded_share(100, met, cases))


def bar(met: int, cases: int) -> str:
    """Return the share met as ten blocks, full and empty; all or none only where no case is an exception."""
    if not cases:
        return ""
    full = _rounded_share(10, met, cases)
    return full * "█" + (10 - full) * "░"


def circumstances_words(circumstances: Circumstances) -> str:
    """Return the values of the other parameters at which something was found."""
    return ", ".join(f"{key} = {value.text}" for key, value in circumstances.items()) or "all cases"


def measure_words(column: str) -> str:
    """Return the name of a column of measures for readers, e.g. `braking distance, m`."""
    words, unit = measure_heading(column).words, column_unit(column)
    return words if unit == "1" else f"{words}, {unit}"


def flip_words(flip: Flip) -> str:
    """Return where a verdict flips, e.g. `met up to 0.10, not met from 0.11`."""
    before, after = ("met", "not met") if flip.met_at_low else ("not met", "met")
    return f"{before} up to {flip.low.text}, {after} from {flip.high.text}"


def _rounded_share(whole: int, met: int, cases: int) -> int:
    share = round(whole * met / cases)
    # One case of a thousand that misses must be seen.
    return share if met in (0, cases) else min(max(share, 1), whole - 1)


@dataclass(frozen=True, slots=True)
class NotableCase:
    """A case as one line of a report; `why` is empty where it was met."""

    id: str
    met: bool
    word: str
    outcome: str
    why: str
    distance: float | None = None
    """Braking distance, m."""
    margin: float | None = None
    """Narrowest margin over its bound, %, and the criterion that has it."""
    criterion: str = ""


def notable_cases(result: SweepResult) -> list[NotableCase]:
    """Return the worst cases and the first missed ones, each once, missed cases first."""
    worst = [_from_result(case) for case in result.worst]
    known = {case.id for case in worst}
    others = [_from_missed(case) for case in result.missed if case.id not in known]
    return sorted([*worst, *others], key=lambda case: case.met)


def _from_result(result: evaluation.CaseResult) -> NotableCase:
    why = "" if result.met else "; ".join(explanation(result))
    distance = (result.measures or {}).get("braking_distance_m")
    margin, criterion = evaluation.narrowest_margin(result)
    share = None if margin is None else 100.0 * margin
    word = result_word(result)
    return NotableCase(result.id, result.met, word, result.outcome, why, distance, share, criterion)


def _from_missed(case: MissedCase) -> NotableCase:
    """Return a case of which only outcome and reason are known."""
    why = printable(": ".join(text for text in (f"got {case.outcome}", case.reason) if text))
    return NotableCase(case.id, False, outcome_word(case.outcome, met=False), case.outcome, why)


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

"""How results and verdicts are put into words, the same in every format."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import Final

from uictest.core.document import Tone
from uictest.core.measures import MEASURES
from uictest.judging import evaluation
from uictest.report.causes import cause_sentences
from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.firmness_sentences import firmness_sentences
from uictest.report.repeat_wording import repeat_sentences

DIFFERS: Final = "differs"
"""The word for a case that meets its expectation and differs from the baseline."""

UNSETTLED: Final = "unsettled"
"""The word for what has its expected outcome, but not every verdict settled, where that was asked for."""

_AS_EXPECTED: Final = ("pass", "expected fail", "expected invalid", "skipped")
_NOT_AS_EXPECTED: Final = (
    *("fail", "invalid", "inconclusive", UNSETTLED, "unexpected pass", "unexpected skip", "error"),
)

CASE_WORDS: Final = (*_AS_EXPECTED, *_NOT_AS_EXPECTED, DIFFERS)
"""Words for cases, by outcome and expectation, in the order in which they are counted."""

_NAMED = 3
"""Names that a list shows before it counts the rest."""


def number(value: float | None) -> str:
    """Return a number with five significant digits, `-` where there is none (None or NaN)."""
    return "-" if value is None or value != value else f"{value:.5g}"


def quantity(value: float | None, unit: str) -> str:
    """Return a number with its unit; the unit 1 of a pure number is left out."""
    return number(value) if value is None or unit in ("", "1") else f"{number(value)} {unit}"


def limits(verdict: evaluation.Verdict, word: str = "limits ") -> str:
    """Return the limits of a criterion, e.g. `limits 440 .. 490 m`, `lower limit 35 %`, `no limit`.

    `word` stands before a pair of limits.
    """
    if verdict.lower is not None and verdict.upper is not None:
        return f"{word}{number(verdict.lower)} .. {quantity(verdict.upper, verdict.unit)}"
    if verdict.lower is not None:
        return f"lower limit {quantity(verdict.lower, verdict.unit)}"
    if verdict.upper is not None:
        return f"upper limit {quantity(verdict.upper, verdict.unit)}"
    return "no limit"


def margin_text(verdict: evaluation.Verdict) -> str:
    """Return the margin of a criterion; of a share in points, as per cent are those of its limit."""
    return quantity(verdict.margin, "points" if verdict.unit == "%" else verdict.unit)


def value_and_limits(verdict: evaluation.Verdict, word: str = "limits ") -> str:
    """Return the value of a criterion next to its limits, e.g. `0 % of the time, lower limit 35 %`."""
    measure = MEASURES.get(verdict.measure)
    of = f" {measure.share_of}" if measure is not None and measure.share_of else ""
    return f"{quantity(verdict.value, verdict.unit)}{of}, {limits(verdict, word)}"


MOST_URGENT: Final = ("fail", "inconclusive", "pass", "not_applicable")
"""Statuses of criteria in the order in which people read them."""


def failing_first(verdicts: Iterable[evaluation.Verdict]) -> list[evaluation.Verdict]:
    """Return verdicts with the failing ones first, then the inconclusive ones, then those that passed."""
    return sorted(verdicts, key=lambda verdict: MOST_URGENT.index(verdict.status))


def without_rig_that_holds(verdicts: Iterable[evaluation.Verdict]) -> list[evaluation.Verdict]:
    """Return verdicts without the checks of the rig that hold: for people, one sentence says that they do."""
    return [each for each in verdicts if each.layer != "rig" or each.status not in ("pass", "not_applicable")]


def rig_sentence(verdicts: Iterable[evaluation.Verdict]) -> str:
    """Return how many checks of the rig hold, of those that apply; empty where there are none."""
    checks = [each for each in verdicts if each.layer == "rig" and each.status != "not_applicable"]
    held = sum(each.status == "pass" for each in checks)
    if not checks:
        return ""
    return f"checks of the rig: {'all' if held == len(checks) else f'{held} of {len(checks)}'} hold"


def missed_by_text(verdict: evaluation.Verdict, wheelsets: int) -> str:
    """Return which of so many wheelsets miss a criterion: `all 4 wheelsets`, `wheelset 3 only`."""
    if len(verdict.missed_by) == wheelsets:
        return f"all {wheelsets} wheelsets" if wheelsets > 1 else ""
    *others, last = map(str, verdict.missed_by or ("",))
    return f"wheelsets {', '.join(others)} and {last}" if others else last and f"wheelset {last} only"


def verdict_sentence(verdict: evaluation.Verdict) -> str:
    """Return the verdict of a criterion on one line, with the reason, or with value, limits and margin."""
    reason = verdict.reason or f"{value_and_limits(verdict)}, margin {margin_text(verdict)}"
    return printable(f"{verdict.id} ({verdict.layer}) {verdict.status.replace('_', ' ')}: {reason}")


def definition_sentence(verdict: evaluation.Verdict) -> str:
    """Return the definitions that a verdict depends on, e.g. `first_phase_duration = 3 s`."""
    return printable(", ".join(f"{name} = {text}" for name, text in verdict.definition.items()))


def explanation(result: evaluation.CaseResult, instants: Mapping[str, str] | None = None) -> list[str]:
    """Return the reasons for an outcome: expectation, causes, reason, each criterion that decided it.

    `instants` says when the values of criteria, by their ids, were taken.
    """
    deciding = {verdict.id: verdict_sentence(verdict) for verdict in _deciding(result)}
    # With criteria the reason of a result repeats theirs, unless one stop of several ended in an error;
    # without any it is all there is.
    alone = not deciding or result.outcome == "error"
    reason = [printable(result.reason)] if result.reason and alone else []
    own_outcome, verdicts = evaluation.deciding_verdicts(result.criteria)
    if own_outcome != result.outcome:  # as over the stops of a repeated case
        verdicts = list(_deciding(result))
    names = [verdict.id for verdict in verdicts if verdict.status in ("fail", "inconclusive")]
    is_unsettled = bool(result.unsettled) or result.lacks_firmness
    outcome = outcome_sentence(result.outcome, result.expect, names, unsettled=is_unsettled)
    unsettled = [line for line in unsettled_sentences(result.unsettled) if line not in deciding.values()]
    unsettled += firmness_sentences(result) if result.lacks_firmness else ()
    known = instants or {}
    lines = [
        f"{line} (taken at {at})" if (at := known.get(name)) else line for name, line in deciding.items()
    ]
    return [outcome, *cause_sentences(result), *repeat_sentences(result), *reason, *lines, *unsettled]


def unsettled_sentences(verdicts: Iterable[evaluation.Verdict]) -> Iterator[str]:
    """Yield why verdicts are not settled: inconclusive, or the definitions within whose range they turn."""
    for verdict in verdicts:
        if verdict.status == "inconclusive":
            yield verdict_sentence(verdict)
        for sensitivity in verdict.sensitivity:
            if sensitivity.flips:
                yield printable(f"{verdict.id} ({verdict.layer}) turns: {sensitivity}")


def outcome_sentence(outcome: str, expected: str, deciding: Sequence[str], *, unsettled: bool = False) -> str:
    """Return the outcome with the criteria that decided it: `fail: locked-wheels. Expected: pass`."""
    by = printable(", ".join(deciding))
    shown = f"{outcome}{', unsettled' if unsettled else ''}{f': {by}' if by else ''}"
    return (
        f"{shown} (as expected)"
        if outcome == expected and not unsettled
        else f"{shown}. Expected: {expected}"
    )


def criterion_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield the verdict of each criterion, failing ones first, and how sensitive it is to definitions."""
    for verdict in failing_first(without_rig_that_holds(result.criteria)):
        yield verdict_sentence(verdict)
        for sensitivity in verdict.sensitivity:
            yield printable(f"{verdict.id}: {sensitivity}")
        for reading, sentence in zip(verdict.readings, reading_sentences(verdict), strict=True):
            yield printable(f"{verdict.id} read as {sentence}")
            for sensitivity in reading.sensitivity:
                yield printable(f"{verdict.id} read as {reading.id}: {sensitivity}")
    if checks := rig_sentence(result.criteria):
        yield checks


def reading_sentences(verdict: evaluation.Verdict) -> list[str]:
    """Return what a criterion says by each of its readings, e.g. `depth fail: 14.2 % (above 30 km/h) ...`."""
    return [
        printable(
            f"{each.id}{' (decides)' if each.decides else ''} {each.status.replace('_', ' ')}: "
            f"{each.reason or quantity(each.value, each.unit)}"
        )
        for each in verdict.readings
    ]


def reading_sources(verdict: evaluation.Verdict) -> dict[str, str]:
    """Return where each further reading of a criterion comes from, and its definitions."""
    return {
        printable(each.id): printable(
            f"{each.mark}: {each.source or 'no source'}, "
            + ", ".join(f"{name} = {text}" for name, text in each.definition.items())
        )
        for each in verdict.readings
        if not each.decides
    }


def real_time_sentences(result: evaluation.CaseResult) -> list[str]:
    """Return how the controller answered in a stop that was paced by the clock, nothing for others."""
    times = result.response_times
    if times is None:
        return []
    seconds = times.cycle_time_s, times.longest_answer_s, times.start_jitter_s
    cycle, longest, jitter = (f"{1e3 * time:.3g} ms" for time in seconds)
    missed = f"{times.missed_deadlines} of {counted(times.answers, 'answer')}"
    answers = f"{missed} after the end of their cycle of {cycle}"
    worst = f"longest answer {longest} (cycle {times.longest_answer_cycle})"
    return [f"in real time: {answers}, {worst}, start of a cycle at most {jitter} late"]


def _deciding(result: evaluation.CaseResult) -> Iterator[evaluation.Verdict]:
    for verdict in result.criteria:
        decides = verdict.status == "inconclusive" and result.outcome == "inconclusive"
        decides = verdict.layer != "rig" and (decides or result.outcome == "skipped")
        if verdict.status == "fail" or decides:
            yield verdict


def outcome_word(outcome: str, *, met: bool) -> str:
    """Return the word for an outcome that was expected, or was not.

    A case that is expected to fail, or to be invalid, and does so is an `expected fail` or `expected
    invalid`. A case that should not pass and does is an `unexpected pass`; one to which no criterion applies
    is an `unexpected skip` unless it is expected. In all other cases the word is the outcome.

    Args:
        outcome: of the case.
        met: whether the case was expected to come out so.

    """
    if met:
        return outcome if outcome in _AS_EXPECTED else f"expected {outcome}"
    return {"pass": "unexpected pass", "skipped": "unexpected skip"}.get(outcome, outcome)


def result_word(result: evaluation.CaseResult) -> str:
    """Return the word of a case of `CASE_WORDS`, without regard to a baseline."""
    if result.as_expected and not result.met:
        return UNSETTLED
    return outcome_word(result.outcome, met=result.met)


def line_word(word: str) -> str:
    """Return a word of `CASE_WORDS` without blanks: in a line for grep it is the first field."""
    return word.replace(" ", "-")


def tone(word: str) -> Tone:
    """Return the tone of a word of `CASE_WORDS`."""
    if word == "error":
        return "odd"
    return "good" if word in _AS_EXPECTED else "bad"


def tally(results: Iterable[evaluation.CaseResult], differing: Container[str] = ()) -> str:
    """Return the counts of a run, e.g. `12 cases: 9 pass, 1 expected fail, 2 fail; 2 not as expected`.

    A case that is met counts as different where its id is among those `differing` from the baseline.
    """
    results = list(results)
    if not results:
        return "no case"
    words = [DIFFERS if result.met and result.id in differing else result_word(result) for result in results]
    counts = {word: words.count(word) for word in CASE_WORDS}
    return f"{counted(len(words), 'case')}: {counts_text(counts, sum(not each.met for each in results))}"


def counts_text(counts: Mapping[str, int], not_met: int) -> str:
    """Return counts of cases by word, those of none left out, and how many do not meet their expectation."""
    labels = {DIFFERS: "different from the baseline"}
    shown = ", ".join(f"{count} {labels.get(word, word)}" for word, count in counts.items() if count)
    return f"{shown}; {not_met} not as expected" if not_met else shown


def listed(names: Sequence[str]) -> str:
    """Return the first names, and how many more there are."""
    more = len(names) - _NAMED
    shown = ", ".join(map(printable, names[:_NAMED]))
    return f"{shown} and {more} more" if more > 0 else shown

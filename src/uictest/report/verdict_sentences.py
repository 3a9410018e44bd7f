"""How results and verdicts are put into words, the same in every format."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from uictest.core.measures import MEASURES
from uictest.judging import evaluation
from uictest.report.case_words import ALLOWED, CASE_WORDS, DIFFERS, result_word
from uictest.report.causes import cause_sentences
from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.firmness_sentences import firmness_sentences
from uictest.report.repeat_wording import repeat_sentences

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

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


def without_checks_that_hold(verdicts: Iterable[evaluation.Verdict]) -> list[evaluation.Verdict]:
    """Return verdicts without the checks that hold: for people, one sentence says that they do."""
    return [each for each in verdicts if not each.is_check or each.status not in ("pass", "not_applicable")]


def check_sentence(verdicts: Iterable[evaluation.Verdict]) -> str:
    """Return how many checks of the rig or of the record hold, and of the latter which could not be made."""
    verdicts = [each for each in verdicts if each.is_check]
    checks = [each for each in verdicts if each.status != "not_applicable"]
    held = sum(each.status == "pass" for each in checks)
    if not checks:
        return ""
    layer, other = checks[0].layer, len(verdicts) - len(checks)
    missing = f", {other} not made" if layer == "record" and other else ""
    return (
        f"checks of the {layer}: {'all' if held == len(checks) else f'{held} of {len(checks)}'} hold{missing}"
    )


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
    deciding = {
        verdict.id: verdict_sentence(verdict)
        for verdict in sorted(_deciding(result), key=lambda verdict: not verdict.is_check)
    }
    # With criteria the reason of a result repeats theirs, unless one stop of several ended in an error;
    # without any it is all there is.
    alone = not deciding or result.outcome == "error"
    reason = [printable(result.reason)] if result.reason and alone else []
    own_outcome, verdicts = evaluation.deciding_verdicts(result.decided)
    if own_outcome != result.outcome:  # as over the stops of a repeated case
        verdicts = list(_deciding(result))
    known = instants or {}
    named = [
        missed_sentence(verdict, known.get(verdict.id, ""))
        for verdict in verdicts
        if verdict.status in ("fail", "inconclusive")
    ]
    outcome = outcome_sentence(result, named)
    unsettled = [line for line in unsettled_sentences(result.unsettled) if line not in deciding.values()]
    unsettled += firmness_sentences(result) if result.lacks_firmness else ()
    lines = [
        f"{line} (taken at {at})" if (at := known.get(name)) else line for name, line in deciding.items()
    ]
    statements = [statement_sentence(result)] if result.criteria else []
    return [
        *(outcome, *statements, *cause_sentences(result), *repeat_sentences(result)),
        *(*reason, *lines, *unsettled),
    ]


def missed_sentence(verdict: evaluation.Verdict, at: str = "") -> str:
    """Return what is missed, by which value, against which limit: `locked-wheels 62 s, upper limit 1 s`.

    `at` says when the value was taken.
    """
    if verdict.value is None or verdict.status != "fail":
        return printable(verdict.id)
    return printable(f"{verdict.id} {value_and_limits(verdict)}{f', at {at}' if at else ''}")


def statement_sentence(result: evaluation.CaseResult) -> str:
    """Return the two statements on a stop: whether it is a test, and whether requirements are met."""
    missed = [each for each in result.criteria if each.status == "fail"]
    no_test = ", ".join(each.id for each in missed if each.layer != "requirement")
    failed = ", ".join(each.id for each in missed if each.layer == "requirement")
    validity, requirements = (
        each.replace("_", " ") for each in (result.test_validity, result.requirement_status)
    )
    if result.rail is not None and result.rail.decides:
        no_test = f"as measured; of the rail, which decides: {result.rail.test_validity.replace('_', ' ')}"
    return printable(
        f"test validity: {validity}{f' ({no_test})' if no_test else ''};"
        f" requirements: {requirements}{f' ({failed})' if failed else ''}"
    )


def allowed_sentences(results: Iterable[evaluation.CaseResult]) -> Iterator[str]:
    """Yield what was missed and allowed: `allowed: low-adhesion-80: locked-wheels 62 s, upper limit 1 s`."""
    for result in results:
        if result.allowed:
            missed = "; ".join(map(missed_sentence, result.allowed))
            yield printable(f"allowed: {result.id}: {missed}")


def unsettled_sentences(verdicts: Iterable[evaluation.Verdict]) -> Iterator[str]:
    """Yield why verdicts are not settled: inconclusive, or the definitions within whose range they turn."""
    for verdict in verdicts:
        if verdict.status == "inconclusive":
            yield verdict_sentence(verdict)
        for sensitivity in verdict.sensitivity:
            if sensitivity.flips:
                yield printable(f"{verdict.id} ({verdict.layer}) turns: {sensitivity}")


def outcome_sentence(result: evaluation.CaseResult | SeriesResult, deciding: Sequence[str]) -> str:
    """Return the outcome with what decided it: `fail: locked-wheels 2 s, upper limit 1 s. Expected: pass`."""
    by = printable("; ".join(deciding))
    unsettled = bool(result.unsettled) or result.lacks_firmness
    shown = f"{result.outcome}{', unsettled' if unsettled else ''}{f': {by}' if by else ''}"
    expected = printable(str(result.expect))
    if result.met:
        return f"{shown} ({'allowed' if result_word(result) in ALLOWED else 'as expected'})"
    if result.as_expected and not unsettled:
        lacks = "names no criterion" if result.expect.lacks_names else "is an allowance"
        return f"{shown}. Strict, and the expectation {lacks}: {expected}"
    return f"{shown}. Expected: {expected}"


def criterion_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield the verdict of each criterion, failing ones first, and how sensitive it is to definitions."""
    for verdict in failing_first(without_checks_that_hold(result.criteria)):
        yield verdict_sentence(verdict)
        for sensitivity in verdict.sensitivity:
            yield printable(f"{verdict.id}: {sensitivity}")
        for reading, sentence in zip(verdict.readings, reading_sentences(verdict), strict=True):
            yield printable(f"{verdict.id} read as {sentence}")
            for sensitivity in reading.sensitivity:
                yield printable(f"{verdict.id} read as {reading.id}: {sensitivity}")
    if checks := check_sentence(result.criteria):
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
        decides = not verdict.is_check and (decides or result.outcome == "skipped")
        if verdict.status == "fail" or decides:
            yield verdict


def tally(results: Iterable[evaluation.CaseResult], differing: Container[str] = ()) -> str:
    """Return the counts of a run, e.g. `12 cases: 9 pass, 1 expected fail, 2 fail; 2 not as expected`.

    A case that is met counts as different where its id is among those `differing` from the baseline.
    """
    results = list(results)
    if not results:
        return "no case"
    words = [DIFFERS if result.met and result.id in differing else result_word(result) for result in results]
    counts = {word: words.count(word) for word in CASE_WORDS}
    counted_words = counts_text(counts, sum(not each.met for each in results))
    allowed = list(allowed_sentences(results))
    more = [f"{len(allowed) - _NAMED} more allowed"] if len(allowed) > _NAMED else []
    return "; ".join([f"{counted(len(words), 'case')}: {counted_words}", *allowed[:_NAMED], *more])


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

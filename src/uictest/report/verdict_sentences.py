"""How results and verdicts are put into words, the same in every format; and why a stop came out so."""

from __future__ import annotations

import re
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, Literal

from uictest.core.measures import MEASURES
from uictest.judging import evaluation
from uictest.plans.faults import FAULT_KINDS
from uictest.report.robustness import firmness_sentences, repeat_sentences
from uictest.report.words import (
    ALLOWED,
    CASE_WORDS,
    DIFFERS,
    NAMED,
    UNSETTLED,
    counted,
    number,
    printable,
    quantity,
    result_word,
)

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult


def limits(verdict: evaluation.Verdict) -> str:
    """Return the limits of a criterion, e.g. `440 .. 490 m`, `lower limit 35 %`, `no limit`."""
    if verdict.lower is not None and verdict.upper is not None:
        return f"{number(verdict.lower)} .. {quantity(verdict.upper, verdict.unit)}"
    if verdict.lower is not None:
        return f"lower limit {quantity(verdict.lower, verdict.unit)}"
    if verdict.upper is not None:
        return f"upper limit {quantity(verdict.upper, verdict.unit)}"
    return "no limit"


def value_with_limit(verdict: evaluation.Verdict, of_what: str = "") -> str:
    """Return a missed value and what it should be: `77 s (limit 1 s)`, `0 % of the time (35 % needed)`.

    `of_what` says after the value what it is a share of, where its measure does not.
    """
    measure = MEASURES.get(verdict.measure)
    of = f" {measure.share_of}" if measure is not None and measure.share_of else of_what
    value = f"{quantity(verdict.value, verdict.unit)}{of}"
    if verdict.lower is not None and verdict.upper is not None:
        return f"{value} ({number(verdict.lower)} to {quantity(verdict.upper, verdict.unit)})"
    if verdict.lower is not None:
        return f"{value} ({quantity(verdict.lower, verdict.unit)} needed)"
    return value if verdict.upper is None else f"{value} (limit {quantity(verdict.upper, verdict.unit)})"


MissKind = (
    evaluation.Outcome | Literal["check", "unexpected", "strict", "unsettled", "differs", "missing", "series"]
)
"""In what way something is not as expected: by its outcome, or by what was expected of it."""
MISSES: Final[Mapping[MissKind, tuple[str, str]]] = {
    "error": ("could not be run", "could not be run"),
    "check": ("fails a check of the rig or of the record", "fail a check of the rig or of the record"),
    "fail": ("misses requirements", "miss requirements"),
    "invalid": ("is not a valid test", "are not valid tests"),
    "inconclusive": ("lacks data for a verdict", "lack data for a verdict"),
    "skipped": ("is not judged", "are not judged"),
    "unexpected": ("should not have passed", "should not have passed"),
    "strict": ("meets an expectation that --strict refuses", "meet expectations that --strict refuses"),
    "unsettled": ("has a verdict that is not settled", "have verdicts that are not settled"),
    "differs": ("differs from the baseline", "differ from the baseline"),
    "missing": ("is in the baseline and missing here", "are in the baseline and missing here"),
    "series": ("is not as expected", "are not as expected"),
}
"""What it says of one case, and of several; the first is read first."""


def miss_kind(result: evaluation.CaseResult) -> MissKind:
    """Return in what way a case is not as expected."""
    if result.outcome == "error":
        return "error"
    if result_word(result) == UNSETTLED:
        return "unsettled"
    if result.as_expected:
        return "strict"
    if result.outcome == "pass":
        return "unexpected"
    return "check" if any(verdict.is_check for verdict in decisive_verdicts(result)) else result.outcome


def decisive_verdicts(result: evaluation.CaseResult) -> list[evaluation.Verdict]:
    """Return the verdicts that decide the outcome of a case; of a repeated one those over its stops."""
    outcome, verdicts = evaluation.deciding_verdicts(result.decided)
    return verdicts if outcome == result.outcome else list(_deciding_verdicts(result))


MOST_URGENT: Final = ("fail", "inconclusive", "pass", "not_applicable")
"""Statuses of criteria in the order in which people read them."""


def failing_first(verdicts: Iterable[evaluation.Verdict]) -> list[evaluation.Verdict]:
    """Return verdicts with the failing ones first, then the inconclusive ones, then those that passed."""
    return sorted(verdicts, key=lambda verdict: MOST_URGENT.index(verdict.status))


def without_checks_that_hold(verdicts: Iterable[evaluation.Verdict]) -> list[evaluation.Verdict]:
    """Return verdicts without the checks that hold: for people, one sentence says that they do."""
    held = ("pass", "not_applicable")
    return [verdict for verdict in verdicts if not (verdict.is_check and verdict.status in held)]


def check_sentence(verdicts: Iterable[evaluation.Verdict]) -> str:
    """Return the number of checks of the rig or of the record that hold, and that of checks not made."""
    checks = [verdict for verdict in verdicts if verdict.is_check]
    made = [verdict for verdict in checks if verdict.status != "not_applicable"]
    if not made:
        return ""
    held = sum(verdict.status == "pass" for verdict in made)
    holding = "all" if held == len(made) else f"{held} of {len(made)}"
    layer, missing = made[0].layer, len(checks) - len(made)
    not_made = f", {missing} not made" if layer == "record" and missing else ""
    return f"checks of the {layer}: {holding} hold{not_made}"


def missed_by_text(verdict: evaluation.Verdict, wheelsets: int) -> str:
    """Return the wheelsets that miss a criterion, of so many: `all 4 wheelsets`, `wheelset 3 only`."""
    if not verdict.missed_by or len(verdict.missed_by) == wheelsets == 1:
        return ""
    if len(verdict.missed_by) == wheelsets:
        return f"all {wheelsets} wheelsets"
    *others, last = map(str, verdict.missed_by)
    return f"wheelsets {', '.join(others)} and {last}" if others else f"wheelset {last} only"


def verdict_sentence(verdict: evaluation.Verdict) -> str:
    """Return the verdict of a criterion on one line, with the reason, or with value, limits and margin."""
    reason = verdict.reason or value_with_limit(verdict)
    return printable(f"{verdict.id} ({verdict.layer}) {verdict.status.replace('_', ' ')}: {reason}")


def definition_sentence(verdict: evaluation.Verdict) -> str:
    """Return the definitions that a verdict depends on, e.g. `first_phase_duration = 3 s`."""
    return printable(", ".join(f"{name} = {text}" for name, text in verdict.definition.items()))


def explanation(
    result: evaluation.CaseResult, instants: Mapping[str, str] | None = None, *, briefly: bool = False
) -> list[str]:
    """Return the reasons for an outcome: expectation, causes, reason, each criterion that decided it.

    `instants` says when the values of criteria, by their ids, were taken. `briefly` leaves out what a table
    of the criteria says.
    """
    instants = instants or {}
    deciding = sorted(_deciding_verdicts(result), key=lambda verdict: not verdict.is_check)
    lines = {verdict.id: verdict_sentence(verdict) for verdict in deciding}
    missed = [
        missed_sentence(verdict, instants.get(verdict.id, ""))
        for verdict in decisive_verdicts(result)
        if verdict.status in ("fail", "inconclusive")
    ]
    unsettled = [line for line in unsettled_sentences(result.unsettled) if line not in lines.values()]
    if result.outcome == "error" and result.reason:
        missed.insert(0, result.reason)
    return [
        outcome_sentence(result, missed),
        *([statement_sentence(result)] if result.criteria and not briefly else ()),
        *dict.fromkeys([*cause_sentences(result), *rail_sentences(result)]),
        *repeat_sentences(result),
        # With criteria the reason of a result repeats theirs; without any it is all there is.
        *([printable(result.reason)] if result.reason and not deciding and result.outcome != "error" else ()),
        *(
            f"{line} (taken at {at})" if (at := instants.get(name)) else line
            for name, line in ({} if briefly else lines).items()
        ),
        *unsettled,
        *(firmness_sentences(result) if result.lacks_firmness else ()),
    ]


def _deciding_verdicts(result: evaluation.CaseResult) -> Iterator[evaluation.Verdict]:
    """Yield the criteria that fail, and those of an undecided or skipped stop that say why it is."""
    for verdict in result.criteria:
        undecided = verdict.status == "inconclusive" and result.outcome == "inconclusive"
        if verdict.status == "fail" or (not verdict.is_check and (undecided or result.outcome == "skipped")):
            yield verdict


def missed_sentence(verdict: evaluation.Verdict, at: str = "") -> str:
    """Return a missed criterion with its value and limit: `locked-wheels 62 s (limit 1 s)`.

    `at` says when the value was taken.
    """
    if verdict.value is None or verdict.status != "fail":
        return printable(verdict.id)
    return printable(f"{verdict.id} {value_with_limit(verdict)}{f', at {at}' if at else ''}")


def statement_sentence(result: evaluation.CaseResult) -> str:
    """Return the two statements on a stop: whether it is a test, and whether requirements are met."""
    missed = [verdict for verdict in result.criteria if verdict.status == "fail"]
    no_test = ", ".join(verdict.id for verdict in missed if verdict.layer != "requirement")
    failed = ", ".join(verdict.id for verdict in missed if verdict.layer == "requirement")
    if result.rail is not None and result.rail.decides:
        no_test = f"as measured; of the rail, which decides: {result.rail.test_validity.replace('_', ' ')}"
    validity = f"{result.test_validity.replace('_', ' ')}{no_test and f' ({no_test})'}"
    requirements = f"{result.requirement_status.replace('_', ' ')}{failed and f' ({failed})'}"
    return printable(f"test validity: {validity}; requirements: {requirements}")


def allowed_sentences(results: Iterable[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the allowed misses: `allowed: low-adhesion-80: locked-wheels 62 s (limit 1 s)`."""
    for result in results:
        if result.allowed:
            missed = "; ".join(map(missed_sentence, result.allowed))
            yield printable(f"allowed: {result.id}: {missed}")


def unsettled_sentences(verdicts: Iterable[evaluation.Verdict]) -> Iterator[str]:
    """Yield the reasons for unsettled verdicts: inconclusive, or turning within the range of a definition."""
    for verdict in verdicts:
        if verdict.status == "inconclusive":
            yield verdict_sentence(verdict)
        for sensitivity in verdict.sensitivity:
            if sensitivity.flips:
                yield printable(f"{verdict.id} ({verdict.layer}) turns: {sensitivity}")


def outcome_sentence(result: evaluation.CaseResult | SeriesResult, deciding: Sequence[str]) -> str:
    """Return the outcome with what decided it: `fail: locked-wheels 2 s (limit 1 s). Expected: pass`."""
    by = printable("; ".join(deciding))
    unsettled = bool(result.unsettled) or result.lacks_firmness
    outcome = f"{result.outcome}{', unsettled' if unsettled else ''}{f': {by}' if by else ''}"
    expected = printable(str(result.expect))
    if result.met:
        return f"{outcome} ({'allowed' if result_word(result) in ALLOWED else 'as expected'})"
    if result.as_expected and not unsettled:
        lacks = "names no criterion" if result.expect.lacks_names else "is an allowance"
        return f"{outcome}. Strict, and the expectation {lacks}: {expected}"
    return f"{outcome}. Expected: {expected}"


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
    """Return the verdict by each reading of a criterion, e.g. `depth fail: 14.2 % (above 30 km/h) ...`."""
    return [
        printable(
            f"{reading.id}{' (decides)' if reading.decides else ''} {reading.status.replace('_', ' ')}: "
            f"{reading.reason or quantity(reading.value, reading.unit)}"
        )
        for reading in verdict.readings
    ]


def reading_sources(verdict: evaluation.Verdict) -> dict[str, str]:
    """Return the source and the definitions of each further reading of a criterion."""
    sources = {}
    for reading in verdict.readings:
        if not reading.decides:
            definitions = ", ".join(f"{name} = {text}" for name, text in reading.definition.items())
            source = f"{reading.mark}: {reading.source or 'no source'}, {definitions}"
            sources[printable(reading.id)] = printable(source)
    return sources


def real_time_sentences(result: evaluation.CaseResult) -> list[str]:
    """Return the response times of the controller in a stop paced by the clock, nothing for others."""
    times = result.response_times
    if times is None:
        return []
    seconds = times.cycle_time_s, times.longest_answer_s, times.start_jitter_s
    cycle, longest, jitter = (f"{1e3 * time:.3g} ms" for time in seconds)
    missed = f"{times.missed_deadlines} of {counted(times.answers, 'answer')}"
    answers = f"{missed} after the end of their cycle of {cycle}"
    worst = f"longest answer {longest} (cycle {times.longest_answer_cycle})"
    return [f"in real time: {answers}, {worst}, start of a cycle at most {jitter} late"]


def tally(results: Iterable[evaluation.CaseResult], differing: Container[str] = ()) -> str:
    """Return the counts of a run, e.g. `12 cases: 9 pass, 1 expected fail, 2 fail; 2 not as expected`.

    A case that is met counts as different where its id is among those `differing` from the baseline.
    """
    results = list(results)
    if not results:
        return "no case"
    words = [DIFFERS if result.met and result.id in differing else result_word(result) for result in results]
    counts = {word: words.count(word) for word in CASE_WORDS}
    counted_words = counts_text(counts, sum(not result.met for result in results))
    allowed = list(allowed_sentences(results))
    not_named = [f"{len(allowed) - NAMED} more allowed"] if len(allowed) > NAMED else []
    return "; ".join([f"{counted(len(words), 'case')}: {counted_words}", *allowed[:NAMED], *not_named])


def counts_text(counts: Mapping[str, int], not_met: int) -> str:
    """Return counts of cases by word, those of none left out, and how many do not meet their expectation."""
    labels = {DIFFERS: "different from the baseline"}
    counts_by_word = ", ".join(f"{count} {labels.get(word, word)}" for word, count in counts.items() if count)
    return f"{counts_by_word}; {not_met} not as expected" if not_met else counts_by_word


_BYPASSED: Final = "WSP bypassed: the controller did not act, the stop says nothing about it"


def cause_sentences(result: evaluation.CaseResult) -> list[str]:
    """Return the causes of an outcome in the stop: faults, bypassed WSP, no standstill, too good a rail."""
    rail = [] if result.rail and result.rail.test_validity == "valid" else rail_sentences(result)
    bypassed = [_BYPASSED] if is_bypassed(result.parts) else []
    parameters = [parameter for part in result.parts.values() for parameter in part.parameters]
    endless = [
        printable(each.reason)
        for each in result.criteria
        if each.measure == "standstill" and each.status == "inconclusive" and result.outcome == "fail"
    ]
    return [*fault_sentences(parameters), *bypassed, *endless, *rail]


def rail_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield whether the rail itself makes a stop a test: with the WSP bypassed, where that was run."""
    if (rail := result.rail) is None:
        return
    values = [f"{each.id} {value_with_limit(each)}" for each in rail.criteria if each.value is not None]
    seen = ", ".join([*values, *(["wheels lock"] if rail.wheels_lock else [])])
    either = "" if result.test_validity == "valid" else " either"
    words = {"valid": "a valid test", "not_valid": f"not a valid test{either}", "not_judged": "not judged"}
    says = words[rail.test_validity]
    decides = ", which decides" if rail.decides else ""
    advice = "; lower the friction or raise the command" if rail.test_validity == "not_valid" else ""
    text = f"with the WSP bypassed the stop is {says}{decides}: {seen}; friction {rail.friction}{advice}"
    yield printable(text)


def is_bypassed(parts: Mapping[str, evaluation.EffectivePart]) -> bool:
    """Return whether the WSP did not act on the valves in a case with these parts."""
    rig = parts.get("scenario.rig")
    return rig is not None and any(p.key == "rig.wsp" and p.written == "bypassed" for p in rig.parameters)


def fault_sentences(
    parameters: Sequence[evaluation.Parameter], varied: Collection[str] = ()
) -> Iterator[str]:
    """Yield the faults among parameters: `injected fault: vent valve of wheelset 3: stuck closed from 6 s`.

    Of what varies, the keys `varied`, they say nothing.
    """
    faults: dict[str, dict[str, str]] = {}
    for parameter in parameters:
        above, _, field = parameter.key.rpartition(".")
        if above.startswith("faults."):
            faults.setdefault(above, {})[field] = "" if parameter.key in varied else parameter.written
    for fault in faults.values():
        words = fault_words(*(fault.get(name, "") for name in ("part", "kind", "wheelset", "value")))
        begin, end = fault.get("at"), fault.get("until")
        span = f"{f' from {begin}' if begin else ''}{f' until {end}' if end else ''}"
        yield printable(f"injected fault: {words}{span}")


def fault_words(part: str, kind: str, wheelset: str = "", value: str = "") -> str:
    """Return a fault as people say it, e.g. `vent valve of wheelset 3: stuck closed`."""
    of = f" of wheelset {wheelset}" if wheelset else ""
    return f"{part.replace('-', ' ')}{of}: {kind.replace('-', ' ')}{f' {value}' if value else ''}"


def label_words(label: str) -> str:
    """Return the words of the fault that a recording names by its label; of an unknown one the label."""
    for part, kind in FAULT_KINDS:
        if found := re.fullmatch(rf"{part}-{kind}(?:-(\d))?", label):
            return fault_words(part, kind, found[1] or "")
    return label

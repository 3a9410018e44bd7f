"""Lines on cases and series: what is close or uncertain, why each came out so, what to expect of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core.units import in_unit
from uictest.judging import evaluation
from uictest.plans.scenario import Expectation, supposed_definition
from uictest.report.case_conditions import car_facts, part_sentences
from uictest.report.difference import difference_sentences
from uictest.report.formats.text import coloured_text
from uictest.report.robustness import firmness_sentences, repeat_sentences
from uictest.report.series_report import bypassed_is_better, series_value_text, why_uncertain
from uictest.report.verdict_sentences import (
    criterion_sentences,
    definition_sentence,
    reading_sources,
    real_time_sentences,
    value_with_limit,
    without_checks_that_hold,
)
from uictest.report.words import listed, printable, quantity, tone

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult
    from uictest.report.content import RunContent

NARROW: Final = 10.0
"""Per cent of the limit: a criterion met with less to spare is marked as narrow; chosen."""
MOST_CLOSE: Final = 8
"""Close verdicts that a reader is shown first; the tables of cases and series have all of them."""
_BECOMES: Final[Mapping[evaluation.Status, str]] = {
    "pass": "passes",
    "fail": "fails",
    "inconclusive": "is inconclusive",
    "not_applicable": "does not apply",
}


class CloseCall(NamedTuple):
    """A verdict that could have been another one.

    `of` is the id of its case or series, `criterion` is empty for what is none. `kind` is `turns` where the
    verdict is not certain, `narrow` where it is met with little to spare.
    """

    of: str
    criterion: str
    kind: str
    text: str
    of_series: bool = False

    def __str__(self) -> str:
        """Return it as one line."""
        return printable(f"{self.of}: {f'{self.criterion} {self.text}'.strip()}")


def close_calls(
    results: Sequence[evaluation.CaseResult], series: Sequence[SeriesResult] = ()
) -> list[CloseCall]:
    """Return the close calls: what is not firm or not certain, what turns, and the narrowest margins.

    A criterion by which a case or series is not as expected is not a close call.
    """
    turning: list[CloseCall] = []
    narrow: list[tuple[float, CloseCall]] = []
    for result in results:
        for verdict in result.criteria:
            if verdict.is_check or verdict.status not in (("pass", "fail") if result.met else ("pass",)):
                continue
            if not verdict.steady:
                turning.append(CloseCall(result.id, verdict.id, "turns", turns_text(verdict)))
            elif (share := _narrow_margin(verdict)) is not None:
                call = CloseCall(result.id, verdict.id, "narrow", _narrow_text(verdict, share))
                narrow.append((share, call))
    not_firm = [_not_firm(result) for result in results if result.met]
    not_firm += [_not_firm(result, of_series=True) for result in series if result.met]
    return [
        *(call for call in not_firm if call is not None),
        *(call for result in series for call in _of_series(result)),
        *turning,
        *(call for _, call in sorted(narrow, key=lambda pair: pair[0])),
    ]


def _narrow_margin(verdict: evaluation.Verdict) -> float | None:
    """Return the share of its limit that a criterion has to spare where that is little."""
    share = evaluation.relative_margin(verdict)
    return share if verdict.status == "pass" and share is not None and 100.0 * share < NARROW else None


def _narrow_text(verdict: evaluation.Verdict, share: float) -> str:
    return f"{value_with_limit(verdict)}, {100 * share:.2g} % to spare"


def _not_firm(result: evaluation.CaseResult | SeriesResult, *, of_series: bool = False) -> CloseCall | None:
    """Return an outcome that hangs on numbers that nobody measured; None for others."""
    if result.firmness is None or result.is_firm:
        return None
    return CloseCall(result.id, "", "turns", next(firmness_sentences(result)), of_series)


def _of_series(result: SeriesResult) -> Iterator[CloseCall]:
    if sentence := bypassed_is_better(result):
        yield CloseCall(result.id, "", "turns", sentence, of_series=True)
    for judged in result.criteria:
        verdict = judged.verdict
        if judged.confident is False and (verdict.status == "pass" or result.met):
            text = f"{series_value_text(judged)}: not certain, {why_uncertain(judged, result.confidence)}"
            yield CloseCall(result.id, verdict.id, "turns", text, of_series=True)
        elif (share := _narrow_margin(verdict)) is not None:
            text = _narrow_text(verdict, share)
            yield CloseCall(result.id, verdict.id, "narrow", text, of_series=True)


def turns_text(verdict: evaluation.Verdict) -> str:
    """Return what turns a verdict: `fails if sliding counted below 85 % instead of 90 % ...`.

    Empty where nothing does.
    """
    if verdict.steady:
        return ""
    turning = [sensitivity for sensitivity in verdict.sensitivity if sensitivity.flips]
    reasons = [text for sensitivity in turning for text in _turned_by(verdict, sensitivity)]
    if verdict.over_stops is not None and verdict.over_stops.turns:
        reasons.append("turns from stop to stop")
    return " or ".join(reasons) or "turns"


def _turned_by(verdict: evaluation.Verdict, sensitivity: evaluation.Sensitivity) -> Iterator[str]:
    """Yield the nearest values of a definition that change the verdict, with the status there."""
    intervals, unit = sensitivity.intervals, sensitivity.unit
    if any(interval.reading for interval in intervals):
        yield f"depends on the reading ({', '.join(map(str, intervals))})"
        return
    stated = verdict.defined(sensitivity.definition)
    if stated is None:
        return
    now = in_unit(stated, unit)
    within = [k for k, interval in enumerate(intervals) if interval.first <= now <= interval.last]
    if not within:
        return
    below, above = intervals[: within[0]][-1:], intervals[within[0] + 1 :][:1]
    nearest = [
        *((interval.last, interval.status) for interval in below),
        *((interval.first, interval.status) for interval in above),
    ]
    clause = supposed_definition(sensitivity.definition)
    for value, status in nearest:
        supposed = clause.format(f"{quantity(value, unit)} instead of {quantity(now, unit)}")
        yield f"{_BECOMES[status]} if {supposed}"


def explanation_lines(
    content: RunContent, result: evaluation.CaseResult, *, coloured: bool = False
) -> Iterator[str]:
    """Yield the word and the id of a case, and below them all its verdicts and differences."""
    word = content.word(result)
    yield f"{coloured_text(word, tone(word) if coloured else None)} {printable(result.id)}"
    yield from repeat_sentences(result)
    yield from criterion_sentences(result)
    yield from real_time_sentences(result)
    yield from difference_sentences(content.differences(result.id))


def expectation_lines(results: Iterable[evaluation.CaseResult]) -> Iterator[str]:
    """Yield for each scenario the line that expects what a run came to, once where all of its cases agree."""
    files: dict[str, dict[str, str]] = {}
    for result in results:
        files.setdefault(result.scenario, {})[result.id] = _expectation_line(result)
    for file, lines in files.items():
        alike = len(set(lines.values())) == 1
        for case_id, line in islice(lines.items(), 1 if alike else None):
            yield printable(f"# {file}{'' if alike else f': {case_id}'}")
            yield line


def _expectation_line(result: evaluation.CaseResult) -> str:
    if result.outcome in ("pass", "skipped"):
        expect = Expectation(result.outcome)
    else:
        expect = _expected_by_name(result)
    if not replace(result, expect=expect).as_expected:
        return printable(f"# nothing to expect: {result.outcome}: {result.reason}")
    named = {"fail": expect.fail, "invalid": expect.invalid}
    lists = [f"{key}: [{', '.join(names)}]" for key, names in named.items() if names]
    return f"expect: {{{', '.join(lists)}}}" if lists else f"expect: {expect.outcome}"


def _expected_by_name(result: evaluation.CaseResult) -> Expectation:
    """Return the expectation that names what a case, or any of its stops, misses."""
    stops = [stop.decided for stop in result.repeats.stops] if result.repeats else [result.decided]
    missed = {verdict.id: None for stop in stops for verdict in evaluation.missed_requirements(stop)}
    no_test = {
        verdict.id: None
        for stop in stops
        for verdict in evaluation.why_no_test(stop)
        if verdict.layer == "validity" and verdict.status == "fail"
    }
    return Expectation("fail" if missed else "invalid", tuple(missed), tuple(no_test))


def definition_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the definitions of each criterion, once for all cases in which they are the same."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for verdict in without_checks_that_hold(result.criteria):
            cases.setdefault((verdict.id, definition_sentence(verdict)), []).append(result.id)
            for reading, sentence in reading_sources(verdict).items():
                cases.setdefault((f"{verdict.id} read as {reading}", sentence), []).append(result.id)
    defined = [criterion for criterion, _ in cases]
    for (criterion, sentence), names in cases.items():
        where = f" (in {listed(names)})" if defined.count(criterion) > 1 else ""
        if sentence:
            yield f"definition {printable(criterion)}{where}: {sentence}"


def part_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the parts that cases were run with and their changes, once for all cases with the same part."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        of_car = ", ".join(f"{name} {text}" for name, text in car_facts(result).items())
        sentences = {"car": of_car} if of_car else {}
        for role, sentence in (sentences | part_sentences(result.parts, result.controller_version)).items():
            cases.setdefault((role, sentence), []).append(result.id)
    for (role, sentence), names in cases.items():
        where = "" if len(names) == len(results) else f" (in {listed(names)})"
        yield f"part {role}{where}: {sentence}"

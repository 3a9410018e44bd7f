"""Lines on cases and series: what is close or uncertain, why each came out so, what to expect of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core.document import Lines
from uictest.core.measures import STOP_COLUMNS
from uictest.core.units import in_unit
from uictest.judging import evaluation
from uictest.plans.scenario import Expectation, supposed_definition
from uictest.report.case_conditions import (
    car_facts,
    domain_sentences,
    part_sentences,
    slide_speed,
    train_cells,
)
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    case_explanation,
    case_word,
    difference_sentences,
)
from uictest.report.formats.text import coloured_text
from uictest.report.robustness import firmness_sentences, range_cells, repeat_sentences, share_cells
from uictest.report.series_report import (
    bypassed_is_better,
    interval,
    limit_inside,
    of_dry_stop,
    series_verdict_sentence,
    stops_sentences,
    unsettled_of_series,
)
from uictest.report.verdict_sentences import (
    criterion_sentences,
    definition_sentence,
    reading_sources,
    real_time_sentences,
    statement_sentence,
    value_and_limits,
    without_checks_that_hold,
)
from uictest.report.words import (
    DIFFERS,
    EXPLAINED,
    counted,
    line_word,
    listed,
    number,
    percent,
    printable,
    quantity,
    result_word,
    tone,
)

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult, SeriesVerdict
    from uictest.report.content import RunContent

TITLE: Final = "Close or uncertain"
NARROW: Final = 10.0
"""Per cent of the limit: a criterion met with less to spare is marked as narrow; chosen."""
MOST_CLOSE: Final = 8
"""Close verdicts that a reader is shown first; the tables of cases and series have all of them."""
_BECOMES: Final[Mapping[evaluation.Status, str]] = {
    "pass": "pass",
    "fail": "fail",
    "inconclusive": "be inconclusive",
    "not_applicable": "not apply",
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
    not_firm = [*map(_not_firm, results), *(_not_firm(result, of_series=True) for result in series)]
    return [
        *(call for call in not_firm if call is not None),
        *(call for result in series for call in _of_series(result)),
        *turning,
        *(call for _, call in sorted(narrow, key=lambda pair: pair[0])),
    ]


def close_lines(results: Sequence[evaluation.CaseResult], series: Sequence[SeriesResult] = ()) -> Lines:
    """Return the first of what is close or not certain as lines, and how many more there are."""
    calls = close_calls(results, series)
    rest = len(calls) - MOST_CLOSE
    more = [f"{rest} more, in the tables of cases and series"] if rest > 0 else []
    return Lines([*map(str, calls[:MOST_CLOSE]), *more], title=TITLE)


def _narrow_margin(verdict: evaluation.Verdict) -> float | None:
    """Return the share of its limit that a criterion has to spare where that is little."""
    share = evaluation.relative_margin(verdict)
    return share if verdict.status == "pass" and share is not None and 100.0 * share < NARROW else None


def _narrow_text(verdict: evaluation.Verdict, share: float) -> str:
    return f"{value_and_limits(verdict, word='')} ({100 * share:+.3g} %)"


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
            text = _uncertain_line(judged, result.confidence)
            yield CloseCall(result.id, verdict.id, "turns", text, of_series=True)
        elif (share := _narrow_margin(verdict)) is not None:
            text = _narrow_text(verdict, share)
            yield CloseCall(result.id, verdict.id, "narrow", text, of_series=True)


def _uncertain_line(judged: SeriesVerdict, confidence: float) -> str:
    verdict, estimate = judged.verdict, judged.estimate
    from_speed = f" from {judged.place}" if judged.speed_kmh is not None else ""
    value = f"{quantity(verdict.value, verdict.unit)}{of_dry_stop(judged)}{from_speed}: not certain"
    if estimate is None:
        return value
    unit = "" if verdict.unit == "1" else f" {verdict.unit}"
    stops = counted(estimate.stops, "stop")
    within = f"the {percent(confidence)} interval {interval(estimate)}{unit} ({stops})"
    return f"{value}, {limit_inside(judged, within)}"


def turns_text(verdict: evaluation.Verdict) -> str:
    """Return what turns a verdict: `would fail if sliding counted below 85 % instead of 90 % ...`.

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
        yield f"turns with its reading ({', '.join(map(str, intervals))})"
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
        yield f"would {_BECOMES[status]} if {supposed}"


MOST_DIFFERENCES: Final = 3
"""Quantities out of the tolerance of a baseline that a case shows on a terminal; results.json has all."""


def explanation_lines(
    content: RunContent,
    result: evaluation.CaseResult,
    *,
    every_criterion: bool = False,
    coloured: bool = False,
) -> Iterator[str]:
    """Yield the word and the id of a case, and below them the reasons for its outcome or all its verdicts."""
    word = content.word(result)
    yield f"{coloured_text(word, tone(word) if coloured else None)} {printable(result.id)}"
    lines = content.explanation(result, MOST_DIFFERENCES)
    if every_criterion:
        lines = [
            *repeat_sentences(result),
            *criterion_sentences(result),
            *real_time_sentences(result),
            *difference_sentences(content.differences(result.id)),
        ]
    yield from (f"  {line}" for line in lines)


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


# Lines for grep: a word, the id of a case or series, and `key=value` or a sentence.

_MEASURES: Final = tuple(name for name, column in STOP_COLUMNS.items() if column.overview)
_SERIES_MEASURES: Final = ("k_wet", "stopping_distance_extension", "passing_share")


def case_line(result: evaluation.CaseResult, differences: Sequence[Difference] = ()) -> str:
    """Return the line of one case, ending with the reason if it is not met or differs from the baseline."""
    words = [line_word(case_word(result, differences)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={str(result.expect).replace(' ', '')}"]
    if result.criteria:
        words += [f"test_validity={result.test_validity}", f"requirements={result.requirement_status}"]
    if result.rail is not None:
        words.append(f"rail_validity={result.rail.test_validity}")
    words += [f"{name}={value:.4g}" for name, value in share_cells(result).items()]
    words += [f"{name}={value:.5g}" for name, value in range_cells(result, _MEASURES[:1]).items()]
    words += _measure_lines(result)
    if differences or not result.met or result.outcome in EXPLAINED:
        outcomes, *more = case_explanation(result, differences, MOST_DIFFERENCES)
        reasons = [line for line in more if line != statement_sentence(result)]
        words.append(f"reason={'; '.join(reasons or [outcomes])}")
    return " ".join(words)


def _measure_lines(result: evaluation.CaseResult) -> Iterator[str]:
    if result.measures is not None:
        yield from (f"{name}={number(result.measures[name])}" for name in _MEASURES)
    if result.wheelsets:
        yield f"slide_above={slide_speed([result]).replace(' ', '')}"
        for name in ("maximum_slide", "valve_actuations"):
            yield f"{name}={'/'.join(number(wheelset[name]) for wheelset in result.wheelsets)}"
    for name, force in train_cells(result).items():
        if isinstance(force, float):
            yield f"{name}={number(force)}"
    if (times := result.response_times) is not None:
        yield f"missed_deadlines={times.missed_deadlines}"
        yield f"longest_answer_s={number(times.longest_answer_s)}"
        yield f"start_jitter_s={number(times.start_jitter_s)}"
    if result.controller_log:
        yield f"controller_log={result.controller_log}"


def criterion_lines(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield one line per criterion of a case."""
    return (f"criterion {printable(result.id)} {sentence}" for sentence in criterion_sentences(result))


def domain_lines(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield the conditions of a case that lie outside of what was validated."""
    for sentence in domain_sentences(result):
        yield f"outside {printable(result.id)} {sentence.removeprefix('outside ')}"


def firmness_lines(result: evaluation.CaseResult | SeriesResult) -> Iterator[str]:
    """Yield the lines on how firm a case or series is."""
    return (f"firmness {printable(result.id)} {sentence}" for sentence in firmness_sentences(result))


def missing_lines(baseline: BaselineComparison) -> Iterator[str]:
    """Yield one line per case of the baseline that is missing, and per series that differs from it."""
    for case_id in baseline.beside_cases:
        reason = "; ".join(difference_sentences(baseline.differences[case_id], MOST_DIFFERENCES))
        yield f"{DIFFERS} {printable(case_id)} reason={reason}"


def series_line(result: SeriesResult) -> str:
    """Return the line of a series: word, id, outcome, and its measures."""
    words = [line_word(result_word(result)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={result.expect}"]
    for name in _SERIES_MEASURES:
        of_rails = {
            f"{name}[{speed.place.replace(' ', '')}]": speed.measures for speed in result.speeds if speed.rail
        }
        for key, measures in (of_rails or {name: result.measures}).items():
            estimate = measures[name].estimate
            words.append(f"{key}={number(None if estimate is None else estimate.value)}")
    if not result.met:
        reasons = [result.reason] if result.reason else unsettled_of_series(result)
        words.append(f"reason={printable('; '.join(reasons))}")
    return " ".join(words)


def series_lines(result: SeriesResult) -> Iterator[str]:
    """Yield the lines below that of a series: its criteria, the stops that count and that do not."""
    for judged in result.criteria:
        yield f"criterion {printable(result.id)} {series_verdict_sentence(judged, result.confidence)}"
    for sentence in stops_sentences(result):
        yield f"stops {printable(result.id)} {sentence}"

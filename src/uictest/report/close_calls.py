"""What passes and is close to its limit, or not certain: the same list on the page, terminal and Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core.document import Lines
from uictest.core.units import in_unit
from uictest.judging import evaluation
from uictest.plans.scenario import supposed_definition
from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.firmness_sentences import firmness_sentences
from uictest.report.series.series_sentences import (
    bypassed_is_better,
    interval,
    limit_inside,
    of_dry_stop,
    percent,
)
from uictest.report.verdict_sentences import quantity, value_and_limits

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult, SeriesVerdict

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
TITLE: Final = "Close or uncertain"


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
    """Return what is close or not certain: what is not firm, of series, what turns, the narrowest margins.

    A criterion by which a case or series is not as expected is no such thing.
    """
    turning, narrow = [], []
    for result in results:
        judged = ("pass", "fail") if result.met else ("pass",)
        for verdict in result.criteria:
            if verdict.is_check or verdict.status not in judged:
                continue
            share = evaluation.relative_margin(verdict)
            if not verdict.steady:
                turning.append(CloseCall(result.id, verdict.id, "turns", turns_text(verdict)))
            elif verdict.status == "pass" and share is not None and 100.0 * share < NARROW:
                text = _narrow(verdict, share)
                narrow.append((share, CloseCall(result.id, verdict.id, "narrow", text)))
    of_series = [call for each in series for call in _of_series(each)]
    not_firm = [
        *(CloseCall(each.id, "", "turns", text) for each in results for text in _not_firm(each)),
        *(CloseCall(each.id, "", "turns", text, True) for each in series for text in _not_firm(each)),
    ]
    return [*not_firm, *of_series, *turning, *(call for _, call in sorted(narrow, key=lambda each: each[0]))]


def close_lines(results: Sequence[evaluation.CaseResult], series: Sequence[SeriesResult] = ()) -> Lines:
    """Return the first of what is close or not certain as lines, and how many more there are."""
    calls = close_calls(results, series)
    rest = len(calls) - MOST_CLOSE
    more = [f"{rest} more, in the tables of cases and series"] if rest > 0 else []
    return Lines([*map(str, calls[:MOST_CLOSE]), *more], title=TITLE)


def _not_firm(result: evaluation.CaseResult | SeriesResult) -> list[str]:
    """Return the sentence of an outcome that hangs on numbers that nobody measured; none of others."""
    if result.firmness is None or result.is_firm:
        return []
    return list(islice(firmness_sentences(result), 1))


def _of_series(result: SeriesResult) -> Iterator[CloseCall]:
    if sentence := bypassed_is_better(result):
        yield CloseCall(result.id, "", "turns", sentence, of_series=True)
    for each in result.criteria:
        verdict, share = each.verdict, evaluation.relative_margin(each.verdict)
        if each.confident is False and (verdict.status == "pass" or result.met):
            text = _uncertain(each, result.confidence)
            yield CloseCall(result.id, verdict.id, "turns", text, of_series=True)
        elif verdict.status == "pass" and share is not None and 100.0 * share < NARROW:
            yield CloseCall(result.id, verdict.id, "narrow", _narrow(verdict, share), of_series=True)


def _narrow(verdict: evaluation.Verdict, share: float) -> str:
    return f"{value_and_limits(verdict, word='')} ({100 * share:+.3g} %)"


def _uncertain(each: SeriesVerdict, confidence: float) -> str:
    verdict, estimate = each.verdict, each.estimate
    value = f"{quantity(verdict.value, verdict.unit)}{of_dry_stop(each)}"
    place = f" from {each.place}" if each.speed_kmh is not None else ""
    if estimate is None:
        return f"{value}{place}: not certain"
    unit = "" if verdict.unit == "1" else f" {verdict.unit}"
    stops = counted(estimate.stops, "stop")
    within = f"the {percent(confidence)} interval {interval(estimate)}{unit} ({stops})"
    return f"{value}{place}: not certain, {limit_inside(each, within)}"


def turns_text(verdict: evaluation.Verdict) -> str:
    """Return what would turn a verdict: `would fail if sliding counted below 85 % instead of 90 % ...`.

    Empty where nothing does.
    """
    if verdict.steady:
        return ""
    turning = [each for each in verdict.sensitivity if each.flips]
    reasons = [text for each in turning for text in _turned_by(verdict, each)]
    if verdict.over_stops is not None and verdict.over_stops.turns:
        reasons.append("turns from stop to stop")
    return " or ".join(reasons) or "turns"


def _turned_by(verdict: evaluation.Verdict, sensitivity: evaluation.Sensitivity) -> Iterator[str]:
    """Yield which values of a definition, the nearest ones, change the verdict and to what."""
    if any(each.reading for each in sensitivity.intervals):
        yield f"turns with its reading ({', '.join(map(str, sensitivity.intervals))})"
        return
    stated = verdict.defined(sensitivity.definition)
    if stated is None:
        return
    now, unit = in_unit(stated, sensitivity.unit), sensitivity.unit
    own = next((each for each in sensitivity.intervals if each.first <= now <= each.last), None)
    if own is None:
        return
    place = sensitivity.intervals.index(own)
    below, above = sensitivity.intervals[:place][-1:], sensitivity.intervals[place + 1 :][:1]
    nearest = [*((each.last, each.status) for each in below), *((each.first, each.status) for each in above)]
    clause = supposed_definition(sensitivity.definition)
    for value, status in nearest:
        supposed = clause.format(f"{quantity(value, unit)} instead of {quantity(now, unit)}")
        yield f"would {_BECOMES[status]} if {supposed}"

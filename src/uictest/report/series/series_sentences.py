"""How the results of series are put into words, the same in every format."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from uictest.core import statistics
from uictest.core.series_measures import Estimate, Method
from uictest.report.case_words import CASE_WORDS, line_word, result_word
from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.firmness_sentences import firmness_sentences
from uictest.report.github import annotation
from uictest.report.verdict_sentences import (
    counts_text,
    limits,
    margin_text,
    number,
    outcome_sentence,
    quantity,
    unsettled_sentences,
)

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult, SeriesStop, SeriesVerdict

_METHODS: Final[dict[Method, str]] = {
    "median": "median of {}",
    "mean": "mean of {}",
    "share": "share of {}",
    "largest": "largest of {}",
    "smallest": "smallest of {}",
}
_INTERVALS: Final[dict[Method, str]] = {
    "median": "by order statistics",
    "mean": "by Student's t",
    "share": "by Clopper and Pearson",
}
_OVER_DRY: Final[dict[Method, str]] = {"median": "by MOVER-R", "mean": "by Fieller's theorem"}
_SIDES: Final[dict[Method, str]] = {"largest": "below", "smallest": "above"}
_REASONS_SHOWN: Final = 3


def series_word(result: SeriesResult) -> str:
    """Return the word of a series, one of those of cases."""
    return result_word(result)


def is_uncertain(result: SeriesResult) -> bool:
    """Return whether a series is as expected, and some verdict of its criteria is not certain."""
    return result.met and any(each.confident is False for each in result.criteria)


def series_tally(results: Sequence[SeriesResult]) -> str:
    """Return the counts of the series of a run, e.g. `2 series: 1 pass, 1 fail; 1 not as expected`.

    Of series that are as expected it counts the criteria whose verdict is not certain.
    """
    counts = Counter(map(series_word, results))
    in_order = {word: counts[word] for word in CASE_WORDS}
    tally = f"{len(results)} series: {counts_text(in_order, sum(not each.met for each in results))}"
    judged = [each for result in results if result.met for each in result.criteria]
    uncertain = sum(each.confident is False for each in judged)
    return f"{tally}; {uncertain} of {len(judged)} criteria of series not certain" if uncertain else tally


def percent(share: float) -> str:
    """Return a share of 1 as text in per cent."""
    return f"{100.0 * share:.4g} %"


def short(value: float | None) -> str:
    """Return a number with four significant digits, `-` where there is none."""
    return "-" if value is None or math.isnan(value) else f"{value:.4g}"


def interval(estimate: Estimate) -> str:
    """Return the ends of the interval of an estimate; empty where there is none."""
    ends = estimate.low, estimate.high
    return "" if any(map(math.isnan, ends)) else " .. ".join(map(short, ends))


def estimate_words(estimate: Estimate) -> str:
    """Return how an estimate was made and how sure it is: `mean of 9 stops, 95 % interval 1 .. 2 by ...`."""
    over = f" over {estimate.dry_stops} dry" if estimate.dry_stops else ""
    made = f"{_METHODS[estimate.method].format(counted(estimate.stops, 'stop'))}{over}"
    at = percent(estimate.confidence)
    if missing := missing_interval(estimate):
        return f"{made}, {missing}"
    if estimate.method in _SIDES:
        end = estimate.high if estimate.method == "largest" else estimate.low
        limit = "it" if math.isnan(end) else short(end)
        covered = f"at least {percent(estimate.covered)} of such stops lie {_SIDES[estimate.method]} {limit}"
        return f"{made}; {covered} ({at} confidence)"
    by = (_OVER_DRY if estimate.dry_stops else _INTERVALS)[estimate.method]
    return f"{made}, {at} interval {interval(estimate)} {by}"


def missing_interval(estimate: Estimate) -> str:
    """Return why nothing says how sure an estimate is; empty where something does."""
    at = percent(estimate.confidence)
    if interval(estimate) or math.isfinite(estimate.covered):
        return ""
    needed = statistics.draws_for_median(estimate.confidence) if estimate.method == "median" else 2
    if estimate.stops < needed and estimate.method not in _SIDES:
        return f"too few for a {at} interval: {needed} are needed"
    if not estimate.dry_scatter:
        equal = "one dry stop shows" if estimate.dry_stops == 1 else "equal dry stops show"
        return f"no {at} interval: {equal} no scatter"
    return f"they scatter too much for a {at} interval"


def confidence_words(each: SeriesVerdict, confidence: float) -> str:
    """Return how sure a verdict is, in one clause; empty where nothing was estimated."""
    at = percent(confidence)
    if each.kept is not None and each.stops:
        ends = " .. ".join(map(percent, statistics.proportion_interval(each.kept, each.stops, confidence)))
        taken = ", the mean of the dry stops taken as known" if each.of_dry_stop else ""
        share = f"{at} interval of the share {ends}{taken}"
        return f"{each.kept} of {counted(each.stops, 'stop')} keep it, {share}"
    if each.estimate is None:
        return ""
    uncertain = f"; not certain: {limit_inside(each, 'it')}" if each.confident is False else ""
    return f"{estimate_words(each.estimate)}{uncertain}"


def limit_inside(each: SeriesVerdict, within: str) -> str:
    """Return the limit for which a verdict is not certain: `the lower limit of 90 % lies inside it`.

    `within` stands for the interval. Of a share of stops it adds how many would settle it.
    """
    verdict, estimate = each.verdict, each.estimate
    bounds = {"lower": verdict.lower, "upper": verdict.upper}
    inside = [
        f"the {name} limit of {quantity(bound, verdict.unit)} lies inside {within}"
        for name, bound in bounds.items()
        if bound is not None and estimate is not None and estimate.low <= bound <= estimate.high
    ]
    if estimate is not None and not estimate.dry_scatter:
        return missing_interval(estimate)
    if not inside:
        return "a limit lies inside the interval at another speed or rail"
    return "; ".join([*inside, *_settled_by(each)])


def _settled_by(each: SeriesVerdict) -> Iterator[str]:
    """Yield how many stops would settle a share of stops that has its least value."""
    verdict, estimate = each.verdict, each.estimate
    if estimate is None or estimate.method != "share" or verdict.lower is None or verdict.status != "pass":
        return
    needed = statistics.trials_needed(verdict.lower / 100.0, estimate.confidence)
    if needed is None:
        yield "no number of stops settles it"
    elif needed > estimate.stops:
        yield f"{needed} stops, all passing, would settle it"


def series_verdict_sentence(each: SeriesVerdict, confidence: float) -> str:
    """Return the verdict on one line: value, limits, margin or reason, and how sure it is."""
    verdict = each.verdict
    head = f"{verdict.id} ({verdict.layer}) {verdict.status.replace('_', ' ')}"
    return printable(
        "; ".join(filter(None, (f"{head}: {_substance(each)}", confidence_words(each, confidence))))
    )


def _substance(each: SeriesVerdict) -> str:
    verdict = each.verdict
    if verdict.value is None:
        return verdict.reason
    at_speed = f" from {each.place}" if each.place else ""
    value = f"{quantity(verdict.value, verdict.unit)}{of_dry_stop(each)}{at_speed}"
    return f"{value}, {limits(verdict)}, margin {margin_text(verdict)}"


def of_dry_stop(each: SeriesVerdict) -> str:
    """Return what stands behind the value of a criterion whose bounds are shares of the dry stop."""
    return " of the dry stop" if each.of_dry_stop else ""


def count_sentences(result: SeriesResult) -> Iterator[str]:
    """Yield for each speed and rail how many stops count, and K_wet without WSP where it is better."""
    for speed in result.speeds:
        dry, wet = (f"{each.counted} of {each.run}" for each in (speed.dry, speed.wet))
        share = f"{percent(speed.wet.share)}, {percent(result.valid_stops)} needed"
        yield f"Valid stops from {speed.place}: dry {dry}, wet {wet} ({share})"
    if sentence := bypassed_is_better(result):
        yield sentence


def bypassed_is_better(result: SeriesResult) -> str:
    """Return both values of K_wet where it is better without WSP; else an empty text."""
    bypassed = None if result.bypassed_k_wet is None else result.bypassed_k_wet.estimate
    tested = next((each.estimate for each in result.criteria if each.verdict.measure == "k_wet"), None)
    if bypassed is None or tested is None or bypassed.value <= tested.value:
        return ""
    values = (f"{short(each.value)} ({interval(each) or '-'})" for each in (bypassed, tested))
    better = "K_wet is better with the WSP bypassed, {}, than with the tested one, {}".format(*values)
    return "; ".join([better, *_longest_locked(result)])


def _longest_locked(result: SeriesResult) -> Iterator[str]:
    """Yield how long a wheelset is locked without and with WSP on the rails that were run without."""
    from uictest.judging.series import observed_stops  # here, for most runs hold no series

    stops = [each for each in observed_stops(result.cases, result.speed_tolerance_kmh) if each.counts]
    rails = {stop.rail for stop in stops if stop.role == "bypassed"}
    without, tested = (
        _longest(stop for stop in stops if stop.role == role and stop.rail in rails)
        for role in ("bypassed", "wet")
    )
    if math.isfinite(without) and math.isfinite(tested):
        times = quantity(without, "s"), quantity(tested, "s")
        yield "a wheelset is locked for up to {} with it bypassed, {} with the tested one".format(*times)


def _longest(stops: Iterable[SeriesStop]) -> float:
    """Return the longest time that a wheelset of some stops is locked; NaN where none is known."""
    times = [wheelset.get("locked_time_s", math.nan) for stop in stops for wheelset in stop.figures.wheelsets]
    return max(filter(math.isfinite, times), default=math.nan)


def not_counted_sentences(result: SeriesResult) -> Iterator[str]:
    """Yield how many stops do not count, by outcome, each with the first reasons."""
    for outcome, count in Counter(stop.outcome for stop in result.not_counted).items():
        stops = [stop for stop in result.not_counted if stop.outcome == outcome]
        reasons = list(dict.fromkeys(stop.reason for stop in stops))
        shown = "; ".join(reasons[:_REASONS_SHOWN])
        if (more := len(reasons) - _REASONS_SHOWN) > 0:
            shown += f"; {counted(more, 'more reason')}"
        yield printable(f"{counted(count, 'stop')} {outcome}, not counted: {shown}")


def series_explanation(result: SeriesResult) -> list[str]:
    """Return the reasons for an outcome: expectation, stops that count, criteria that decided."""
    deciding = [each for each in result.criteria if each.verdict.status in ("fail", "inconclusive")]
    names = [each.verdict.id for each in deciding]
    return [
        outcome_sentence(result, names),
        *([printable(result.reason)] if result.reason and not deciding else []),
        *(series_verdict_sentence(each, result.confidence) for each in deciding),
        *unsettled_of_series(result),
        *count_sentences(result),
        *not_counted_sentences(result),
    ]


def unsettled_of_series(result: SeriesResult) -> list[str]:
    """Return which verdicts of a strict series and of its cases are not settled, and why."""
    pairs = [(printable(name), each) for name, each in result.unsettled]
    lines = [f"{name}: {line}" for name, each in pairs for line in unsettled_sentences([each])]
    return [*lines, *(firmness_sentences(result) if result.lacks_firmness else ())]


SHOWN_MEASURES = ("k_wet", "stopping_distance_extension", "passing_share")


def series_line(result: SeriesResult) -> str:
    """Return the line of a series: word, id, outcome, and its measures as `key=value`."""
    words = [line_word(series_word(result)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={result.expect}"]
    for name in SHOWN_MEASURES:
        of_rails = {
            f"{name}[{each.place.replace(' ', '')}]": each.measures for each in result.speeds if each.rail
        }
        for key, measures in (of_rails or {name: result.measures}).items():
            estimate = measures[name].estimate
            words.append(f"{key}={number(None if estimate is None else estimate.value)}")
    if not result.met:
        reasons = [result.reason] if result.reason else unsettled_of_series(result)
        words.append(f"reason={printable('; '.join(reasons))}")
    return " ".join(words)


def series_lines(result: SeriesResult) -> Iterator[str]:
    """Yield what stands below the line of a series: its criteria, the stops that count and that do not."""
    for each in result.criteria:
        yield f"criterion {printable(result.id)} {series_verdict_sentence(each, result.confidence)}"
    for sentence in (*count_sentences(result), *not_counted_sentences(result)):
        yield f"stops {printable(result.id)} {sentence}"


def series_annotations(result: SeriesResult) -> Iterator[str]:
    """Yield an `::error` command for a series that misses its expectation."""
    if not result.met:
        title = f"{series_word(result)} {result.id}"
        yield annotation(result.file, title, "\n".join(series_explanation(result)))

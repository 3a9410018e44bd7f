"""Series of stops in sentences and tables, the same in every format."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core import statistics
from uictest.core.document import Cell, Column, Document, Lines, Table, Tone, table_of
from uictest.core.series_measures import SERIES_MEASURES, Estimate, Method
from uictest.judging import series
from uictest.report.formats.text import document_lines, table_lines
from uictest.report.robustness import firmness_sentences, wheelset_cells
from uictest.report.verdict_sentences import (
    MOST_URGENT,
    counts_text,
    definition_sentence,
    outcome_sentence,
    unsettled_sentences,
    value_with_limit,
)
from uictest.report.words import (
    CASE_WORDS,
    counted,
    listed,
    number,
    percent,
    printable,
    quantity,
    result_word,
    tone,
)

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult, SeriesStop, SeriesVerdict

_SIDES: Final[dict[Method, str]] = {"largest": "below", "smallest": "above"}
_MOST_REASONS: Final = 1
"""Reasons for which stops do not count that a sentence names before it counts the others; chosen."""
_MOST: Final = 300
"""Rows and lines that a summary of a run gives to its series; chosen."""
_ALL_CRITERIA: Final = "tables/series-criteria.csv"


def is_uncertain(result: SeriesResult) -> bool:
    """Return whether a series is as expected, and some verdict of its criteria is not certain."""
    return result.met and any(judged.confident is False for judged in result.criteria)


def series_tally(results: Sequence[SeriesResult]) -> str:
    """Return the counts of the series of a run, e.g. `2 series: 1 pass, 1 fail; 1 not as expected`.

    Of series that are as expected it counts the criteria whose verdict is not certain.
    """
    counts = Counter(map(result_word, results))
    in_order = {word: counts[word] for word in CASE_WORDS}
    tally = f"{len(results)} series: {counts_text(in_order, sum(not result.met for result in results))}"
    judged = [criterion for result in results if result.met for criterion in result.criteria]
    uncertain = sum(criterion.confident is False for criterion in judged)
    return f"{tally}; {uncertain} of {len(judged)} criteria of series not certain" if uncertain else tally


def interval(estimate: Estimate) -> str:
    """Return the ends of the interval of an estimate; empty where there is none."""
    ends = estimate.low, estimate.high
    return "" if any(map(math.isnan, ends)) else " to ".join(number(end, 4) for end in ends)


def value_with_interval(estimate: Estimate | None) -> str:
    """Return a value with its interval in parentheses, `-` where there is none."""
    if estimate is None:
        return "-"
    ends = interval(estimate)
    return f"{number(estimate.value, 4)} ({ends})" if ends else number(estimate.value, 4)


def estimate_words(estimate: Estimate) -> str:
    """Return the method and the confidence of an estimate: `mean of 9 stops, 95 % interval 1 to 2`."""
    over = f" over {estimate.dry_stops} dry" if estimate.dry_stops else ""
    made = f"{estimate.method} of {counted(estimate.stops, 'stop')}{over}"
    at = percent(estimate.confidence)
    if missing := missing_interval(estimate):
        return f"{made}, {missing}"
    if estimate.method in _SIDES:
        end = estimate.high if estimate.method == "largest" else estimate.low
        limit = "it" if math.isnan(end) else number(end, 4)
        covered = f"at least {percent(estimate.covered)} of such stops lie {_SIDES[estimate.method]} {limit}"
        return f"{made}; {covered} ({at} confidence)"
    return f"{made}, {at} interval {interval(estimate)}"


def missing_interval(estimate: Estimate) -> str:
    """Return the reason for which an estimate has no interval; empty where it has one."""
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


def confidence_words(judged: SeriesVerdict, confidence: float) -> str:
    """Return the confidence in a verdict, in one clause; empty where nothing was estimated."""
    if judged.kept is not None and judged.stops:
        ends = statistics.proportion_interval(judged.kept, judged.stops, confidence)
        taken = ", the mean of the dry stops taken as known" if judged.of_dry_stop else ""
        share = f"{percent(confidence)} interval of the share {' to '.join(map(percent, ends))}{taken}"
        return f"{judged.kept} of {counted(judged.stops, 'stop')} keep it, {share}"
    return "" if judged.estimate is None else estimate_words(judged.estimate)


def _interval_cell(judged: SeriesVerdict) -> str:
    """Return how sure a value is: its interval, or the share of such stops on one side of it."""
    estimate = judged.estimate
    if judged.kept is not None and judged.stops:
        return f"{judged.kept} of {counted(judged.stops, 'stop')} keep it"
    if estimate is None or missing_interval(estimate):
        return "" if estimate is None else "none"
    if estimate.method in _SIDES:
        return f"{percent(estimate.covered, 2)} or more {_SIDES[estimate.method]}"
    return interval(estimate)


def why_uncertain(judged: SeriesVerdict, confidence: float) -> str:
    """Return why a verdict is not certain: `the 95 % interval 86 to 95 % holds the limit (12 stops)`.

    Of a share of stops it adds how many would settle it.
    """
    verdict, estimate = judged.verdict, judged.estimate
    if estimate is None:
        return "another speed or rail may decide"
    if not estimate.dry_scatter:
        return missing_interval(estimate)
    bounds = [bound for bound in (verdict.lower, verdict.upper) if bound is not None]
    if not any(estimate.low <= bound <= estimate.high for bound in bounds):
        return "a limit lies inside the interval at another speed or rail"
    unit = "" if verdict.unit == "1" else f" {verdict.unit}"
    stops = counted(estimate.stops, "stop")
    inside = f"the {percent(confidence)} interval {interval(estimate)}{unit} holds the limit ({stops})"
    return "; ".join([inside, *_settled_by(judged)])


def _settled_by(judged: SeriesVerdict) -> Iterator[str]:
    """Yield the number of stops that would settle a share of stops that has its least value."""
    verdict, estimate = judged.verdict, judged.estimate
    if estimate is None or estimate.method != "share" or verdict.lower is None or verdict.status != "pass":
        return
    needed = statistics.trials_needed(verdict.lower / 100.0, estimate.confidence)
    if needed is None:
        yield "no number of stops settles it"
    elif needed > estimate.stops:
        yield f"{needed} stops, all passing, would settle it"


def of_dry_stop(judged: SeriesVerdict) -> str:
    """Return the words after the value of a criterion whose bounds are shares of the dry stop."""
    return " of the dry stop" if judged.of_dry_stop else ""


def series_value_text(judged: SeriesVerdict) -> str:
    """Return a value with its limit and its speed: `118.3 % of the dry stop (limit 125 %) from 120 km/h`."""
    if judged.verdict.value is None:
        return judged.verdict.reason
    from_speed = f" from {judged.place}" if judged.speed_kmh is not None else ""
    return f"{value_with_limit(judged.verdict, of_dry_stop(judged))}{from_speed}"


def series_verdict_sentence(judged: SeriesVerdict, confidence: float) -> str:
    """Return the verdict on one line: value and limit, or the reason, and how sure it is."""
    uncertain = f"not certain: {why_uncertain(judged, confidence)}" if judged.confident is False else ""
    head = f"{judged.verdict.id} {judged.verdict.status.replace('_', ' ')}: {series_value_text(judged)}"
    return printable("; ".join(filter(None, (head, confidence_words(judged, confidence), uncertain))))


def count_sentences(result: SeriesResult) -> Iterator[str]:
    """Yield for each speed and rail how many stops count."""
    for speed in result.speeds:
        dry, wet = (f"{stops.counted} of {stops.run}" for stops in (speed.dry, speed.wet))
        share = f"{percent(speed.wet.share)}, {percent(result.valid_stops)} needed"
        yield f"Valid stops from {speed.place}: dry {dry}, wet {wet} ({share})"


def bypassed_is_better(result: SeriesResult) -> str:
    """Return both values of K_wet where it is better without WSP; else an empty text."""
    bypassed = None if result.bypassed_k_wet is None else result.bypassed_k_wet.estimate
    tested = next((judged.estimate for judged in result.criteria if judged.verdict.measure == "k_wet"), None)
    if bypassed is None or tested is None or bypassed.value <= tested.value:
        return ""
    values = (f"{number(k_wet.value, 4)} ({interval(k_wet) or '-'})" for k_wet in (bypassed, tested))
    better = "K_wet is better with the WSP bypassed, {}, than with the tested WSP, {}".format(*values)
    return "; ".join([better, *_longest_locked(result)])


def _longest_locked(result: SeriesResult) -> Iterator[str]:
    """Yield the longest locked times without and with WSP, on the rails that were run without it."""
    observed = series.observed_stops(result.cases, result.speed_tolerance_kmh)
    stops = [stop for stop in observed if stop.counts]
    rails = {stop.rail for stop in stops if stop.role == "bypassed"}
    without, tested = (
        _longest(stop for stop in stops if stop.role == role and stop.rail in rails)
        for role in ("bypassed", "wet")
    )
    if math.isfinite(without) and math.isfinite(tested):
        times = quantity(without, "s"), quantity(tested, "s")
        yield "wheelsets lock for up to {} with it bypassed, {} with the tested WSP".format(*times)


def _longest(stops: Iterable[SeriesStop]) -> float:
    """Return the longest time that a wheelset of some stops is locked; NaN where none is known."""
    times = [wheelset.get("locked_time_s", math.nan) for stop in stops for wheelset in stop.figures.wheelsets]
    return max(filter(math.isfinite, times), default=math.nan)


def not_counted_sentences(result: SeriesResult) -> Iterator[str]:
    """Yield the number of stops that do not count, by outcome, with the first reasons."""
    for outcome, count in Counter(stop.outcome for stop in result.not_counted).items():
        stops = [stop for stop in result.not_counted if stop.outcome == outcome]
        reasons = list(dict.fromkeys(stop.reason for stop in stops))
        first = "; ".join(reasons[:_MOST_REASONS])
        if (more := len(reasons) - _MOST_REASONS) > 0:
            first += f"; {counted(more, 'more reason')}"
        yield printable(f"{counted(count, 'stop')} {outcome}, not counted: {first}")


def stops_sentences(result: SeriesResult) -> list[str]:
    """Return the sentences on the stops that count, and on those that do not with the reasons."""
    return [*count_sentences(result), *not_counted_sentences(result)]


def series_explanation(result: SeriesResult) -> list[str]:
    """Return the reasons for an outcome: expectation, the criteria that decided it, how sure they are."""
    deciding = [judged for judged in result.criteria if judged.verdict.status in ("fail", "inconclusive")]
    return [
        outcome_sentence(result, list(_deciding_texts(deciding))),
        *([printable(result.reason)] if result.reason and not deciding else []),
        *(
            printable(f"{judged.verdict.id}: {words}")
            for judged in deciding
            if (words := confidence_words(judged, result.confidence))
        ),
        *unsettled_of_series(result),
    ]


def _deciding_texts(deciding: Sequence[SeriesVerdict]) -> Iterator[str]:
    """Yield each criterion with its value; those without one together, once for each reason."""
    without: dict[str, list[str]] = {}
    for judged in deciding:
        if judged.verdict.value is None:
            without.setdefault(judged.verdict.reason, []).append(judged.verdict.id)
        else:
            yield f"{judged.verdict.id} {series_value_text(judged)}"
    yield from (f"{listed(names)}: {reason}" for reason, names in without.items())


def unsettled_of_series(result: SeriesResult) -> list[str]:
    """Return a line for each unsettled verdict of a strict series and of its cases, with the reason."""
    lines = [
        f"{printable(name)}: {line}"
        for name, verdict in result.unsettled
        for line in unsettled_sentences([verdict])
    ]
    return [*lines, *(firmness_sentences(result) if result.lacks_firmness else ())]


_ESTIMATE: Final = (
    *("low", "high", "confidence", "method", "stops", "smallest", "largest", "covered", "dry_stops"),
)
"""What tables say of an estimate besides its value."""


def series_tables(results: Sequence[SeriesResult]) -> list[Table]:
    """Return the tables of series for programs: measures, criteria, stops."""
    return [
        table_of("series", list(_measure_rows(results))),
        series_criteria_table(results),
        table_of("series-stops", list(_stop_rows(results))),
    ]


def _measure_rows(results: Sequence[SeriesResult]) -> Iterator[dict[str, Cell]]:
    """Yield one row per series, speed, rail and measure; the speed `all` is the whole series."""
    for result in results:
        whole = dict(result.measures)
        if result.bypassed_k_wet is not None:
            whole["bypassed_k_wet"] = result.bypassed_k_wet
        of_speeds = {(f"{speed.speed_kmh:g}", speed.rail): speed.measures for speed in result.speeds}
        for (speed_kmh, rail), measures in ({("all", ""): whole} | of_speeds).items():
            for name, value in measures.items():
                estimate = value.estimate
                yield {
                    "series": result.id,
                    "speed_kmh": speed_kmh,
                    "rail": rail,
                    "measure": name,
                    "unit": SERIES_MEASURES[name].unit if name in SERIES_MEASURES else "1",
                    "value": None if estimate is None else estimate.value,
                    **{key: None if estimate is None else getattr(estimate, key) for key in _ESTIMATE},
                    "reason": value.unavailable_reason,
                }


def _stop_rows(results: Sequence[SeriesResult]) -> Iterator[dict[str, Cell]]:
    """Yield one row per stop of a series, repeats one by one, with all of its columns."""
    facts = ("case", "role", "rail", "speed_kmh", "seed", "counts", "outcome", "reason")
    for result in results:
        for stop in series.observed_stops(result.cases, result.speed_tolerance_kmh):
            about = {name: getattr(stop, name) for name in facts}
            wheelsets = wheelset_cells(stop.figures.wheelsets)
            yield {"series": result.id, **about, **stop.figures.measures, **wheelsets}


class JudgedCriterion(NamedTuple):
    """A criterion with the series that it judged."""

    result: SeriesResult
    criterion: SeriesVerdict

    @property
    def verdict_text(self) -> str:
        """The verdict in words."""
        certain = ", not certain" if self.criterion.confident is False else ""
        return f"{self.criterion.verdict.status.replace('_', ' ')}{certain}"

    @property
    def tone(self) -> Tone | None:
        """The tone of the verdict; one that is not certain has its own."""
        tones: Mapping[str, Tone] = {"pass": "good", "fail": "bad", "inconclusive": "odd"}
        return "odd" if self.criterion.confident is False else tones.get(self.criterion.verdict.status)

    def estimated(self, key: str) -> Cell:
        """Return what is known of the value besides itself; the number of stops even without an estimate."""
        without: Mapping[str, Cell] = {"stops": self.criterion.stops}
        estimate = self.criterion.estimate
        return without.get(key) if estimate is None else getattr(estimate, key)


def _estimate_column(key: str) -> Column[JudgedCriterion]:
    return Column(key=key, value=lambda row: row.estimated(key))


_HOW_SURE: Final[Column[JudgedCriterion]] = Column(
    heading="how sure", text=lambda row: _interval_cell(row.criterion)
)
_CRITERIA: Final[tuple[Column[JudgedCriterion], ...]] = (
    Column(key="series", heading="series", value=lambda row: row.result.id, literal=True),
    Column(
        key="criterion",
        heading="criterion",
        value=lambda row: row.criterion.verdict.id,
        wraps=True,
        literal=True,
    ),
    Column(key="layer", value=lambda row: row.criterion.verdict.layer),
    Column(
        key="verdict",
        heading="verdict",
        value=lambda row: row.criterion.verdict.status,
        text=lambda row: row.verdict_text,
        tone=lambda row: row.tone,
    ),
    Column(
        key="value",
        heading="value and limit",
        value=lambda row: row.criterion.verdict.value,
        text=lambda row: (
            row.criterion.verdict.reason
            if row.criterion.verdict.value is None
            else value_with_limit(row.criterion.verdict, of_dry_stop(row.criterion))
        ),
        wraps=True,
    ),
    _HOW_SURE,
    Column(heading="from", text=lambda row: row.criterion.place, rank=1),
    *(
        Column(key=name, value=attrgetter(f"criterion.verdict.{name}"))
        for name in ("unit", "lower", "upper", "margin")
    ),
    Column(key="speed_kmh", value=lambda row: row.criterion.speed_kmh),
    Column(key="rail", value=lambda row: row.criterion.rail),
    Column(key="certain", value=lambda row: row.criterion.confident),
    Column(key="kept", value=lambda row: row.criterion.kept),
    *map(_estimate_column, _ESTIMATE),
    Column(key="reason", value=lambda row: row.criterion.verdict.reason),
    Column(
        key="requirements",
        heading="requirements",
        value=lambda row: "; ".join(row.criterion.verdict.requirements),
        rank=2,
    ),
    Column(key="definition", value=lambda row: definition_sentence(row.criterion.verdict)),
)


def series_criteria_table(results: Sequence[SeriesResult], most: int | None = None) -> Table:
    """Return one row per series and criterion; `most` of them for a reader of a summary."""
    rows = [JudgedCriterion(result, criterion) for result in results for criterion in result.criteria]
    return Table(_CRITERIA, rows, name="series-criteria", most=most)


def criteria_of(result: SeriesResult) -> Table:
    """Return the criteria of one series for people, failing ones first."""
    urgent_first = sorted(result.criteria, key=lambda judged: MOST_URGENT.index(judged.verdict.status))
    rows = [JudgedCriterion(result, criterion) for criterion in urgent_first]
    sure = f"{percent(result.confidence)} sure"
    columns = [replace(each, heading=sure) if each is _HOW_SURE else each for each in _CRITERIA[1:]]
    return Table(columns, rows, all_in=_ALL_CRITERIA)


def comparison_table(results: Sequence[SeriesResult]) -> Table:
    """Return series side by side: the value of every criterion with its interval, and which are missed."""
    first: dict[str, SeriesVerdict] = {}
    for result in results:
        for criterion in result.criteria:
            first.setdefault(criterion.verdict.id, criterion)
    columns: list[Column[SeriesResult]] = [
        Column(heading="series", text=lambda result: result.id, wraps=True, literal=True),
        Column(heading="verdict", text=result_word, rank=1, tone=lambda result: tone(result_word(result))),
        Column(
            heading="wet stops",
            text=lambda result: f"{result.wet_stops.counted} of {result.wet_stops.run}",
            rank=2,
            right=True,
        ),
        *(_compared_criterion(criterion, rank) for rank, criterion in enumerate(first.values(), start=3)),
    ]
    return Table(columns, results, all_in=_ALL_CRITERIA, most=_MOST)


def _compared_criterion(first: SeriesVerdict, rank: int) -> Column[SeriesResult]:
    """Return the column of a criterion in a comparison of series, of which `first` judged one."""
    unit = "" if first.verdict.unit == "1" else f"{first.verdict.unit}{of_dry_stop(first)}"

    def text(result: SeriesResult) -> str:
        judged = next((other for other in result.criteria if other.verdict.id == first.verdict.id), None)
        if judged is None:
            return "-"
        known = judged.estimate
        value = number(judged.verdict.value, 4) if known is None else value_with_interval(known)
        status = judged.verdict.status.replace("_", " ")
        remark = "" if status == "pass" else f" {status}"
        return f"{value}{remark}{', not certain' if judged.confident is False else ''}"

    return Column(heading=first.verdict.id, unit=unit, text=text, rank=rank, right=True)


def series_lines_of_terminal(results: Sequence[SeriesResult], width: int | None) -> Iterator[str]:
    """Yield the lines of the comparison, where there are several series, and of the criteria of each."""
    if len(results) > 1:
        yield from table_lines(comparison_table(results), width)
    for result in results:
        yield ""
        yield f"{result_word(result)} {printable(result.id)}"
        yield from document_lines(
            Document(result.id, [criteria_of(result), Lines(stops_sentences(result))]), width
        )


def series_sections(results: Sequence[SeriesResult]) -> list[Table | Lines]:
    """Return the comparison, the stops that count, and the criteria of every series; nothing without any."""
    if not results:
        return []
    counts = [f"{result.id}: {line}" for result in results for line in stops_sentences(result)]
    if (rest := len(counts) - _MOST) > 0:
        counts[_MOST:] = [f"{counted(rest, 'more line')} in tables/series-stops.csv and results.json"]
    return [comparison_table(results), Lines(counts), series_criteria_table(results, _MOST)]

"""A series as its page shows it: the distances of its stops as dots, against the dry stop and the bounds."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

from uictest.core.document import Column, Table, Tone
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging import evaluation
from uictest.judging.series import SeriesResult, SeriesStop, SpeedResult, observed_stops
from uictest.report.case_words import tone
from uictest.report.page.axis import Axis
from uictest.report.page.links import fragment, series_anchor
from uictest.report.page.plot import ROW_PIXELS, Label, Plot, Shape, dot, row_at, rows_plot
from uictest.report.series.series_sentences import (
    bypassed_is_better,
    count_sentences,
    is_uncertain,
    not_counted_sentences,
    percent,
    series_word,
)
from uictest.report.series.tables import (
    CRITERIA,
    Judged,
    comparison_table,
    judged_criteria,
    value_with_interval,
)
from uictest.report.verdict_sentences import MOST_URGENT

_DISTANCE = "corrected_distance_m"
_OF_DISTANCE = ("braking_distance", "median_braking_distance", "worst_braking_distance")
"""Measures whose bounds are drawn as lines."""


SERIES_WORDS: Final = {
    "bypassed_is_better": bypassed_is_better,
    "comparison_table": comparison_table,
    "count_sentences": count_sentences,
    "not_counted_sentences": not_counted_sentences,
    "percent": percent,
}
"""What the template of series puts things into words by."""


@dataclass(frozen=True, slots=True)
class SeriesView:
    """A series with its word, its plots, and the tables of its criteria and measures."""

    anchor: str
    result: SeriesResult
    word: str
    plots: Sequence[Plot]
    criteria: Table
    measures: Table

    @property
    def badge(self) -> str:
        """The word, and whether a verdict behind it is not certain."""
        return f"{self.word}, not certain" if is_uncertain(self.result) else self.word

    @property
    def tone(self) -> Tone:
        """The tone of the badge; one that is not certain has its own."""
        return "odd" if is_uncertain(self.result) else tone(self.word)

    @property
    def fragment(self) -> str:
        """What stands behind the `#` of a link to it."""
        return fragment(self.anchor)


_OF_PAGE: Final[tuple[Column[Judged], ...]] = (
    Column(heading="from", text=lambda judged: judged.each.place),
    Column(heading="measure", text=lambda judged: judged.each.verdict.definition.get("measure", "")),
    Column(heading="requirements", text=lambda judged: ", ".join(judged.each.verdict.requirements)),
)
"""Columns of criteria that other formats have no room for."""


def series_view(result: SeriesResult) -> SeriesView:
    """Return the view of a series; failing criteria stand first."""
    stops = observed_stops(result.cases, result.speed_tolerance_kmh)
    plots = [_plot(result, speed, stops) for speed in result.speeds]
    criteria = sorted(judged_criteria(result), key=lambda each: MOST_URGENT.index(each.each.verdict.status))
    return SeriesView(
        series_anchor(result.id),
        result,
        series_word(result),
        [plot for plot in plots if plot],
        Table((*CRITERIA, *_OF_PAGE), criteria),
        _measures(result),
    )


def _measures(result: SeriesResult) -> Table:
    """Return the measures of the whole series and from each speed."""
    columns: list[Column[str]] = [
        Column(heading="measure", text=str, literal=True),
        Column(
            heading="unit", text=lambda name: SERIES_MEASURES[name].unit if name in SERIES_MEASURES else ""
        ),
    ]
    for place, measures in {
        "series": result.measures,
        **{s.place: s.measures for s in result.speeds},
    }.items():
        text = partial(lambda own, name: value_with_interval(own[name]), measures)
        columns.append(Column(heading=place, text=text, right=True))
    return Table(columns, list(result.measures))


def _plot(result: SeriesResult, speed: SpeedResult, stops: Sequence[SeriesStop]) -> Plot | None:
    """Return the distances from one speed, and on its rail; None where no stop has any."""
    at_speed = [
        stop
        for stop in stops
        if stop.speed_kmh == speed.speed_kmh and (stop.role == "dry" or speed.rail in ("", stop.rail))
    ]
    known = [distance for stop in at_speed if math.isfinite(distance := _distance(stop))]
    if not known:
        return None
    marked = list(_marked(result, at_speed, speed.rail))
    ends = [*known, *(distance for distance, _, _ in marked)]
    air = 0.04 * (max(ends) - min(ends)) or 1.0
    axis = Axis(min(ends) - air, max(ends) + air, *ROW_PIXELS)
    names = _labels(result, {stop.case for stop in at_speed})
    top, bottom = row_at(0) - 10, row_at(len(names)) - 10
    lines = [
        Shape("bound-line" if is_bound else "dry-line", f"M{axis.at(distance):.1f} {top}V{bottom}")
        for distance, _, is_bound in marked
    ]
    labels = [Label(axis.at(distance), top - 6, label) for distance, label, _ in marked]
    dots = [
        Shape("dot" if stop.counts else "dot uncounted", dot(axis.at(_distance(stop)), row_at(place), 3.5))
        for place, case in enumerate(names)
        for stop in at_speed
        if stop.case == case and math.isfinite(_distance(stop))
    ]
    words = f"Braking distances from {speed.place}, one dot per stop; series-stops.csv has the numbers"
    x_title = f"braking distance from {speed.place}, m"
    return rows_plot(list(names.values()), [*lines, *dots], axis.tick_marks(6), words, x_title, labels)


def _labels(result: SeriesResult, names: Collection[str]) -> dict[str, str]:
    """Return a short name for every case named: its own, and the values by which wet ones differ."""
    cases = [each for each in result.cases if each.case.id in names]
    wet = [each.case.parameters for each in cases if each.role == "wet"]
    keys = dict.fromkeys(key for parameters in wet for key in parameters)
    varied = [key for key in keys if len({parameters.get(key) for parameters in wet}) > 1]
    return {each.case.id: _label(result, each.case, varied) for each in cases}


def _label(result: SeriesResult, case: evaluation.CaseResult, varied: Sequence[str]) -> str:
    head, _, rest = case.id.removeprefix(f"{result.id}.").partition("[")
    own = [(key.rpartition(".")[2], case.parameters[key]) for key in varied if key in case.parameters]
    return " ".join([f"{head}{rest.rpartition(']')[2]}", *(f"{key} {text}" for key, text in own)])


def _distance(stop: SeriesStop) -> float:
    return stop.figures.measures.get(_DISTANCE, math.nan)


def _marked(
    result: SeriesResult, stops: Sequence[SeriesStop], rail: str
) -> Iterator[tuple[float, str, bool]]:
    """Yield the mean of the dry stops, and every bound that refers to it and decides on this rail."""
    dry = [_distance(stop) for stop in stops if stop.role == "dry" and stop.counts]
    reference = math.fsum(dry) / len(dry) if dry else math.nan
    if not math.isfinite(reference):
        return
    yield reference, "dry", False
    for each in result.criteria:
        verdict = each.verdict
        if verdict.measure in _OF_DISTANCE and each.of_dry_stop and each.rail in ("", rail):
            for bound in (verdict.lower, verdict.upper):
                if bound is not None:
                    yield reference * bound / 100.0, f"{bound:g} %", True

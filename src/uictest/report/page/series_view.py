"""A series as its page shows it: the distances of its stops as dots, against the dry stop and the bounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from typing import Any, Final

from uictest.core.document import Column, Table, Tone
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging.series import SeriesResult, SeriesStop, SpeedResult, observed_stops
from uictest.report.page.plot import ROW_PIXELS, Axis, Label, Plot, Shape, dot, row_at, rows_plot
from uictest.report.page.rendering import series_anchor
from uictest.report.series_report import (
    comparison_table,
    count_sentences,
    criteria_of,
    is_uncertain,
    not_counted_sentences,
    value_with_interval,
)
from uictest.report.words import percent, result_word, tone

_DISTANCE: Final = "corrected_distance_m"
_OF_DISTANCE: Final = ("braking_distance", "median_braking_distance", "worst_braking_distance")
"""Measures whose bounds are drawn as lines."""


def series_badge(result: SeriesResult) -> str:
    """Return the word of a series, and whether one of its verdicts is not certain."""
    word = result_word(result)
    return f"{word}, not certain" if is_uncertain(result) else word


def series_tone(result: SeriesResult) -> Tone:
    """Return the tone of the badge; one that is not certain has its own."""
    return "odd" if is_uncertain(result) else tone(result_word(result))


def measures_table(result: SeriesResult) -> Table:
    """Return the measures of the whole series and from each speed."""
    columns: list[Column[str]] = [
        Column(heading="measure", text=str, literal=True),
        Column(
            heading="unit", text=lambda name: SERIES_MEASURES[name].unit if name in SERIES_MEASURES else ""
        ),
    ]
    by_speed = {speed.place: speed.measures for speed in result.speeds}
    for heading, measures in {"series": result.measures, **by_speed}.items():
        text = partial(lambda own, name: value_with_interval(own[name].estimate), measures)
        columns.append(Column(heading=heading, text=text, right=True))
    return Table(columns, list(result.measures))


def distance_plots(result: SeriesResult) -> list[Plot]:
    """Return the distances from each speed, on each rail, as dots; none where no stop has any."""
    stops = observed_stops(result.cases, result.speed_tolerance_kmh)
    plots = [_speed_plot(result, speed, stops) for speed in result.speeds]
    return [plot for plot in plots if plot is not None]


def _speed_plot(result: SeriesResult, speed: SpeedResult, stops: Sequence[SeriesStop]) -> Plot | None:
    at_speed = [
        stop
        for stop in stops
        if stop.speed_kmh == speed.speed_kmh and (stop.role == "dry" or speed.rail in ("", stop.rail))
    ]
    with_distance = [stop for stop in at_speed if math.isfinite(_braking_distance(stop))]
    if not with_distance:
        return None
    marked = list(_marked_distances(result, at_speed, speed.rail))
    ends = [*map(_braking_distance, with_distance), *(distance for distance, _, _ in marked)]
    air = 0.04 * (max(ends) - min(ends)) or 1.0
    axis = Axis(min(ends) - air, max(ends) + air, *ROW_PIXELS)
    names = _case_labels(result, {stop.case for stop in at_speed})
    top, bottom = row_at(0) - 10, row_at(len(names)) - 10
    shapes, labels = [], []
    for distance, label, kind in marked:
        shapes.append(Shape(kind, f"M{axis.at(distance):.1f} {top}V{bottom}"))
        labels.append(Label(axis.at(distance), top - 6, label))
    for index, case_id in enumerate(names):
        for stop in with_distance:
            if stop.case == case_id:
                kind = "dot" if stop.counts else "dot uncounted"
                shapes.append(Shape(kind, dot(axis.at(_braking_distance(stop)), row_at(index), 3.5)))
    words = f"Braking distances from {speed.place}, one dot per stop; tables/series-stops.csv has the numbers"
    x_title = f"braking distance from {speed.place}, m"
    return rows_plot(list(names.values()), shapes, axis.tick_marks(6), words, x_title, labels)


def _case_labels(result: SeriesResult, names: Collection[str]) -> dict[str, str]:
    """Return a short name for every case named: its own, and the values by which wet ones differ."""
    cases = [stops for stops in result.cases if stops.case.id in names]
    wet = [stops.case.parameters for stops in cases if stops.role == "wet"]
    keys = dict.fromkeys(key for parameters in wet for key in parameters)
    varied = [key for key in keys if len({parameters.get(key) for parameters in wet}) > 1]
    labels = {}
    for case in (stops.case for stops in cases):
        head, _, suffix = case.id.removeprefix(f"{result.id}.").partition("[")
        values = [
            f"{key.rpartition('.')[2]} {case.parameters[key]}" for key in varied if key in case.parameters
        ]
        labels[case.id] = " ".join([f"{head}{suffix.rpartition(']')[2]}", *values])
    return labels


def _braking_distance(stop: SeriesStop) -> float:
    return stop.figures.measures.get(_DISTANCE, math.nan)


def _marked_distances(
    result: SeriesResult, stops: Sequence[SeriesStop], rail: str
) -> Iterator[tuple[float, str, str]]:
    """Yield the mean of the dry stops, and every bound that refers to it and decides on this rail.

    Each is a distance, its label, and the class of its line.
    """
    dry = [_braking_distance(stop) for stop in stops if stop.role == "dry" and stop.counts]
    reference = math.fsum(dry) / len(dry) if dry else math.nan
    if not math.isfinite(reference):
        return
    yield reference, "dry", "dry-line"
    for criterion in result.criteria:
        verdict = criterion.verdict
        if verdict.measure in _OF_DISTANCE and criterion.of_dry_stop and criterion.rail in ("", rail):
            for bound in (verdict.lower, verdict.upper):
                if bound is not None:
                    yield reference * bound / 100.0, f"{bound:g} %", "bound-line"


_FUNCTIONS: Final[tuple[Callable[..., Any], ...]] = (
    *(comparison_table, criteria_of, count_sentences, not_counted_sentences, percent),
    *(series_anchor, series_badge, series_tone, measures_table, distance_plots),
)
SERIES_WORDS: Final = {function.__name__: function for function in _FUNCTIONS}
"""What the template of series shows them by."""

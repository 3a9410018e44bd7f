"""A drawn case on a page: its stop with plots and margins, the stops of a repeated case, its parts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

from uictest.core import document
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, Column
from uictest.judging import evaluation
from uictest.report.behaviour_sentences import behaviour_facts
from uictest.report.case_conditions import slide_speed
from uictest.report.case_lines import turns_text
from uictest.report.content import CaseDescription
from uictest.report.difference import Difference, case_explanation, case_word
from uictest.report.measure_columns import measure_columns
from uictest.report.page.margins import Margins, margins_of
from uictest.report.page.marks import fault_marks, marks_of
from uictest.report.page.plot import Axis
from uictest.report.page.rendering import case_anchor, case_fragment
from uictest.report.page.stop_plots import drawing_of, milliseconds, plot_data, sampling_text, script_json
from uictest.report.robustness import band_text, drawn_sentence, repeat_sentences
from uictest.report.summary import case_causes
from uictest.report.traces.quantities import LOOPS, PANELS, PLOT_QUANTITIES, STRIPS, VENT, WHEELSETS, key_of
from uictest.report.traces.trace import PlotTrace
from uictest.report.verdict_sentences import failing_first, real_time_sentences, without_checks_that_hold
from uictest.report.words import quantity


class CaseView(NamedTuple):
    """A case that is drawn.

    Args:
        result: result of the case.
        subject: its description.
        trace: trace of the stop that is drawn.
        margins: margins of its criteria.
        differences: those from the baseline.
        command: what runs the case alone; empty where there is no such command.

    """

    result: evaluation.CaseResult
    subject: CaseDescription
    trace: PlotTrace
    margins: Margins
    differences: Sequence[Difference] = ()
    command: str = ""


def case_view(
    result: evaluation.CaseResult,
    subject: CaseDescription,
    trace: PlotTrace,
    differences: Sequence[Difference] = (),
    command: str = "",
    accepted: Mapping[str, float] | None = None,
) -> CaseView:
    """Return the view of a case; `accepted` has the values of its criteria in the baseline."""
    margins = margins_of(result.criteria, result.drawn_stop.criteria, trace, accepted or {})
    return CaseView(result, subject, trace, margins, differences, command)


def stop_json(view: CaseView) -> str:
    """Return the data from which the script draws the stop of a case."""
    marks = [*fault_marks(view.trace), *marks_of(view.result.drawn_stop.criteria, view.trace)]
    recorded = bool(view.subject.recorded)
    return script_json(plot_data(view.result.id, view.trace, marks, recorded=recorded))


def stop_notes(view: CaseView) -> Iterator[str]:
    """Yield the notes for readers of the plots: faults, how the lines were sampled, what is missing."""
    result, trace = view.result.drawn_stop, view.trace
    yield from (f"{sentence[:1].upper()}{sentence[1:]}." for sentence in real_time_sentences(result))
    if result.controller_log:
        yield f"The controller printed: {result.controller_log}."
    for fault in trace.faults:
        yield f"Fault {fault.label} from {fault.start:.4g} s to {fault.end:.4g} s."
    yield sampling_text(trace)
    if trace.band:
        lowest, _ = next(iter(trace.band.values()))
        part = milliseconds(float(lowest.x[1] - lowest.x[0]))
        yield f"Band: lowest and highest sample of every {part}."
    labels = dict.fromkeys(PLOT_QUANTITIES[key_of(name)].label for name in trace.derived)
    if labels:
        yield f"Derived from recorded speeds: {', '.join(labels)}."
    if not trace.states:
        return
    every = milliseconds(trace.interval)
    between = f", but none between two samples, {every} apart" if view.subject.recorded else ""
    yield f"Valves show every change that was recorded{between}."
    drawn = sum(len(trace.valve_spans(n, (VENT,))) for n in WHEELSETS)
    counted = sum(wheelset["valve_actuations"] for wheelset in result.wheelsets)
    if drawn < counted:
        yield (
            f"The recording holds {drawn} of {counted:.0f} vents: those shorter than {every} can lie between"
            " two samples."
        )


def stop_explanation(view: CaseView) -> list[str]:
    """Return why a stop came out otherwise than expected; nothing for others."""
    if view.result.met and not view.differences:
        return []
    causes = [f"Cause: {cause}" for cause in case_causes(view.result, view.trace)]
    return [*case_explanation(view.result, view.differences, briefly=True), *causes]


def headline(result: evaluation.CaseResult) -> Iterator[tuple[str, str, str]]:
    """Yield the measures that a brake engineer looks at first: label, number, empty without one, and unit."""
    measures = result.measures
    if measures is not None:
        yield "braking distance", _headline_number(measures["braking_distance_m"]), "m"
        corrected = measures["corrected_distance_m"]
        if math.isfinite(corrected) and corrected != measures["braking_distance_m"]:
            yield "corrected distance", _headline_number(corrected), "m"
        yield "reference distance", _headline_number(measures["reference_distance_m"]), "m"
        yield "braking time", _headline_number(measures["braking_time_s"]), "s"
        yield "mean deceleration", _headline_number(measures["mean_deceleration_mps2"]), "m/s²"
        yield "initial adhesion", _headline_number(measures["initial_adhesion_g"]), "g"
        yield "deceleration distance", _headline_number(measures["deceleration_distance_m"]), "m"
        yield "adhesion utilisation", _headline_number(100.0 * measures["adhesion_utilisation"]), "%"
        yield "reservoir margin", _headline_number(measures["reservoir_margin_bar"]), "bar"
    if result.wheelsets:
        largest = max(100.0 * wheelset["maximum_slide"] for wheelset in result.wheelsets)
        yield f"largest slide above {slide_speed([result])}", _headline_number(largest), "%"
        vents = sum(wheelset["valve_actuations"] for wheelset in result.wheelsets)
        yield "valve actuations", f"{vents:g}" if vents == vents else "-", ""
    if measures is not None:
        yield "air consumed", _headline_number(measures["air_consumed_nl"]), "NL"
        if measures.get("track_brake_time_s", 0.0) > 0.0:
            yield "heat of the track brake", _headline_number(measures["track_brake_energy_kj"]), "kJ"


def _headline_number(value: float) -> str:
    """Return four significant digits, an empty text where there is no number."""
    return "" if value != value else f"{value:.4g}" if abs(value) < 1e4 else f"{value:.0f}"


MOST_STOPS: Final = 100
"""Stops that are listed and drawn one by one; the numbers and the counts are those of all."""
_AIR: Final = 0.08
"""Of the range of values and limits: what is left free on both sides; chosen."""


class Dot(NamedTuple):
    """The value of one stop at `x` per cent of the scale, and its status; `row` keeps dots apart."""

    x: float
    row: int
    status: evaluation.Status
    seed: int
    value: float


class CriterionDots(NamedTuple):
    """The values of a criterion over the stops, on a scale of 100 that holds its bounds.

    `first` and `last` are the ends of what the bounds allow, `median` that of the values; None where no stop
    has a value.
    """

    verdict: evaluation.Verdict
    counts: evaluation.OverStops
    first: float
    last: float
    median: float | None
    dots: Sequence[Dot]


def criteria_over_stops(
    result: evaluation.CaseResult, repeats: evaluation.Repeats
) -> Iterator[CriterionDots]:
    """Yield the values of every criterion over the stops of a case, failing ones first."""
    for verdict in failing_first(without_checks_that_hold(result.criteria)):
        counts = verdict.over_stops
        if counts is None or counts.lowest is None or counts.highest is None:
            continue
        ends = [counts.lowest, counts.highest, verdict.lower, verdict.upper]
        known = [end for end in ends if end is not None and math.isfinite(end)]
        air = _AIR * (max(known) - min(known)) or 1.0
        scale = Axis(min(known) - air, max(known) + air, 0.0, 100.0)
        dots: list[Dot] = []
        highest_rows: dict[int, int] = {}
        for stop in repeats.stops[:MOST_STOPS]:
            of_stop = stop.verdict(verdict.id)
            if of_stop is not None and of_stop.value is not None and math.isfinite(of_stop.value):
                x = round(scale.at(of_stop.value), 1)
                row = highest_rows[round(x)] = highest_rows.get(round(x), -1) + 1
                dots.append(Dot(x, row, of_stop.status, stop.seed, of_stop.value))
        yield CriterionDots(
            verdict,
            counts,
            0.0 if verdict.lower is None else round(scale.at(verdict.lower), 1),
            100.0 if verdict.upper is None else round(scale.at(verdict.upper), 1),
            None if verdict.value is None else round(scale.at(verdict.value), 1),
            dots,
        )


def stops_table(result: evaluation.CaseResult, repeats: evaluation.Repeats) -> document.Table:
    """Return the stops of a repeated case, one by one."""
    columns: list[document.Column[Any]] = [
        document.Column(heading="seed", text=lambda stop: str(stop.seed), literal=True, right=True),
        document.Column(heading="outcome", text=lambda stop: stop.outcome),
        *measure_columns([result]),
        document.Column(heading="why", text=lambda stop: stop.reason, wraps=True),
    ]
    return document.Table(columns, repeats.stops[:MOST_STOPS])


class _MeasureSpread(NamedTuple):
    """Median and spread of one column of results; `wheelset` is None for one of the stop."""

    column: Column
    wheelset: int | None
    spread: evaluation.Spread


def _spread_column(heading: str, name: str) -> document.Column[_MeasureSpread]:
    return document.Column(heading=heading, value=lambda row: getattr(row.spread, name), digits="significant")


_SPREADS: Final[tuple[document.Column[_MeasureSpread], ...]] = (
    document.Column(heading="measure", text=lambda row: row.column.name, literal=True),
    document.Column(heading="wheelset", text=lambda row: str(row.wheelset or "")),
    _spread_column("lowest", "lowest"),
    _spread_column("quartile", "lower_quartile"),
    _spread_column("median", "median"),
    _spread_column("quartile", "upper_quartile"),
    _spread_column("highest", "highest"),
    document.Column(heading="unit", text=lambda row: row.column.unit.removeprefix("1")),
    document.Column(heading="stops", text=lambda row: str(row.spread.count), right=True),
)


def spreads_table(repeats: evaluation.Repeats) -> document.Table:
    """Return the spread of every measure that is not the same in all stops."""
    of_stop = [(column, None) for column in STOP_COLUMNS.values()]
    of_wheelsets = [(column, wheelset) for column in WHEELSET_COLUMNS.values() for wheelset in WHEELSETS]
    rows = []
    for column, wheelset in (*of_stop, *of_wheelsets):
        spread = evaluation.spread_of(repeats.values(column.name, wheelset))
        if spread is not None and spread.lowest != spread.highest:
            rows.append(_MeasureSpread(column, wheelset, spread))
    return document.Table(_SPREADS, rows)


_MOST_PARTS: Final = 100
"""Parts that a page shows: each takes up to 10 kB of it."""


def shown_parts(cases: Iterable[Mapping[str, evaluation.EffectivePart]]) -> dict[str, Any]:
    """Return the distinct parts of some cases that a page shows in full, and how many more there are.

    They stand by their ids, those of a kind together, each in the order of first use.
    """
    table = evaluation.parts_table(cases)
    parts = list(table.values())[:_MOST_PARTS]
    kinds = list(dict.fromkeys(part.kind for part in parts))
    shown = {part.id: part for part in sorted(parts, key=lambda part: kinds.index(part.kind))}
    return {"parts": shown, "parts_not_shown": len(table) - len(shown)}


_FUNCTIONS: Final[tuple[Callable[..., Any], ...]] = (
    *(case_anchor, case_fragment, case_word, stop_explanation, headline, quantity, turns_text),
    *(drawing_of, stop_json, stop_notes, band_text, behaviour_facts),
    *(repeat_sentences, drawn_sentence, criteria_over_stops, spreads_table, stops_table),
)
STOP_WORDS: Final[Mapping[str, Any]] = {
    **{function.__name__: function for function in _FUNCTIONS},
    "plot_titles": {plot.key: plot.title for plot in (*PANELS, *LOOPS, *STRIPS)},
    "most_stops": MOST_STOPS,
}
"""What the templates of a stop and of its repeats show a case by."""

"""One drawn case as its part of the page needs it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from uictest.report.page.marks import Mark, marks_of
from uictest.report.page.overlay_view import panel_form
from uictest.report.page.packing import packed
from uictest.report.page.quantities import LOOPS, PANELS, QUANTITIES, lines_of, panel_lines
from uictest.report.page.script_json import script_json
from uictest.report.page.sketch import Sketch, sketch_of
from uictest.report.wording import verdict_word

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult, Verdict
    from uictest.report.page.trace import Trace
    from uictest.report.subject import Subject

Figure = tuple[str, str, str]
"""Label, number (empty where there is none), unit."""


@dataclass(frozen=True, slots=True)
class Gauge:
    """A value beside its bounds, in per cent of a common scale; `value` is None where there is none."""

    first: float
    last: float
    value: float | None


@dataclass(frozen=True, slots=True)
class CaseView:
    """A drawn case. `key` names its part of the page; `data` is the JSON its plots are drawn from."""

    key: str
    result: CaseResult
    subject: Subject
    word: str
    figures: Sequence[Figure]
    sketch: Sketch
    data: str
    interval: float


def case_view(key: str, result: CaseResult, subject: Subject, trace: Trace) -> CaseView:
    """Return the view of a case with its plots drawn."""
    marks = marks_of(result, trace)
    return CaseView(
        key,
        result,
        subject,
        verdict_word(result),
        list(figures_of(result)),
        sketch_of(trace, marks),
        script_json(_data(trace, marks)),
        trace.interval,
    )


def figures_of(result: CaseResult) -> Iterator[Figure]:
    """Yield the figures that a brake engineer asks for first."""
    measures = result.measures
    if measures is not None:
        yield "braking distance", _number(measures.braking_distance_m), "m"
        yield "braking time", _number(measures.braking_time_s), "s"
        yield "mean deceleration", _number(measures.mean_deceleration_mps2), "m/s²"
        yield "initial adhesion", _number(measures.initial_adhesion_g), "g"
    if result.wheelsets:
        slides = [100 * wheelset.maximum_slide for wheelset in result.wheelsets]
        yield "largest slide", _number(max(slides)), "%"
        vents = sum(wheelset.valve_actuations for wheelset in result.wheelsets)
        yield "valve actuations", str(vents) if vents == vents else "-", ""
    if measures is not None:
        yield "air consumed", _number(measures.air_consumed_nl), "NL"


def gauge_of(verdict: Verdict) -> Gauge | None:
    """Return value and bounds on a scale of 100 that holds them and zero; None without a bound."""
    bounds = [bound for bound in (verdict.lower, verdict.upper) if bound is not None]
    if not bounds:
        return None
    known = [*bounds, 0.0, *([] if verdict.value is None else [verdict.value])]
    low, high = min(known), max(known)
    air = 0.08 * (high - low) or 1.0
    high += air
    low -= air if low < 0 else 0.0

    def at(value: float) -> float:
        return round(100 * (value - low) / (high - low), 1)

    first = 0.0 if verdict.lower is None else at(verdict.lower)
    last = 100.0 if verdict.upper is None else at(verdict.upper)
    return Gauge(first, last, None if verdict.value is None else at(verdict.value))


def plots_json() -> str:
    """Return what all cases have in common: panels, loops and their lines."""
    panels = [panel_form(panel, panel_lines(panel)) for panel in PANELS]
    loops = [
        dataclasses.asdict(loop)
        | {
            "of_wheelsets": QUANTITIES[loop.across].of_wheelsets,
            "lines": [dataclasses.asdict(line) for line in lines_of(loop.up)],
        }
        for loop in LOOPS
    ]
    quantities = {key: dataclasses.asdict(quantity) for key, quantity in QUANTITIES.items()}
    return script_json({"panels": panels, "loops": loops, "quantities": quantities})


def _data(trace: Trace, marks: Sequence[Mark]) -> dict[str, Any]:
    return {
        "time": packed(trace.time),
        "series": {name: packed(series) for name, series in trace.series.items()},
        "marks": [dataclasses.asdict(mark) for mark in marks],
    }


def _number(value: float) -> str:
    """Return a figure for a headline: four significant digits, an empty text where there is none."""
    return "" if value != value else f"{value:.4g}" if abs(value) < 1e4 else f"{value:.0f}"

"""The data of one drawn case on a page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from uictest.judging import evaluation
from uictest.report.content import CaseDescription
from uictest.report.difference import Difference, case_explanation, case_word
from uictest.report.escaping import printable
from uictest.report.page.links import case_anchor, fragment
from uictest.report.page.repeats_view import RepeatsView, repeats_view
from uictest.report.page.stop.drawing import Drawing, drawing_of
from uictest.report.page.stop.margins import Margins, margins_of
from uictest.report.page.stop.mark import Mark
from uictest.report.page.stop.marks import fault_marks, marks_of
from uictest.report.page.stop.overlay_view import packed, panel_form, script_json
from uictest.report.part_wording import slide_speed
from uictest.report.repeat_wording import band_text
from uictest.report.traces.quantities import (
    LOOPS,
    ORDINARY_CREEP,
    PANELS,
    PLOT_QUANTITIES,
    STRIPS,
    VENT,
    WHEELSETS,
    Panel,
    key_of,
    loop_lines,
    panel_lines,
)
from uictest.report.traces.trace import BINS, MOST_SAMPLES, Curve, PlotTrace
from uictest.report.traces.vent_cycles import VentCycle
from uictest.report.verdict_sentences import real_time_sentences

_COMPARED = (
    Panel("speed", "Speed of train (bold) and wheelset", "km/h", ("wheel_speed", "speed"), 1.5),
    Panel("slide", "Slide", "%", ("slide",), include=(0.0, ORDINARY_CREEP)),
    Panel("pressure", "Tank pressure", "bar", ("tank_pressure",)),
    Panel("force", "Clamping force of one caliper", "kN", ("clamping_force",)),
    Panel("deceleration", "Deceleration", "g", ("deceleration",)),
    Panel("adhesion", "Adhesion", "dimensionless", ("adhesion",)),
)
"""Panels of two stops laid over each other, from top to bottom; the valves stand below the first."""

EDGES = ("lowest", "highest")
"""What stands before the name of a line whose band these edges have."""

HeadlineMeasure = tuple[str, str, str]
"""Label, number (empty where there is none), unit."""


class CaseView(NamedTuple):
    """A drawn case. `anchor` is that of its part of the page; `data` is the JSON its plots are drawn from.

    `explanation` is empty where the case passes; `note` says what lines show; `command` runs the case alone
    and is empty where there is no such command. `band` says what the band behind the lines
    spans and is empty without one.
    """

    anchor: str
    result: evaluation.CaseResult
    subject: CaseDescription
    word: str
    explanation: Sequence[str]
    headline: Sequence[HeadlineMeasure]
    drawing: Drawing
    data: str
    margins: Margins
    note: str
    repeats: RepeatsView | None = None
    command: str = ""
    band: str = ""
    vents: Sequence[VentCycle] = ()

    @property
    def fragment(self) -> str:
        """What stands behind the `#` of a link to it."""
        return fragment(self.anchor)


def case_view(
    result: evaluation.CaseResult,
    subject: CaseDescription,
    trace: PlotTrace,
    differences: Sequence[Difference] = (),
    command: str = "",
    accepted: Mapping[str, float] = MappingProxyType({}),
) -> CaseView:
    """Return the view of a case with its plots drawn.

    Args:
        result: of the case.
        subject: its description.
        trace: of the stop that is drawn.
        differences: those from the baseline.
        command: what runs the case alone; empty where there is no such command.
        accepted: criterion -> its value in the baseline.

    """
    drawn = result.drawn_stop
    marks = [*fault_marks(trace), *marks_of(drawn.criteria, trace)]
    return CaseView(
        case_anchor(result.id),
        result,
        subject,
        case_word(result, differences),
        case_explanation(result, differences) if differences or not result.met else (),
        list(_headline(result)),
        drawing_of(trace),
        script_json(plot_data(result.id, trace, marks, recorded=bool(subject.recorded))),
        margins_of(result.criteria, drawn.criteria, trace, accepted),
        " ".join(_notes(drawn, subject, trace)),
        repeats_view(result),
        command,
        band_text(result, trace.band_stops),
        trace.vents,
    )


def _notes(result: evaluation.CaseResult, subject: CaseDescription, trace: PlotTrace) -> Iterator[str]:
    yield from (f"{sentence[:1].upper()}{sentence[1:]}." for sentence in real_time_sentences(result))
    if result.controller_log:
        yield f"The controller printed: {result.controller_log}."
    for span in trace.faults:
        yield f"Fault {span.label} from {span.start:.4g} s to {span.end:.4g} s."
    yield sampling_text(trace)
    for low, _ in list(trace.band.values())[:1]:
        part = _milliseconds(float(low.x[1] - low.x[0]))
        yield f"The band takes the lowest and the highest sample of every {part}."
    labels = dict.fromkeys(PLOT_QUANTITIES[key_of(name)].label for name in trace.derived)
    if labels:
        yield f"Derived from recorded speeds: {', '.join(labels)}."
    if not trace.states:
        return
    every = _milliseconds(trace.interval)
    recorded = f", but none between two samples, {every} apart" if subject.recorded else ""
    yield f"Valves show every change that was recorded{recorded}."
    drawn = sum(len(trace.valve_spans(n, (VENT,))) for n in WHEELSETS)
    counted = sum(wheelset["valve_actuations"] for wheelset in result.wheelsets)
    if drawn < counted:
        yield (
            f"The recording holds {drawn} of {counted:.0f} vents: those shorter than {every} can lie between"
            " two samples."
        )


def sampling_text(trace: PlotTrace) -> str:
    """Return how the points of a line were taken from the stop."""
    part = _milliseconds((trace.end - trace.start) / BINS)
    is_long = trace.interval * MOST_SAMPLES < trace.end - trace.start
    drawn = f" Drawn through the smallest and the largest sample of every {part}." if is_long else ""
    rounded = (
        "Samples are rounded to a fifth of the last decimal that the cursor shows; instants in the plots are"
        " those of samples, while a simulation measures at every step."
    )
    return f"Sampled every {_milliseconds(trace.interval)}.{drawn} {rounded}"


def _milliseconds(seconds: float) -> str:
    return f"{1e3 * seconds:.3g} ms"


def _headline(result: evaluation.CaseResult) -> Iterator[HeadlineMeasure]:
    """Yield the measures that a brake engineer looks at first."""
    measures = result.measures
    if measures is not None:
        yield "braking distance", _number(measures["braking_distance_m"]), "m"
        corrected = measures["corrected_distance_m"]
        if math.isfinite(corrected) and corrected != measures["braking_distance_m"]:
            yield "corrected distance", _number(corrected), "m"
        yield "reference distance", _number(measures["reference_distance_m"]), "m"
        yield "braking time", _number(measures["braking_time_s"]), "s"
        yield "mean deceleration", _number(measures["mean_deceleration_mps2"]), "m/s²"
        yield "initial adhesion", _number(measures["initial_adhesion_g"]), "g"
        yield "deceleration distance", _number(measures["deceleration_distance_m"]), "m"
        yield "adhesion utilisation", _number(100.0 * measures["adhesion_utilisation"]), "%"
        yield "reservoir margin", _number(measures["reservoir_margin_bar"]), "bar"
    if result.wheelsets:
        slides = [100 * wheelset["maximum_slide"] for wheelset in result.wheelsets]
        yield f"largest slide above {slide_speed([result])}", _number(max(slides)), "%"
        vents = sum(wheelset["valve_actuations"] for wheelset in result.wheelsets)
        yield "valve actuations", f"{vents:g}" if vents == vents else "-", ""
    if measures is not None:
        yield "air consumed", _number(measures["air_consumed_nl"]), "NL"
        if measures.get("track_brake_time_s", 0.0) > 0.0:
            yield "heat of the track brake", _number(measures["track_brake_energy_kj"]), "kJ"


def plots_json() -> str:
    """Return what all cases have in common: panels, loops and their lines."""
    panels = [panel_form(panel, panel_lines(panel)) for panel in PANELS]
    loops = [
        loop._asdict() | {"lines": [line._asdict() | {"over": across} for across, line in loop_lines(loop)]}
        for loop in LOOPS
    ]
    quantities = {key: quantity._asdict() for key, quantity in PLOT_QUANTITIES.items()}
    strips = [
        {
            **strip._asdict(),
            "lanes": [lane._asdict() for lane in strip.lanes],
            "heading": strip.heading,
            "rows": strip.rows,
        }
        for strip in STRIPS
    ]
    compared = [panel_form(panel, panel_lines(panel)) for panel in _COMPARED]
    return script_json(
        {
            "panels": panels,
            "loops": loops,
            "quantities": quantities,
            "strips": strips,
            "compared": compared,
        }
    )


def plot_data(
    title: str, trace: PlotTrace, marks: Sequence[Mark] = (), *, recorded: bool = False
) -> dict[str, Any]:
    """Return what the script draws a stop from; `recorded` where the stop was not simulated."""
    states = {name: Curve(each.time, each.state.astype(np.float64)) for name, each in trace.states.items()}
    steps = {name: PLOT_QUANTITIES[key_of(name)].step for name in trace.curves}
    edges = {
        f"{end} {name}": edge
        for name, band in trace.band.items()
        for end, edge in zip(EDGES, band, strict=True)
    }
    band = {"band": packed(edges, 0.0, {each: steps[each.split()[1]] for each in edges})} if edges else {}
    return {
        **band,
        "id": printable(title),
        "recorded": recorded,
        "sampling": sampling_text(trace),
        "start": trace.start,
        "end": trace.end,
        "over_time": packed({**trace.curves, **states}, trace.interval, steps),
        "marks": [mark._asdict() for mark in marks],
    }


def _number(value: float) -> str:
    """Return a number for a headline: four significant digits, an empty text where there is none."""
    return "" if value != value else f"{value:.4g}" if abs(value) < 1e4 else f"{value:.0f}"

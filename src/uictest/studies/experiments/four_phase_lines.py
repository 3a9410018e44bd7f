"""The lines of the four-phase hysteresis model, from a stop with sliding."""

from __future__ import annotations

from functools import partial

import numpy as np

from uictest import identification
from uictest.recording import Recording
from uictest.studies.figures.four_phase_lines import draw
from uictest.studies.phases import TITLES, identified_lines, on_phases
from uictest.studies.quantity import StudyQuantity, StudyValue
from uictest.studies.replay import CYCLE, replayed
from uictest.studies.stop_runner import StopRunner
from uictest.studies.study import Study, StudyFindings, Table, column
from uictest.units import BAR, KILONEWTON, KILONEWTON_PER_BAR

_NAN = float("nan")
_EVERY = 20

QUANTITIES = tuple(
    quantity
    for phase, title in TITLES.items()
    for quantity in (
        StudyQuantity(f"{phase}_slope", f"{title}, slope", "kN/bar", digits=3),
        StudyQuantity(f"{phase}_intercept", f"{title}, intercept", "kN", digits=3),
    )
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Identify the four lines in module 1 of a slide test; the brake is released after standstill."""
    case = stop_runner.cases("slide-80")[0]
    stop = stop_runner.recordings([case], CYCLE)[0]
    recording = replayed(case, stop, 1, release=True)
    hysteresis = identified_lines(recording)
    return StudyFindings(
        dict(_values(hysteresis)),
        tables={"lines": _lines_table(hysteresis), "samples": _samples_table(recording)},
        drawings={"four-phase-lines": partial(draw, recording, hysteresis)},
        notes=(_order(hysteresis),),
    )


def _values(hysteresis: identification.HysteresisResult) -> list[tuple[str, StudyValue]]:
    values = []
    for phase in TITLES:
        line = hysteresis.lines.get(phase)
        slope = line.slope / KILONEWTON_PER_BAR if line else _NAN
        intercept = line.intercept / KILONEWTON if line else _NAN
        values += [(f"{phase}_slope", StudyValue(slope)), (f"{phase}_intercept", StudyValue(intercept))]
    return values


def _order(hysteresis: identification.HysteresisResult) -> str:
    """Return the note on which releasing line lies above the other: the paper says both."""
    if "wsp_releasing" not in hysteresis.lines:
        return "The stop holds no WSP releasing, so that the order of the releasing lines stays open."
    force = hysteresis.high_force
    above = hysteresis.lines["wsp_releasing"].pressure(force) < hysteresis.lines["bc_releasing"].pressure(
        force
    )
    upper, lower = ("WSP", "BC") if above else ("BC", "WSP")
    return (
        "The text of the paper orders the releasing lines of BC and WSP both ways; "
        f"here, at high force, that of the {upper} lies above that of the {lower}."
    )


def _lines_table(hysteresis: identification.HysteresisResult) -> Table:
    lines = [hysteresis.lines.get(phase) for phase in TITLES]
    return {
        "phase": list(TITLES),
        "slope_kn_per_bar": [line.slope / KILONEWTON_PER_BAR if line else _NAN for line in lines],
        "slope_confidence_kn_per_bar": [
            line.slope_confidence / KILONEWTON_PER_BAR if line else _NAN for line in lines
        ],
        "intercept_kn": [line.intercept / KILONEWTON if line else _NAN for line in lines],
        "intercept_confidence_kn": [
            line.intercept_confidence / KILONEWTON if line else _NAN for line in lines
        ],
        "points": [line.points if line else 0 for line in lines],
    }


def _samples_table(recording: Recording) -> Table:
    shown_samples = slice(None, None, _EVERY)
    names = np.full(len(recording), "inside the loop", dtype=object)
    for phase, mask in on_phases(recording).items():
        names[mask] = phase
    return {
        "time_s": column(recording["time"][shown_samples], 1.0, 3),
        "measured_pressure_1_bar": column(recording["measured_pressure_1"][shown_samples], BAR, 4),
        "clamping_force_1_kn": column(recording["clamping_force_1"][shown_samples], KILONEWTON, 4),
        "phase": names[shown_samples].tolist(),
    }


STUDY = Study(
    "four-phase-lines",
    "Slope and intercept of force against pressure in four phases",
    "clamping force is linear in pressure, with a slope and an intercept of its own in each of four phases",
    QUANTITIES,
    run,
    position=20,
)

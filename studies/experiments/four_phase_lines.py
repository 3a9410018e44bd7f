"""The lines of the four-phase hysteresis model, from a stop with sliding."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import product

import numpy as np

from studies.figures.four_phase_lines import draw
from studies.judged_conditions import judged_conditions
from studies.model_errors import UNITS_OF_ERRORS
from studies.phases import TITLES, LineErrors, held_out_errors, identified_lines, on_phases
from studies.quantity import NOT_ASKED, OwnBand, Status, StudyQuantity, StudyValue, spread
from studies.replay import replayed_in_turn
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table, column
from uictest import Recording
from uictest.rig import identification
from uictest.units import BAR, KILONEWTON, KILONEWTON_PER_BAR

_NAN = float("nan")
_EVERY = 20

WHEELSETS = (1, 2, 3, 4)
_MOTIONS = ("squeezing", "releasing")
_ERROR = UNITS_OF_ERRORS["force_error"]


def _quantities() -> Iterator[StudyQuantity]:
    for phase, title in TITLES.items():
        for name, unit in (("slope", "kN/bar"), ("intercept", "kN")):
            yield StudyQuantity(
                f"{phase}_{name}", f"{title}, {name}", unit, status="by construction", digits=3
            )
    for motion in _MOTIONS:
        yield StudyQuantity(
            f"{motion}_apart",
            f"BC and WSP {motion} lines, difference over its confidence",
            "",
            "a line of its own in each phase",
            status="calibrated",
            band=OwnBand(lower=1.0, reason="ours") if motion == "releasing" else None,
        )
    # The bench test of the four lines was chosen while the errors of `thermal`, which has them, were watched.
    held_out: tuple[tuple[str, str, Status], ...] = (
        ("four", "four lines", "selected"),
        ("two", "the BC lines in every phase", "predicted"),
    )
    for (lines, words, status), statistic in product(held_out, ("largest", "rms")):
        title = f"{statistic} force error, {words}"
        yield StudyQuantity(f"{lines}_{statistic}", title, _ERROR, NOT_ASKED, status=status, digits=2)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Identify the four lines in a slide test, released after standstill; judge those of the compensation."""
    case = stop_runner.cases("slide-80")[0]
    stop = stop_runner.recordings([case])[0]
    recording = replayed_in_turn(case, stop, WHEELSETS, release=True)
    hysteresis = identified_lines(recording)
    errors = held_out_errors(stop_runner, judged_conditions())
    return StudyFindings(
        dict(_values(hysteresis))
        | {f"{motion}_apart": StudyValue(apart(hysteresis, motion)) for motion in _MOTIONS}
        | {
            f"{lines}_{statistic}": spread([getattr(each, statistic) for each in of_lines])
            for lines, of_lines in errors.items()
            for statistic in ("largest", "rms")
        },
        tables={"lines": _lines_table(hysteresis), "samples": _samples_table(recording)},
        drawings={"four-phase-lines": partial(draw, recording, hysteresis)},
        notes=(_order(hysteresis), _gain(errors)),
    )


def apart(hysteresis: identification.HysteresisResult, motion: str) -> float:
    """Return how far the BC and the WSP line of a motion are apart: slope or intercept, over its confidence.

    NaN where one of them is missing.
    """
    bc, wsp = (hysteresis.lines.get(f"{pair}_{motion}") for pair in ("bc", "wsp"))
    if bc is None or wsp is None:
        return _NAN
    slope, intercept = wsp.slope - bc.slope, wsp.intercept - bc.intercept
    slope /= float(np.hypot(bc.slope_confidence, wsp.slope_confidence))
    intercept /= float(np.hypot(bc.intercept_confidence, wsp.intercept_confidence))
    return max(abs(slope), abs(intercept))


def _gain(errors: Mapping[str, Sequence[LineErrors]]) -> str:
    """Return the note on what four lines gain over two."""
    pairs = list(zip(errors["four"], errors["two"], strict=True))
    nearer = {
        statistic: sum(getattr(four, statistic) < getattr(two, statistic) for four, two in pairs)
        for statistic in ("largest", "rms")
    }
    return (
        f"Force from the pressure of module 1 along {len(pairs)} replays of the judged conditions: the "
        f"compensation's four lines are nearer than its BC lines alone in {nearer['largest']} of them by the "
        f"largest error, in {nearer['rms']} by the rms error."
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
    tuple(_quantities()),
    run,
    position=20,
)

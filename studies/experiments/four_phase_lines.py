"""The lines of the four-phase hysteresis model, from a stop with sliding."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from studies.drawing import MUTED, PHASE_COLOURS, WIDTH, from_zero
from studies.model_errors import UNITS_OF_ERRORS, JudgedConditions, judged_cases, judged_conditions
from studies.quantity import NOT_ASKED, OwnBand, Status, StudyQuantity, StudyValue, spread
from studies.replay import PHASES, identified_lines, on_phases, replayed, replayed_in_turn
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table, samples
from uictest import Case, Recording
from uictest.rig import identification
from uictest.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, PERCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAN = float("nan")
_EVERY = 20

WHEELSETS = (1, 2, 3, 4)
_MOTIONS = ("squeezing", "releasing")
_ERROR = UNITS_OF_ERRORS["force_error"]


def _quantities() -> Iterator[StudyQuantity]:
    for phase, title in PHASES.items():
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


@dataclass(frozen=True, slots=True)
class LineErrors:
    """Errors of the force that lines compute from the pressure of module 1, % of the largest force."""

    largest: float
    rms: float


def held_out_errors(stop_runner: StopRunner, conditions: JudgedConditions) -> dict[str, list[LineErrors]]:
    """Return the errors of the compensation's `four` lines, and of its `two` BC lines, along judged stops.

    Every wheelset of the conditions is replayed, under the first of their seeds.
    """
    cases = judged_cases(stop_runner, replace(conditions, seeds=conditions.seeds[:1]))
    stops = stop_runner.recordings(cases)
    work = [(case, stop, n) for case, stop in zip(cases, stops, strict=True) for n in conditions.wheelsets]
    return {
        "four": stop_runner.map(lambda each: _errors(*each), work),
        "two": stop_runner.map(lambda each: _errors(with_bc_lines(each[0]), *each[1:]), work),
    }


def with_bc_lines(case: Case) -> Case:
    """Return a case whose compensation has the lines of the BC in the phases of the WSP as well."""
    rig = case.scenario.rig
    model, lines = rig.compensation_model, rig.compensation_model.hysteresis
    two = {"wsp_squeezing": lines.bc_squeezing, "wsp_releasing": lines.bc_releasing}
    changed = model.model_copy(update={"hysteresis": lines.model_copy(update=two)})
    changed_rig = rig.model_copy(update={"compensation_model": changed})
    return replace(case, scenario=case.scenario.model_copy(update={"rig": changed_rig}))


def _errors(case: Case, stop: Recording, wheelset: int) -> LineErrors:
    recording = replayed(case, stop, wheelset)
    measured = recording["clamping_force_1"]
    error = (recording["computed_force_1"] - measured) / measured.max() / PERCENT
    return LineErrors(float(np.abs(error).max()), float(np.sqrt(np.mean(error**2))))


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
    for phase in PHASES:
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
    lines = [hysteresis.lines.get(phase) for phase in PHASES]
    return {
        "phase": list(PHASES),
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
    phases = np.full(len(recording), "inside the loop", dtype=object)
    for phase, mask in on_phases(recording).items():
        phases[mask] = phase
    channels = ("time_s", "measured_pressure_1_bar", "clamping_force_1_kn")
    return samples(recording, *channels, every=_EVERY) | {"phase": phases[::_EVERY].tolist()}


_DRAWN_EVERY = 10
_HEADROOM = 1.15
"""Height of the axes over the largest force: room for the legend."""


def draw(recording: Recording, hysteresis: identification.HysteresisResult, figure: Figure) -> None:
    """Draw the BC phases on the left and the WSP phases on the right."""
    figure.set_size_inches(WIDTH, 3.5)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    _draw_pair(left, recording, hysteresis, "bc")
    _draw_pair(right, recording, hysteresis, "wsp")
    left.set(title="Ordinary braking (BC)", xlabel="cylinder pressure, bar", ylabel="clamping force, kN")
    right.set(title="While the WSP acts", xlabel="cylinder pressure, bar")
    from_zero(left)
    left.set_ylim(top=_HEADROOM * hysteresis.largest_force / KILONEWTON)


def _draw_pair(
    axes: Axes, recording: Recording, hysteresis: identification.HysteresisResult, pair: str
) -> None:
    pressure, force = recording["measured_pressure_1"] / BAR, recording["clamping_force_1"] / KILONEWTON
    axes.plot(pressure[::_DRAWN_EVERY], force[::_DRAWN_EVERY], color=MUTED, alpha=0.35, linewidth=0.7)
    for phase, mask in on_phases(recording).items():
        if phase.startswith(pair):
            points = np.flatnonzero(mask)[::_DRAWN_EVERY]
            axes.plot(pressure[points], force[points], ".", color=PHASE_COLOURS[phase], markersize=2.5)
    for phase, line in hysteresis.lines.items():
        if phase.startswith(pair):
            ends = np.array([line.pressure(1e-9), line.pressure(hysteresis.largest_force)])
            slope = line.slope * BAR / KILONEWTON
            intercept = line.intercept / KILONEWTON
            label = f"{PHASES[phase]}: {slope:.2f} kN/bar, {intercept:.2f} kN".replace("-", "\N{MINUS SIGN}")
            axes.plot(ends / BAR, line.force(ends) / KILONEWTON, color=PHASE_COLOURS[phase], label=label)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left")
    else:
        axes.text(0.05, 0.95, "not in this stop", transform=axes.transAxes, va="top", color=MUTED)


STUDY = Study(
    "four-phase-lines",
    "Slope and intercept of force against pressure in four phases",
    "clamping force is linear in pressure, with a slope and an intercept of its own in each of four phases",
    tuple(_quantities()),
    run,
    position=20,
)

"""The four lines of force against pressure in a bench recording, and their slopes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from studies.judged_conditions import JudgedConditions, judged_cases
from studies.replay import replayed
from studies.stop_runner import StopRunner
from studies.study import Table
from uictest import Case, Recording
from uictest.rig import identification
from uictest.units import KILONEWTON, KILONEWTON_PER_BAR, PERCENT

TITLES = {
    "bc_squeezing": "BC squeezing",
    "bc_releasing": "BC releasing",
    "wsp_squeezing": "WSP squeezing",
    "wsp_releasing": "WSP releasing",
}
"""The phases of the paper's hysteresis model, in its order."""


def identified_lines(recording: Recording) -> identification.HysteresisResult:
    """Return the lines of the caliper's force, identified as by `uictest identify hysteresis`."""
    return identification.identify_hysteresis(
        recording["time"],
        recording["measured_pressure_1"],
        recording["clamping_force_1"],
        recording["wsp_acting"] > 0.0,
    )


def on_phases(recording: Recording) -> dict[str, NDArray[np.bool_]]:
    """Return which samples lie on the line of each phase; those inside the loop lie on none."""
    step = float(recording["time"][1] - recording["time"][0])
    squeezing, releasing = identification.on_lines(
        recording["measured_pressure_1"], recording["clamping_force_1"], step
    )
    acting = recording["wsp_acting"] > 0.0
    return {
        "bc_squeezing": squeezing & ~acting,
        "bc_releasing": releasing & ~acting,
        "wsp_squeezing": squeezing & acting,
        "wsp_releasing": releasing & acting,
    }


_NAN = float("nan")


@dataclass(frozen=True, slots=True)
class Loop:
    """One stop: the varied value as written, the recording of its replay, and the identified lines."""

    level: str
    recording: Recording
    lines: identification.HysteresisResult


def loops(stop_runner: StopRunner, cases: Sequence[Case]) -> list[Loop]:
    """Return the loop of module 1 in the stop of every case, the brake released after the standstill."""
    stops = stop_runner.recordings(cases)
    return stop_runner.map(lambda pair: _loop(*pair), list(zip(cases, stops, strict=True)))


def _loop(case: Case, stop: Recording) -> Loop:
    recording = replayed(case, stop, 1, release=True)
    return Loop(" ".join(case.parameters.values()), recording, identified_lines(recording))


def slope_spread(stop_loops: Sequence[Loop]) -> float:
    """Return the largest range of a phase's slope among the stops, as a share of its mean."""
    spreads = []
    for phase in TITLES:
        slopes = [loop.lines.lines[phase].slope for loop in stop_loops if phase in loop.lines.lines]
        if len(slopes) > 1:
            spreads.append((max(slopes) - min(slopes)) * len(slopes) / math.fsum(slopes))
    return max(spreads, default=_NAN)


def slopes_table(stop_loops: Sequence[Loop], varied: str) -> Table:
    """Return slope and intercept of every phase of every stop; `varied` names the varied parameter."""
    rows = [
        (loop.level, phase, loop.lines.lines.get(phase), loop.lines.largest_force)
        for loop in stop_loops
        for phase in TITLES
    ]
    return {
        varied: [level for level, _, _, _ in rows],
        "phase": [phase for _, phase, _, _ in rows],
        "slope_kn_per_bar": [line.slope / KILONEWTON_PER_BAR if line else _NAN for _, _, line, _ in rows],
        "intercept_kn": [line.intercept / KILONEWTON if line else _NAN for _, _, line, _ in rows],
        "largest_force_kn": [force / KILONEWTON for _, _, _, force in rows],
    }


@dataclass(frozen=True, slots=True)
class LineErrors:
    """Errors of the force that lines compute from the pressure of module 1, % of the largest force."""

    largest: float
    rms: float


def held_out_errors(stop_runner: StopRunner, conditions: JudgedConditions) -> dict[str, list[LineErrors]]:
    """Return the errors of the compensation's `four` lines, and of its `two` BC lines, along judged stops.

    Every wheelset of the conditions is replayed, under the first of their seeds.
    """
    cases = judged_cases(stop_runner, conditions.model_copy(update={"seeds": conditions.seeds[:1]}))
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

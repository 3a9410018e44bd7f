"""Spread of the slopes of force against pressure among stops."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from uictest.core.recording import Recording
from uictest.core.units import KILONEWTON, KILONEWTON_PER_BAR
from uictest.plans import scenario
from uictest.rig import identification
from uictest.studies.phases import TITLES, identified_lines
from uictest.studies.replay import CYCLE, replayed
from uictest.studies.stop_runner import StopRunner
from uictest.studies.study import Table

_NAN = float("nan")


@dataclass(frozen=True, slots=True)
class Loop:
    """One stop: the varied value as written, the recording of its replay, and the identified lines."""

    level: str
    recording: Recording
    lines: identification.HysteresisResult


def loops(stop_runner: StopRunner, cases: Sequence[scenario.Case]) -> list[Loop]:
    """Return the loop of module 1 in the stop of every case, the brake released after the standstill."""
    stops = stop_runner.recordings(cases, CYCLE)
    return stop_runner.map(lambda pair: _loop(*pair), list(zip(cases, stops, strict=True)))


def _loop(case: scenario.Case, stop: Recording) -> Loop:
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

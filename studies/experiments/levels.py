"""Stops at levels of the command, and of the friction of the rail: the slopes of force against pressure."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from studies.drawing import MUTED, PHASE_COLOURS, WIDTH, from_zero
from studies.quantity import NOT_PUBLIC, OwnBand, StudyQuantity, StudyValue
from studies.replay import PHASES, identified_lines, replayed
from studies.stop_runner import StopRunner, measured
from studies.study import Study, StudyFindings, Table
from uictest import Case, Recording
from uictest.rig import identification
from uictest.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COMMANDS = (80, 90, 100)
_FRICTIONS = ("0.09", "0.10", "0.11", "0.12")
_NAN = float("nan")
_EVERY = 10
_WIDTHS = {"bc": 2.6, "ws": 1.0}
"""Line widths: the lines of the WSP are drawn over the wider ones of the BC."""


def _slope_spread(levels: str, paper: str) -> StudyQuantity:
    # The simulated caliper knows neither command nor rail: only what is identified of it could change.
    title, band = f"largest change of a slope among the {levels}", OwnBand(upper=5.0, reason="ours")
    return StudyQuantity("slope_spread", title, "%", paper, status="by construction", band=band)


def _command_quantities() -> Iterator[StudyQuantity]:
    yield _slope_spread("command levels", "unchanged")
    for level in _COMMANDS:
        key, title = f"force_at_{level}", f"largest clamping force at {level} % command"
        yield StudyQuantity(key, title, "kN", status="by construction", digits=2)


def _friction_quantities() -> Iterator[StudyQuantity]:
    yield _slope_spread("friction coefficients", NOT_PUBLIC)
    for level in _FRICTIONS:
        yield StudyQuantity(_distance_key(level), f"braking distance at {level}", "m", status="predicted")


def _distance_key(level: str) -> str:
    return f"distance_at_{level.replace('.', '')}"


@dataclass(frozen=True, slots=True)
class Loop:
    """One stop: the varied value as written, the recording of its replay, and the identified lines."""

    level: str
    recording: Recording
    lines: identification.HysteresisResult


def run_commands(stop_runner: StopRunner) -> StudyFindings:
    """Identify the slopes at every command level."""
    stop_loops = loops(stop_runner, stop_runner.cases("wet-80-command"))
    forces = {
        f"force_at_{level}": StudyValue(loop.lines.largest_force / KILONEWTON)
        for level, loop in zip(_COMMANDS, stop_loops, strict=True)
    }
    return StudyFindings(
        {"slope_spread": StudyValue(slope_spread(stop_loops) / PERCENT), **forces},
        tables={"lines": slopes_table(stop_loops, "command")},
        drawings={"command-level": partial(draw, stop_loops, "command {}")},
    )


def run_frictions(stop_runner: StopRunner) -> StudyFindings:
    """Identify the slopes at every friction coefficient, and the braking distances."""
    cases = stop_runner.cases("wet-80-friction")
    stop_loops = loops(stop_runner, cases)
    distances = {
        _distance_key(level): StudyValue(measured(repeats.stops[0], "braking_distance_m"))
        for level, repeats in zip(_FRICTIONS, stop_runner.repeated(cases, [0]), strict=True)
    }
    return StudyFindings(
        {"slope_spread": StudyValue(slope_spread(stop_loops) / PERCENT), **distances},
        tables={"lines": slopes_table(stop_loops, "friction")},
        drawings={"friction-level": partial(draw, stop_loops, "friction {}")},
    )


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
    for phase in PHASES:
        slopes = [loop.lines.lines[phase].slope for loop in stop_loops if phase in loop.lines.lines]
        if len(slopes) > 1:
            spreads.append((max(slopes) - min(slopes)) * len(slopes) / math.fsum(slopes))
    return max(spreads, default=_NAN)


def slopes_table(stop_loops: Sequence[Loop], varied: str) -> Table:
    """Return slope and intercept of every phase of every stop; `varied` names the varied parameter."""
    rows = [
        (loop.level, phase, loop.lines.lines.get(phase), loop.lines.largest_force)
        for loop in stop_loops
        for phase in PHASES
    ]
    return {
        varied: [level for level, _, _, _ in rows],
        "phase": [phase for _, phase, _, _ in rows],
        "slope_kn_per_bar": [line.slope / KILONEWTON_PER_BAR if line else _NAN for _, _, line, _ in rows],
        "intercept_kn": [line.intercept / KILONEWTON if line else _NAN for _, _, line, _ in rows],
        "largest_force_kn": [force / KILONEWTON for _, _, _, force in rows],
    }


def draw(stop_loops: Sequence[Loop], title: str, figure: Figure) -> None:
    """Draw force over pressure with the lines of the phases, a panel per stop; `title` has braces for it."""
    figure.set_size_inches(WIDTH, 3.1)
    panels = figure.subplots(1, len(stop_loops), sharex=True, sharey=True)
    for axes, loop in zip(panels, stop_loops, strict=True):
        pressure = loop.recording["measured_pressure_1"][::_EVERY] / BAR
        force = loop.recording["clamping_force_1"][::_EVERY] / KILONEWTON
        axes.plot(pressure, force, color=MUTED, alpha=0.5, linewidth=0.7)
        for phase, line in loop.lines.lines.items():
            ends = np.array([line.pressure(1e-9), line.pressure(loop.lines.largest_force)])
            axes.plot(
                ends / BAR,
                line.force(ends) / KILONEWTON,
                color=PHASE_COLOURS[phase],
                linewidth=_WIDTHS[phase[:2]],
                label=PHASES[phase],
                zorder=3,
            )
        axes.set(title=title.format(loop.level), xlabel="pressure, bar")
    from_zero(panels[0])
    panels[0].set_ylabel("clamping force, kN")
    handles = {
        label: line for axes in panels for line, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)


COMMAND_LEVEL = Study(
    "command-level",
    "Force against pressure at 80, 90 and 100 % of the full command",
    "the command level does not change the slopes of force against pressure",
    tuple(_command_quantities()),
    run_commands,
    position=50,
)
FRICTION_LEVEL = Study(
    "friction-level",
    "Force against pressure with initial friction coefficients from 0.09 to 0.12",
    "stops at full command with initial friction coefficients 0.09, 0.10, 0.11 and 0.12",
    tuple(_friction_quantities()),
    run_frictions,
    position=60,
)

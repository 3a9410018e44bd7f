"""Replay the valve commands of a stop on the bench, and identify lines of force against pressure there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uictest import Case, Recording
from uictest.rig import bench, identification

CYCLE = 0.01
"""Time between two samples of a stop to be replayed, s: one controller cycle."""
VENT = 2
"""Of the channels `valve_command_*`."""
_RELEASE = 4.0
"""Time for the brake to release, s."""


def replayed(case: Case, stop: Recording, wheelset: int, *, release: bool = False) -> Recording:
    """Return the bench recording of both modules under the demand and the commands of one wheelset (1..4).

    In the stop each module obeys the commands of its own wheelset, so the two cannot be compared there.

    Args:
        case: the case of the stop.
        stop: its recording, a sample every :data:`CYCLE`.
        wheelset: whose commands are given.
        release: whether the brake is released at the end; without it there is no BC releasing.
    """
    return replayed_in_turn(case, stop, [wheelset], release=release)


def replayed_in_turn(case: Case, stop: Recording, wheelsets: Sequence[int], *, release: bool) -> Recording:
    """Return one bench recording under the commands of several wheelsets, one after the other.

    Arguments are those of :func:`replayed`.
    """
    clock = bench.clock_of(case)
    parts = []
    for wheelset in wheelsets:
        commands = stop[f"valve_command_{wheelset}"]
        parts.append(bench.recorded_input(stop["time"], stop["demanded_pressure"], commands, clock))
        if release:
            parts.append(_releasing(case, float(stop["demanded_pressure"][-1]), clock))
    return bench.run_bench(case, bench.joined_inputs(parts))


def _releasing(case: Case, pressure: float, clock: bench.Clock) -> bench.BenchInput:
    """Return pressures that hold until the WSP no longer counts as acting, then release."""
    stand = float(case.scenario.rig.compensation_model.hysteresis.wsp_acting_time) + CYCLE
    times = (0.0, stand, stand + clock.step, stand + _RELEASE)
    return bench.bypassed_input(times, (pressure, pressure, 0.0, 0.0), clock)


def maximum_pressure(case: Case) -> float:
    """Return the gauge pressure of a full service application in the brake position of a case, Pa."""
    brake = case.scenario.brake
    return float(brake.system.positions[brake.position].maximum_pressure)


PHASES = {
    "bc_squeezing": "BC squeezing",
    "bc_releasing": "BC releasing",
    "wsp_squeezing": "WSP squeezing",
    "wsp_releasing": "WSP releasing",
}
"""The phases of the paper's hysteresis model in its order, with their titles."""


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

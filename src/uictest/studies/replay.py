"""The valve commands of a stop, given on the bench to a module with a caliper and to one without."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uictest.recording import Recording
    from uictest.rig.bench_inputs import BenchInput, Clock
    from uictest.scenario import Case

CYCLE = 0.01
"""Time between two samples of a stop that is to be replayed, s: that of a controller cycle."""
_RELEASE = 4.0
"""Time given to the brake to release, s."""


def replayed(case: Case, stop: Recording, wheelset: int, *, release: bool = False) -> Recording:
    """Return the bench recording of both modules under the demand and the commands of one wheelset (1..4).

    Only so do both modules obey the same commands: in the stop each obeys those of its own wheelset.

    Args:
        case: the case of the stop.
        stop: its recording, a sample every :data:`CYCLE`.
        wheelset: whose commands are given.
        release: whether the brake is released in the end, without which there is no BC releasing.
    """
    from uictest.rig.bench_inputs import joined, recorded
    from uictest.rig.bench_run import clock_of, run_bench

    clock = clock_of(case)
    commands = stop[f"valve_command_{wheelset}"]
    parts = [recorded(stop["time"], stop["demanded_pressure"], commands, clock)]
    if release:
        parts.append(_releasing(case, float(stop["demanded_pressure"][-1]), clock))
    return run_bench(case, joined(parts))


def _releasing(case: Case, pressure: float, clock: Clock) -> BenchInput:
    """Stand until the WSP no longer counts as acting, then release."""
    from uictest.rig.bench_inputs import bypassed

    stand = float(case.scenario.rig.compensation_model.hysteresis.wsp_acting_time) + CYCLE
    times = (0.0, stand, stand + clock.step, stand + _RELEASE)
    return bypassed(times, (pressure, pressure, 0.0, 0.0), clock)


def maximum_pressure(case: Case) -> float:
    """Pressure of a full service application in the brake position of a case, gauge, Pa."""
    brake = case.scenario.brake
    return float(brake.system.positions[brake.position].maximum_pressure)

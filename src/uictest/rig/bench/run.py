"""Run a bench test: allocate records, step, return channels."""

from collections.abc import Callable
from typing import Any

import numpy as np

from uictest.recording import ORIGIN, Recording
from uictest.rig.bench.inputs import BenchInput, Clock
from uictest.rig.bench.native import run_compiled
from uictest.rig.bench.rig import bench_rig
from uictest.rig.bench.trace import BENCH_CHANNELS, BENCH_SAMPLE
from uictest.scenario import Case


def clock_of(case: Case) -> Clock:
    """Return the base step and the controller cycle of a case."""
    step = float(case.scenario.simulation.time_step)
    return Clock(step, round(float(case.scenario.controller.cycle_time) / step))


def run_bench(case: Case, applied: BenchInput, run: Callable[..., None] = run_compiled) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from.
        applied: demanded pressures and valve commands; see :mod:`uictest.rig.bench.inputs`.
        run: :func:`uictest.rig.bench.step.run_bench_test`, plain or compiled.

    Returns:
        The channels of :data:`~uictest.rig.bench.trace.BENCH_CHANNELS`.
    """
    trace: Any = np.empty(len(applied.demanded_pressures) + 1, BENCH_SAMPLE)
    run(bench_rig(case), applied.demanded_pressures, applied.valve_commands, trace)
    channels = {name: trace[name].copy() for name, _ in BENCH_CHANNELS}
    return Recording(channels, dict(BENCH_CHANNELS), {ORIGIN: "simulated caliper", "bench": case.id})

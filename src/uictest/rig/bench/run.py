"""Run a bench test: allocate records, step, return channels."""

from collections.abc import Callable
from typing import Any

import numpy as np

import uictest
from uictest.core.recording import ORIGIN, Recording
from uictest.plans.scenario import Case, rig_as_built
from uictest.rig.bench.applied import bench_input
from uictest.rig.bench.inputs import BenchInput
from uictest.rig.bench.loading import BenchTest
from uictest.rig.bench.native import run_compiled
from uictest.rig.bench.rig import bench_rig
from uictest.rig.bench.trace import BENCH_CHANNELS, BENCH_SAMPLE
from uictest.rig.identification import AS_BUILT


def run_bench(case: Case, applied: BenchInput, run: Callable[..., None] = run_compiled) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from; the module is that of
            wheelset 1.
        applied: demanded pressures and valve commands; see :mod:`uictest.rig.bench.inputs`.
        run: :func:`uictest.rig.bench.step.run_bench_test`, plain or compiled.

    Returns:
        The channels of :data:`~uictest.rig.bench.trace.BENCH_CHANNELS`.
    """
    trace: Any = np.empty(len(applied.demanded_pressures) + 1, BENCH_SAMPLE)
    run(bench_rig(case), applied.demanded_pressures, applied.valve_commands, trace)
    channels = {name: trace[name].copy() for name, _ in BENCH_CHANNELS}
    return Recording(channels, dict(BENCH_CHANNELS), {ORIGIN: "simulated caliper", "bench": case.id})


def run_test(test: BenchTest) -> Recording:
    """Run a recipe; the recording names the files it was made from and the version of the program."""
    recording = run_bench(test.case, bench_input(test))
    facts = {
        **recording.metadata,
        "version": uictest.__version__,
        **{f"{AS_BUILT}{key}": value.text for key, value in rig_as_built(test.case.scenario).items()},
        **{f"sha256 of {name}": value for name, value in test.case.inputs.items()},
    }
    return Recording(recording.channels, recording.units, facts)

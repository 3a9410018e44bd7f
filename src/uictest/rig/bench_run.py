"""Run a bench test: allocate records, step, return channels."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from uictest.recording import Recording
from uictest.rig.assembly import assemble
from uictest.rig.bench import SETTINGS, bench
from uictest.rig.bench_inputs import BenchInput, Clock
from uictest.rig.bench_trace import BENCH_CHANNELS, LOADCELL_SHARES, ROW
from uictest.rig.compiled import OPTIONS, compiled_operations, translate, use_cache
from uictest.rig.records import CAR, PARAMETERS, WHEELSET
from uictest.scenario import Case


@cache
def compiled_bench() -> Any:
    """Return :func:`uictest.rig.bench.bench` compiled; the first call on a machine takes some seconds."""
    use_cache()
    import numba

    njit: Any = numba.njit(**OPTIONS)
    entry = translate(bench, njit, compiled_operations())
    return numba.njit(**OPTIONS, cache=True)(entry.py_func)


def clock_of(case: Case) -> Clock:
    """The base step and the controller cycle of a case."""
    step = float(case.scenario.simulation.time_step)
    return Clock(step, round(float(case.scenario.controller.cycle_time) / step))


def run_bench(case: Case, applied: BenchInput, stepper: Any = None) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from.
        applied: demand and commands; see :mod:`uictest.rig.bench_inputs`.
        stepper: the plain :func:`uictest.rig.bench.bench`, or the compiled one when left out.

    Returns:
        The channels of :data:`~uictest.rig.bench_trace.BENCH_CHANNELS`.
    """
    trace = np.empty((len(applied.demand) + 1, ROW))
    (stepper or compiled_bench())(
        np.zeros(1, CAR)[0],
        np.zeros(2, WHEELSET),
        np.zeros(4, WHEELSET),
        _settings(case),
        applied.demand,
        applied.commands,
        np.zeros(len(LOADCELL_SHARES)),
        trace,
    )
    channels = {name: trace[:, k].copy() for k, (name, _) in enumerate(BENCH_CHANNELS)}
    return Recording(channels, dict(BENCH_CHANNELS), {"bench": case.id})


def _settings(case: Case) -> Any:
    """The parameters four times, once for each setting of the compensation; the valves obey commands."""
    settings = np.zeros(len(SETTINGS), PARAMETERS)
    settings[:] = assemble(case)[0]
    settings["wsp_active"] = 1
    settings["uses_hysteresis"] = [name in ("hysteresis", "full") for name in SETTINGS]
    settings["uses_cylinder_dynamics"] = [name in ("cylinder", "full") for name in SETTINGS]
    return settings

"""Run a bench test: allocate records, step, return channels."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from uictest.recording import ORIGIN, Recording
from uictest.rig.assembly import assemble
from uictest.rig.backends.compiled import OPTIONS, callback, compiled_operations, translate
from uictest.rig.backends.machine_code import address, is_kept, native_function
from uictest.rig.bench.inputs import BenchInput, Clock
from uictest.rig.bench.step import SETTINGS, bench
from uictest.rig.bench.trace import BENCH_CHANNELS, LOADCELL_SHARES, ROW
from uictest.rig.model.records import CAR, PARAMETERS, WHEELSET
from uictest.scenario import Case

_NAME = "uictest_bench"
_ARGUMENTS = (CAR, WHEELSET, WHEELSET, PARAMETERS, "f8", "i8", "f8", "f8", int, int)


def compiled_bench(
    car: Any,
    modules: Any,
    computed: Any,
    settings: Any,
    demand: Any,
    commands: Any,
    loadcells: Any,
    trace: Any,
) -> None:
    """Run :func:`uictest.rig.bench.step.bench` compiled; the first call on a machine takes some seconds.

    Raises TypeError where a record or an array is not laid out as the code takes it.
    """
    native_function(_NAME, _callback, len(_ARGUMENTS))(
        address(car, CAR),
        address(modules, WHEELSET, (2,)),
        address(computed, WHEELSET, (len(SETTINGS),)),
        address(settings, PARAMETERS, (len(SETTINGS),)),
        address(demand, "f8", (len(trace) - 1,)),
        address(commands, "i8", (len(commands),)),
        address(loadcells, "f8", (len(LOADCELL_SHARES),)),
        address(trace, "f8", (len(trace), ROW)),
        len(commands),
        len(trace),
    )


def is_warm() -> bool:
    """Whether the bench lies compiled in the cache, so that the test starts at once."""
    return is_kept(_NAME)


def _callback() -> Any:
    """Return the bench compiled by numba, as a function of addresses and the lengths behind them."""
    numba: Any = importlib.import_module("numba")  # its functions have no types
    carray = numba.carray
    entry = translate(bench, numba.njit(**OPTIONS), compiled_operations())
    setting_count, loadcell_count = len(SETTINGS), len(LOADCELL_SHARES)

    def on_addresses(
        car: Any,
        modules: Any,
        computed: Any,
        settings: Any,
        demand: Any,
        commands: Any,
        loadcells: Any,
        trace: Any,
        cycles: int,
        rows: int,
    ) -> int:
        entry(
            carray(car, 1)[0],
            carray(modules, 2),
            carray(computed, setting_count),
            carray(settings, setting_count),
            carray(demand, rows - 1),
            carray(commands, cycles),
            carray(loadcells, loadcell_count),
            carray(trace, (rows, ROW)),
        )
        return 0

    return callback(on_addresses, *_ARGUMENTS)


def clock_of(case: Case) -> Clock:
    """The base step and the controller cycle of a case."""
    step = float(case.scenario.simulation.time_step)
    return Clock(step, round(float(case.scenario.controller.cycle_time) / step))


def run_bench(case: Case, applied: BenchInput, stepper: Any = None) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from.
        applied: demand and commands; see :mod:`uictest.rig.bench.inputs`.
        stepper: the plain :func:`uictest.rig.bench.step.bench`, or the compiled one when left out.

    Returns:
        The channels of :data:`~uictest.rig.bench.trace.BENCH_CHANNELS`.
    """
    trace = np.empty((len(applied.demand) + 1, ROW))
    (stepper or compiled_bench)(
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
    return Recording(channels, dict(BENCH_CHANNELS), {ORIGIN: "simulated caliper", "bench": case.id})


def _settings(case: Case) -> Any:
    """The parameters four times, once for each setting of the compensation; the valves obey commands."""
    settings = np.zeros(len(SETTINGS), PARAMETERS)
    settings[:] = assemble(case)[0]
    settings["wsp_active"] = 1
    settings["uses_hysteresis"] = [name in ("hysteresis", "full") for name in SETTINGS]
    settings["uses_cylinder_dynamics"] = [name in ("cylinder", "full") for name in SETTINGS]
    return settings

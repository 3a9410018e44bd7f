"""Run a bench test in machine code: allocate records, step, return a recording."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import uictest
from uictest.core.recording import ORIGIN, Recording
from uictest.plans.scenario import Case, rig_as_built
from uictest.rig.backends.compiled import (
    compile_inner,
    compiled_operations,
    compiler,
    translate,
)
from uictest.rig.backends.machine_code import Entries, Unit, address, native_function
from uictest.rig.bench.applied import bench_input
from uictest.rig.bench.recipe import BenchTest
from uictest.rig.bench.rig import LOADCELLS, MODULES, SETTINGS, BenchInput, BenchRig, bench_rig
from uictest.rig.bench.step import run_bench_test
from uictest.rig.bench.trace import BENCH_CHANNELS, BENCH_SAMPLE
from uictest.rig.identification import AS_BUILT
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.state import CAR, WHEELSET
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

_NAME = "uictest_bench"
_ARGUMENTS = (
    *(CAR, WHEELSET, WHEELSET, PARAMETERS, WHEELSET_PARAMETERS),
    *("f8", "f8", "i8", BENCH_SAMPLE, int, int),
)
_COUNT = len(SETTINGS)


def run_compiled(
    rig: BenchRig, demanded_pressures: NDArray[Any], valve_commands: NDArray[Any], trace: NDArray[Any]
) -> None:
    """Run :func:`uictest.rig.bench.step.run_bench_test` compiled; the first call compiles it.

    Raises TypeError where a record or an array does not have the compiled layout.
    """
    native_function(_UNIT, _NAME, len(_ARGUMENTS))(
        address(rig.car, CAR),
        address(rig.modules, WHEELSET, (MODULES,)),
        address(rig.computed, WHEELSET, (_COUNT,)),
        address(rig.settings, PARAMETERS, (_COUNT,)),
        address(rig.wheelset_parameters, WHEELSET_PARAMETERS),
        address(rig.loadcell_errors, "f8", (LOADCELLS,)),
        address(demanded_pressures, "f8", (len(trace) - 1,)),
        address(valve_commands, "i8", (len(valve_commands),)),
        address(trace, BENCH_SAMPLE, (len(trace),)),
        len(valve_commands),
        len(trace),
    )


def _entries() -> Entries:
    """Return the bench as a function of addresses and the lengths behind them."""
    carray = compiler().carray
    entry = translate(run_bench_test, compile_inner, compiled_operations())

    def on_addresses(
        car: Any,
        modules: Any,
        computed: Any,
        settings: Any,
        wheelset_parameters: Any,
        loadcell_errors: Any,
        pressures: Any,
        commands: Any,
        trace: Any,
        cycles: int,
        rows: int,
    ) -> int:
        rig = BenchRig(
            carray(car, 1)[0],
            carray(modules, MODULES),
            carray(computed, _COUNT),
            carray(settings, _COUNT),
            carray(wheelset_parameters, 1)[0],
            carray(loadcell_errors, LOADCELLS),
        )
        entry(rig, carray(pressures, rows - 1), carray(commands, cycles), carray(trace, rows))
        return 0

    return {_NAME: (on_addresses, _ARGUMENTS)}


_UNIT = Unit(_NAME, {_NAME: "the bench of the rig"}, _entries)


def run_bench(case: Case, applied: BenchInput, run: Callable[..., None] = run_compiled) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from; the module is that of
            wheelset 1.
        applied: demanded pressures and valve commands; see :mod:`uictest.rig.bench.rig`.
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

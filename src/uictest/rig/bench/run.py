"""The bench by the kernel: a test run and recorded, and the air of a record followed as the rig does."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import uictest
from uictest.core.recording import ORIGIN, Recording
from uictest.plans.scenario import Case, rig_as_built
from uictest.rig.assembly import ASSIGNMENTS, assemble, assigned
from uictest.rig.bench.inputs import BenchInput, bench_input
from uictest.rig.bench.recipe import BenchTest
from uictest.rig.bench.step import (
    BENCH_CHANNELS,
    BENCH_SAMPLE,
    LOADCELLS,
    MODULES,
    SETTINGS,
    BenchRig,
    bench_rig,
)
from uictest.rig.identification import AS_BUILT
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.cycle import command_valve
from uictest.rig.model.module_air import follow_tank
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.pneumatics import move_valve
from uictest.rig.model.start import start_module
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.rig.model.wheelset_parameters import (
    WHEELSET_PARAMETERS,
    WheelsetParameters,
    copy_wheelset_parameters,
)

Samples = NDArray[np.float64]

_COUNT, _CYCLES, _ROWS = len(SETTINGS), Length("cycles"), Length("rows")
BENCH = Entry(
    "uictest.rig.bench.step:run_bench_test",
    (
        BenchRig(
            *(at(CAR), at(WHEELSET, MODULES), at(WHEELSET, _COUNT), at(PARAMETERS, _COUNT)),
            *(at(WHEELSET_PARAMETERS), at("f8", LOADCELLS)),
        ),
        *(at("f8", _ROWS - 1), at("i8", _CYCLES), at(BENCH_SAMPLE, _ROWS)),
    ),
)


def run_compiled(
    rig: BenchRig, demanded_pressures: NDArray[Any], valve_commands: NDArray[Any], trace: NDArray[Any]
) -> None:
    """Run :func:`uictest.rig.bench.step.run_bench_test` compiled.

    Raises TypeError where a record or an array does not have the compiled layout.
    """
    native_function(BENCH)(rig, demanded_pressures, valve_commands, trace)


def run_bench(case: Case, applied: BenchInput, run: Callable[..., None] = run_compiled) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from; the module is that of
            wheelset 1.
        applied: demanded pressures and valve commands; see :mod:`uictest.rig.bench.inputs`.
        run: :func:`uictest.rig.bench.step.run_bench_test`, plain or compiled.

    Returns:
        The channels of :data:`~uictest.rig.bench.step.BENCH_CHANNELS`.
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


_AIR = "rig.compensation_model.air"
_OF_AIR = tuple(each for each in ASSIGNMENTS if any(_AIR.startswith(key) for key in each.keys))
"""What sets the parameters that the unknowns decide."""


class ModelledPressure:
    """The cylinder pressure along a record as a function of the air's five unknowns.

    Args:
        channels: time, tank and line pressure and valve commands of the record; Pa, gauge.
        case: the rig that it was recorded on.
        step: sampling time, s.
    """

    def __init__(self, channels: Mapping[str, Samples], case: Case, step: float) -> None:
        self._tank, self._line = (np.ascontiguousarray(channels[name], "f8") for name in ("tank", "line"))
        self._commands = np.ascontiguousarray(channels["command"], "i8")
        simulation = case.scenario.simulation.model_copy(update={"time_step": step})
        self._case = _with(case, simulation=simulation)
        of_rig = assemble(self._case)
        self._parameters = np.array([of_rig.parameters])
        self._of_wheelset = of_rig.wheelset_parameters[:1]

    def __call__(self, unknowns: Samples) -> Samples:
        """Return gauge pressures, Pa, at the record's instants.

        Args:
            unknowns: heat conductances of tank and caliper, W/K; swept volume as a share of a tank's;
                opening pressure, and closing less opening pressure, gauge Pa.
        """
        for name, value in assigned(_OF_AIR, _with_unknowns(self._case, unknowns).scenario).items():
            self._parameters[name] = value
        computed = np.empty(self._tank.size)
        car, wheelset = np.zeros(1, CAR)[0], np.zeros(1, WHEELSET)[0]
        follow = native_function(WALK)
        follow(
            *(car, wheelset, self._parameters[0], self._of_wheelset[0]),
            *(self._tank, self._line, self._commands, computed),
        )
        return computed


def _with_unknowns(case: Case, unknowns: Samples) -> Case:
    tank, caliper, swept, opening, gap = map(float, unknowns)
    rig = case.scenario.rig
    values = {
        "tank_heat_conductance": tank,
        "caliper_heat_conductance": caliper,
        "swept_volume": swept * case.scenario.brake.system.tank.volume,
        "opening_pressure": opening,
        "closing_pressure": opening + gap,
    }
    air = rig.compensation_model.air.model_copy(update=values)
    model = rig.compensation_model.model_copy(update={"air": air})
    return _with(case, rig=rig.model_copy(update={"compensation_model": model}))


def _with(case: Case, **sections: object) -> Case:
    return replace(case, scenario=case.scenario.model_copy(update=sections))


def follow_record_of_air(
    car: Car,
    wheelset: Wheelset,
    p: Parameters,
    own: WheelsetParameters,
    tank: Any,
    line: Any,
    commands: Any,
    computed: Any,
) -> None:
    """Follow a record sample by sample and fill ``computed`` with gauge pressures, Pa."""
    copy_wheelset_parameters(wheelset, own)
    start_module(wheelset, 0.0, p)
    wheelset.pressure_reading = tank[0]
    computed[0] = tank[0]
    for n in range(1, len(tank)):
        within = (n - 1) % p.steps_per_cycle
        if within == 0:
            wheelset.valve_command = commands[n]
            command_valve(wheelset, p)
        car.substep = float(within)
        move_valve(wheelset, car)
        wheelset.pressure_reading = tank[n]
        follow_tank(wheelset, line[n] + p.atmospheric_pressure, p)
        computed[n] = wheelset.modelled_pressure - p.atmospheric_pressure


WALK = Entry(
    f"{__name__}:follow_record_of_air",
    (
        *(at(CAR), at(WHEELSET), at(PARAMETERS), at(WHEELSET_PARAMETERS)),
        *(at("f8", _ROWS), at("f8", _ROWS), at("i8", _ROWS), at("f8", _ROWS)),
    ),
)

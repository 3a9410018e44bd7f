"""The caliper on the bench: air, caliper and compensation stepped without vehicle and controller.

Module 1 has the caliper, module 2 is a tank. Both obey the same valve commands and draw from one brake
line, which follows a demanded pressure. Further records compute what module 2 would give under each
setting of the compensation.
"""

from collections.abc import Callable, MutableSequence, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import uictest
from uictest.core.physics import analogue_reading, sqrt
from uictest.core.record import Record, channel, layout_of, units_of
from uictest.core.recording import ORIGIN, Recording
from uictest.plans.scenario import COMPENSATION_SETTINGS, Case, rig_as_built
from uictest.rig.assembly import assemble
from uictest.rig.bench.inputs import BenchInput, bench_input
from uictest.rig.bench.recipe import BenchTest
from uictest.rig.identification import AS_BUILT
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.cycle import command_valve, read_line_sensor, read_module_sensors, sensor_noise
from uictest.rig.model.friction_brake import follow_tank, read_line_pressure, step_clamping
from uictest.rig.model.parameters import (
    PARAMETERS,
    WHEELSET_PARAMETERS,
    Parameters,
    WheelsetParameters,
    copy_wheelset_parameters,
)
from uictest.rig.model.pneumatics import follow_demanded_pressure, step_tank
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.rig.model.stop import start_module, start_supply

SETTINGS = tuple(COMPENSATION_SETTINGS)
"""Settings of the compensation, in the order of the records that compute them."""
NONE, HYSTERESIS, CYLINDER, FULL, THERMAL = range(len(SETTINGS))
MODULES = 2
LOADCELLS = 3


class BenchRig(NamedTuple):
    """Records of the rig on the bench.

    Attributes:
        car: record whose air supply feeds the modules.
        modules: with caliper, and without.
        computed: a module for each setting, which computes the force of the second module under it.
        settings: as many parameter records that differ in the setting of the compensation alone.
        wheelset_parameters: those of wheelset 1, whose module is on the bench.
        loadcell_errors: momentary errors of the three loadcells, N.
    """

    car: Car
    modules: Sequence[Wheelset]
    computed: Sequence[Wheelset]
    settings: Sequence[Parameters]
    wheelset_parameters: WheelsetParameters
    loadcell_errors: MutableSequence[float]


def bench_rig(case: Case) -> BenchRig:
    """Return the rig of a case: its state zeroed, its parameters for each setting of the compensation."""
    inputs = assemble(case)
    settings: Any = np.zeros(len(SETTINGS), PARAMETERS)
    settings[:] = inputs.parameters
    settings["wsp_active"] = 1  # the valves obey the commands
    uses = COMPENSATION_SETTINGS.values()
    settings["uses_hysteresis"] = [setting.hysteresis for setting in uses]
    settings["uses_cylinder_dynamics"] = [setting.pressure == "filter" for setting in uses]
    settings["uses_module_air"] = [setting.pressure == "air" for setting in uses]
    car: Any = np.zeros(1, CAR)[0]
    modules: Any = np.zeros(MODULES, WHEELSET)
    computed: Any = np.zeros(len(SETTINGS), WHEELSET)
    loadcell_errors: Any = np.zeros(LOADCELLS)
    return BenchRig(car, modules, computed, settings, inputs.wheelset_parameters[0], loadcell_errors)


_LOADCELL = 8
"""Noise channel of the first loadcell, after those that a stop uses."""


def run_bench_test(rig: BenchRig, demanded_pressures: Any, valve_commands: Any, trace: Any) -> None:
    """Run a bench test on zeroed records.

    Args:
        rig: records of the rig.
        demanded_pressures: gauge pressure demanded of the brake line in each step, Pa.
        valve_commands: command of the valves of both modules in each controller cycle.
        trace: records of :data:`~uictest.rig.bench.run.BENCH_SAMPLE` for the start and after each step.
    """
    p = rig.settings[0]
    start_bench(rig)
    sample(trace[0], rig)
    for cycle in range(len(valve_commands)):
        start_bench_cycle(rig, cycle, valve_commands[cycle])
        for k in range(p.steps_per_cycle):
            n = cycle * p.steps_per_cycle + k
            rig.car.demanded_pressure = demanded_pressures[n]
            step_bench(rig)
            sample(trace[n + 1], rig)


def start_bench(rig: BenchRig) -> None:
    """Set the state of zeroed records: the reservoir is full, the brake released, the valves fill."""
    p = rig.settings[0]
    start_supply(rig.car, p)
    for i in range(MODULES):
        copy_wheelset_parameters(rig.modules[i], rig.wheelset_parameters)
        start_module(rig.modules[i], 1.0 - i, p)
    for i in range(len(rig.settings)):
        copy_wheelset_parameters(rig.computed[i], rig.wheelset_parameters)
        start_module(rig.computed[i], 0.0, rig.settings[i])


def start_bench_cycle(rig: BenchRig, cycle: int, valve_command: int) -> None:
    """Read the sensors and pass one command to the valves of both modules."""
    p = rig.settings[0]
    for i in range(MODULES):
        module = rig.modules[i]
        read_module_sensors(module, p, cycle, i)
        module.valve_command = valve_command
        command_valve(module, p)
    read_line_sensor(rig.car, p, cycle)
    caliper = rig.modules[0]
    share = caliper.loadcell_noise / sqrt(LOADCELLS)
    caliper.loadcell_error = 0.0
    for k in range(LOADCELLS):
        rig.loadcell_errors[k] = share * sensor_noise(p, cycle, _LOADCELL + k)
        caliper.loadcell_error += rig.loadcell_errors[k]
    rig.car.substep = 0.0


def step_bench(rig: BenchRig) -> None:
    """Advance air, caliper and the computed forces by one base step."""
    p = rig.settings[0]
    caliper, tank = rig.modules[0], rig.modules[1]
    modelled = rig.computed[THERMAL]
    modelled.fill_opening = tank.fill_opening
    modelled.vent_opening = tank.vent_opening
    follow_tank(modelled, read_line_pressure(rig.car, p), rig.settings[THERMAL])
    drawn_1, enthalpy_1 = step_tank(caliper, rig.car, p)
    drawn_2, enthalpy_2 = step_tank(tank, rig.car, p)
    follow_demanded_pressure(rig.car, drawn_1 + drawn_2, enthalpy_1 + enthalpy_2, p)
    step_clamping(caliper, p)
    step_clamping(tank, p)
    for i in range(len(rig.settings)):
        computed = rig.computed[i]
        computed.pressure = tank.pressure
        computed.pressure_error = tank.pressure_error
        computed.wsp_acting = tank.wsp_acting
        step_clamping(computed, rig.settings[i])
    rig.car.steps += 1.0
    rig.car.substep += 1.0
    rig.car.time = rig.car.steps * p.step


class BenchSample(Record):
    """Channels of a bench test; pressures are gauge, the number at the end is that of the module."""

    time: float = channel("s")
    demanded_pressure: float = channel("Pa")
    brake_line_pressure: float = channel("Pa")
    valve_command_1: float = channel("1")  # 0 fill, 1 hold, 2 vent; the same for both modules
    wsp_acting: float = channel("1")
    tank_pressure_1: float = channel("Pa")
    tank_pressure_2: float = channel("Pa")
    measured_pressure_1: float = channel("Pa")  # as the sensor reads it
    measured_pressure_2: float = channel("Pa")
    cylinder_pressure_1: float = channel("Pa")  # measured
    cylinder_pressure_2: float = channel("Pa")  # computed by the cylinder dynamics
    cylinder_pressure_thermal_2: float = channel("Pa")  # computed by the modelled air
    stroke_1: float = channel("m")
    caliper_force_1: float = channel("N")
    loadcell_1: float = channel("N")
    loadcell_2: float = channel("N")
    loadcell_3: float = channel("N")
    clamping_force_1: float = channel("N")  # sum of the loadcells
    computed_force_1: float = channel("N")  # by the four-phase hysteresis from the pressure of module 1
    computed_force_none_2: float = channel("N")
    computed_force_hysteresis_2: float = channel("N")
    computed_force_cylinder_2: float = channel("N")
    computed_force_full_2: float = channel("N")
    computed_force_thermal_2: float = channel("N")


BENCH_CHANNELS = units_of(BenchSample)
"""Channels of a bench test and their units."""
BENCH_SAMPLE = layout_of(BenchSample)
"""Layout of :class:`BenchSample`."""
LOADCELL_SHARES = (0.36, 0.31, 0.33)
"""Shares of the clamping force that the three loadcells between pad and disc carry (chosen)."""


def sample(row: BenchSample, rig: BenchRig) -> None:
    """Write the present state into one record of a trace."""
    p = rig.settings[0]
    caliper, tank = rig.modules[0], rig.modules[1]
    row.time = rig.car.time
    row.demanded_pressure = rig.car.demanded_pressure
    row.brake_line_pressure = rig.car.line_pressure - p.atmospheric_pressure
    row.valve_command_1 = caliper.valve_command
    row.wsp_acting = caliper.wsp_acting
    row.tank_pressure_1 = caliper.pressure - p.atmospheric_pressure
    row.tank_pressure_2 = tank.pressure - p.atmospheric_pressure
    row.measured_pressure_1 = _measured_pressure(caliper, p)
    row.measured_pressure_2 = _measured_pressure(tank, p)
    row.cylinder_pressure_1 = row.measured_pressure_1
    row.cylinder_pressure_2 = rig.computed[FULL].compensated_pressure
    row.cylinder_pressure_thermal_2 = rig.computed[THERMAL].compensated_pressure
    row.stroke_1 = caliper.stroke
    row.caliper_force_1 = caliper.caliper_force
    row.loadcell_1 = _loadcell(caliper, 0, rig, p)
    row.loadcell_2 = _loadcell(caliper, 1, rig, p)
    row.loadcell_3 = _loadcell(caliper, 2, rig, p)
    row.clamping_force_1 = row.loadcell_1 + row.loadcell_2 + row.loadcell_3
    row.computed_force_1 = caliper.computed_force
    row.computed_force_none_2 = rig.computed[NONE].computed_force
    row.computed_force_hysteresis_2 = rig.computed[HYSTERESIS].computed_force
    row.computed_force_cylinder_2 = rig.computed[CYLINDER].computed_force
    row.computed_force_full_2 = rig.computed[FULL].computed_force
    row.computed_force_thermal_2 = rig.computed[THERMAL].computed_force


def _measured_pressure(module: Wheelset, p: Parameters) -> float:
    gauge = module.pressure - p.atmospheric_pressure
    return analogue_reading(
        gauge,
        module.pressure_gain_error,
        module.pressure_offset,
        module.pressure_error,
        p.pressure_range,
        p.pressure_resolution,
        p.pressure_steps,
    )


def _loadcell(caliper: Wheelset, number: int, rig: BenchRig, p: Parameters) -> float:
    return analogue_reading(
        caliper.caliper_force * LOADCELL_SHARES[number],
        caliper.loadcell_gain_error,
        caliper.loadcell_offset / LOADCELLS,
        rig.loadcell_errors[number],
        p.loadcell_range,
        p.loadcell_resolution,
        p.loadcell_steps,
    )


Samples = NDArray[np.float64]

_COUNT, _CYCLES, _ROWS = len(SETTINGS), Length("cycles"), Length("rows")
BENCH = Entry(
    "uictest.rig.bench.run:run_bench_test",
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
    """Run :func:`uictest.rig.bench.run.run_bench_test` compiled.

    Raises TypeError where a record or an array does not have the compiled layout.
    """
    native_function(BENCH)(rig, demanded_pressures, valve_commands, trace)


def run_bench(case: Case, applied: BenchInput, run: Callable[..., None] = run_compiled) -> Recording:
    """Apply an input to the rig of a case, without its vehicle and controller, and record every step.

    Args:
        case: where brake system, caliper, compensation, sensors and seed come from; the module is that of
            wheelset 1.
        applied: demanded pressures and valve commands; see :mod:`uictest.rig.bench.inputs`.
        run: :func:`uictest.rig.bench.run.run_bench_test`, plain or compiled.

    Returns:
        The channels of :data:`~uictest.rig.bench.run.BENCH_CHANNELS`.
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

"""The caliper on the bench: air, caliper and compensation stepped without vehicle and controller.

Module 1 has the caliper, module 2 is a tank. Both obey the same valve commands and draw from one brake
line, which follows a demanded pressure. Further records compute what module 2 would give under each
setting of the compensation.
"""

from typing import Any

from uictest.core.physics import sqrt
from uictest.rig.bench.rig import LOADCELLS, MODULES, SETTINGS, THERMAL, BenchRig
from uictest.rig.bench.trace import sample
from uictest.rig.model.clamping import step_clamping
from uictest.rig.model.cycle import (
    command_valve,
    read_line_sensor,
    read_module_sensors,
    sensor_noise,
)
from uictest.rig.model.module_air import follow_tank, read_line_pressure
from uictest.rig.model.pneumatics import follow_demanded_pressure, step_tank
from uictest.rig.model.start import start_module, start_supply
from uictest.rig.model.wheelset_parameters import copy_wheelset_parameters

_LOADCELL = 8
"""Noise channel of the first loadcell, behind those that a stop uses."""


def run_bench_test(rig: BenchRig, demanded_pressures: Any, valve_commands: Any, trace: Any) -> None:
    """Run a bench test on zeroed records.

    Args:
        rig: records of the rig.
        demanded_pressures: gauge pressure demanded of the brake line in each step, Pa.
        valve_commands: command of the valves of both modules in each controller cycle.
        trace: records of :data:`~uictest.rig.bench.trace.BENCH_SAMPLE` for the start and after each step.
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
    for i in range(len(SETTINGS)):
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
    for i in range(len(SETTINGS)):
        computed = rig.computed[i]
        computed.pressure = tank.pressure
        computed.pressure_error = tank.pressure_error
        computed.wsp_acting = tank.wsp_acting
        step_clamping(computed, rig.settings[i])
    rig.car.steps += 1.0
    rig.car.substep += 1.0
    rig.car.time = rig.car.steps * p.step

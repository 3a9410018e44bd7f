"""The caliper on the bench: air, caliper and compensation stepped without vehicle and controller.

Module 1 has the caliper, module 2 is a tank. Both obey the same valve commands and draw from one brake
line, which follows a demanded pressure. Four further records compute what module 2 would give under each
setting of the compensation.
"""

from collections.abc import Sequence
from typing import Any

from uictest.physics import sqrt
from uictest.rig.bench.trace import sample
from uictest.rig.model.clamping import step_clamping
from uictest.rig.model.cycle import command_valve, read_sensors, sensor_noise
from uictest.rig.model.pneumatics import follow_demand, step_tank
from uictest.rig.model.start import start_supply

Record = Any
SETTINGS = ("none", "hysteresis", "cylinder", "full")
"""Settings of the compensation, in the order of the records that compute them."""
_LOADCELL = 8
"""Noise channel of the first loadcell, behind those that a stop uses."""
_LONG_AGO = 1_000_000


def bench(
    car: Record,
    modules: Sequence[Record],
    computed: Sequence[Record],
    settings: Sequence[Record],
    demand: Any,
    commands: Any,
    loadcells: Any,
    trace: Any,
) -> None:
    """Run a bench test on zeroed records and write a row of ``trace`` for the start and after every step.

    Args:
        car: record whose air supply feeds the modules.
        modules: two module records: with caliper, and without.
        computed: four module records, which compute the force of module 2 under the four settings.
        settings: four parameter records that differ in the setting of the compensation alone.
        demand: demanded gauge pressure of the brake line in each step, Pa.
        commands: valve command of both modules in each controller cycle.
        loadcells: array for the momentary errors of three loadcells, N.
        trace: array with a row of :data:`~uictest.rig.bench.trace.ROW` numbers more than there are steps.
    """
    p = settings[0]
    start_bench(car, modules, computed, p)
    sample(trace[0], car, modules, computed, loadcells, p)
    for cycle in range(len(commands)):
        begin_bench_cycle(car, modules, loadcells, p, cycle, commands[cycle])
        for k in range(p.steps_per_cycle):
            n = cycle * p.steps_per_cycle + k
            car.demand = demand[n]
            step_bench(car, modules, computed, settings)
            sample(trace[n + 1], car, modules, computed, loadcells, p)


def start_bench(car: Record, modules: Sequence[Record], computed: Sequence[Record], p: Record) -> None:
    """Set the state of zeroed records: the reservoir is full, the brake released, the valves fill."""
    start_supply(car, p)
    for i in range(2):
        modules[i].has_caliper = 1.0 - i
        modules[i].filling_cycles = _LONG_AGO
        modules[i].fill_opening = 1.0
        modules[i].pressure = p.atmospheric_pressure
    for i in range(4):
        computed[i].pressure = p.atmospheric_pressure


def begin_bench_cycle(
    car: Record, modules: Sequence[Record], loadcells: Any, p: Record, cycle: int, command: int
) -> None:
    """Read the sensors and pass one command to the valves of both modules."""
    for i in range(2):
        read_sensors(modules[i], p, cycle, i)
        modules[i].command = command
        command_valve(modules[i], p)
    share = p.loadcell_noise / sqrt(3.0)
    modules[0].loadcell_error = 0.0
    for k in range(3):
        loadcells[k] = share * sensor_noise(p, cycle, _LOADCELL + k)
        modules[0].loadcell_error += loadcells[k]
    car.substep = 0.0


def step_bench(
    car: Record, modules: Sequence[Record], computed: Sequence[Record], settings: Sequence[Record]
) -> None:
    """Advance air, caliper and the four computed forces by one base step."""
    p = settings[0]
    drawn = step_tank(modules[0], car, p)
    drawn += step_tank(modules[1], car, p)
    follow_demand(car, drawn, p)
    step_clamping(modules[0], p)
    step_clamping(modules[1], p)
    for i in range(4):
        computed[i].pressure = modules[1].pressure
        computed[i].pressure_error = modules[1].pressure_error
        computed[i].wsp_acting = modules[1].wsp_acting
        step_clamping(computed[i], settings[i])
    car.steps += 1.0
    car.substep += 1.0
    car.time = car.steps * p.step

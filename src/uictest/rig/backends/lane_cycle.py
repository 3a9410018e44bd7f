"""A controller cycle of stops side by side, in the lanes of a SIMD register.

Compiled only. What branches or looks up tables - friction laws, controllers - runs lane by lane once per
cycle; everything else runs in all lanes at once. The brake makes its steps of a cycle before the vehicle.
"""

from typing import Any, NamedTuple

from uictest.core.lanes import lane, vectors
from uictest.rig.backends.lane_records import Cases, Lanes
from uictest.rig.model.brake_command import follow_commands
from uictest.rig.model.controller import decide
from uictest.rig.model.cycle import (
    command_valves,
    read_common_sensors,
    read_line_sensor,
    read_other_loadcells,
    read_pole_wheels,
)
from uictest.rig.model.disc_brake import warm_discs
from uictest.rig.model.dynamic_brake import brake_dynamically, demand_dynamic_brake
from uictest.rig.model.faults import (
    let_air_leak,
    limit_valves,
    silence_controller,
    update_faults,
)
from uictest.rig.model.module_air import follow_tanks, read_line_pressure
from uictest.rig.model.sand import command_sanders
from uictest.rig.model.step import (
    compensate_kept,
    step_modules,
    step_other_calipers,
    step_vehicle,
    take_clamping_forces,
)
from uictest.rig.model.stop import meet_rail
from uictest.rig.model.stop_measures import observe_cycle
from uictest.rig.model.track_brake import (
    account_for_magnets,
    command_track_brake,
    drag_magnets,
)
from uictest.rig.model.traction import hold_speed

IDLE = -1
"""Number of a lane's case when it has none."""


class Needs(NamedTuple):
    """What a controller cycle has to do for any lane: how many steps it has, and what else."""

    steps: int
    reads_pole_wheels: bool
    reads_line: bool
    follows_air: bool
    warms_discs: bool
    leaks: bool
    brakes_dynamically: bool
    brakes_on_track: bool
    has_four_calipers: bool


def begin_cycle(lanes: Lanes, cases: Cases, running: Any, memories: Any) -> Needs:
    """Do what comes before the steps of a controller cycle; idle lanes skip their controller."""
    rig = lanes.rig
    car, wheelsets, settings = vectors(rig.car), vectors(rig.wheelsets), vectors(lanes.settings)
    needs = _needs_of(cases, running)
    _update_faults(lanes, cases, running)
    read_common_sensors(car, wheelsets, settings)
    if needs.has_four_calipers:
        read_other_loadcells(car, wheelsets, settings)
    if needs.reads_line:
        read_line_sensor(car, settings, car.cycle)
    if needs.reads_pole_wheels:
        read_pole_wheels(car, wheelsets, settings)
    for k in range(running.size):
        if running[k] != IDLE:
            _decide(lanes, cases, running[k], memories[k], k)
    command_valves(car, wheelsets, settings)
    _follow_commands_of_valves(lanes, cases, running)
    return needs


def _needs_of(cases: Cases, running: Any) -> Needs:
    steps = 0
    reads_pole_wheels = False
    reads_line = False
    follows_air = False
    warms_discs = False
    leaks = False
    brakes_dynamically = False
    brakes_on_track = False
    has_four_calipers = False
    for k in range(running.size):
        if running[k] != IDLE:
            p = cases.parameters[running[k]]
            steps = p.steps_per_cycle
            reads_pole_wheels = reads_pole_wheels or p.uses_pole_wheels > 0.0
            reads_line = reads_line or p.uses_module_air > 0.0
            follows_air = follows_air or (p.uses_module_air > 0.0 and p.calipers < 4)
            warms_discs = warms_discs or p.models_disc_temperature > 0.0
            leaks = leaks or p.has_leaks > 0.0
            brakes_dynamically = brakes_dynamically or p.has_dynamic_brake > 0.0
            brakes_on_track = brakes_on_track or p.has_track_brake > 0.0
            has_four_calipers = has_four_calipers or p.calipers > 1
    return Needs(
        steps,
        reads_pole_wheels,
        reads_line,
        follows_air,
        warms_discs,
        leaks,
        brakes_dynamically,
        brakes_on_track,
        has_four_calipers,
    )


def _decide(lanes: Lanes, cases: Cases, case: int, memory: Any, k: int) -> None:
    """Look up the friction that lane ``k`` meets and let its controller and driver decide."""
    p, car, wheelsets = cases.parameters[case], lane(lanes.rig.car, k), lane(lanes.rig.wheelsets, k)
    meet_rail(car, wheelsets, p, cases.rail[case], memory)
    decide(car, wheelsets, p)
    if p.fault_count > 0:
        silence_controller(car, wheelsets, p)
    if p.command_count > 1:
        follow_commands(car, lane(lanes.measures, k), p)
    if p.drag_duration > 0.0:
        hold_speed(car, p)
    if p.has_track_brake > 0.0:
        command_track_brake(car, p)


def advance_brake(lanes: Lanes, needs: Needs) -> None:
    """Make the steps of a controller cycle with the brake, and keep the clamping forces.

    What a module without a caliper gives follows from the readings of its pressure alone. So it is computed
    module by module: its few numbers stay in registers.
    """
    wheelsets, settings = vectors(lanes.rig.wheelsets), vectors(lanes.settings)
    kept = vectors(lanes.module_steps)
    for n in range(needs.steps):
        _advance_modules(lanes, needs, n)
    for i in range(1, 4):
        for n in range(needs.steps):
            compensate_kept(wheelsets[i], kept[4 * n + i], settings)


def _advance_modules(lanes: Lanes, needs: Needs, n: int) -> None:
    car, wheelsets, settings = vectors(lanes.rig.car), vectors(lanes.rig.wheelsets), vectors(lanes.settings)
    if needs.reads_line:
        line = read_line_pressure(car, settings)
        if needs.follows_air:
            follow_tanks(wheelsets, line, settings)
    if needs.leaks:
        let_air_leak(car, wheelsets, settings)
    kept = vectors(lanes.module_steps)[4 * n]
    step_modules(car, wheelsets, kept, settings)
    if needs.has_four_calipers:
        step_other_calipers(wheelsets, kept, settings)


def advance_vehicle(lanes: Lanes, needs: Needs, n: int) -> None:
    """Make step ``n`` of a controller cycle with the vehicle, under the clamping forces kept."""
    rig = lanes.rig
    car, bogies, wheelsets = vectors(rig.car), vectors(rig.bogies), vectors(rig.wheelsets)
    settings = vectors(lanes.settings)
    take_clamping_forces(wheelsets, vectors(lanes.module_steps)[4 * n])
    if needs.brakes_dynamically:
        brake_dynamically(wheelsets, settings)
    if needs.brakes_on_track:
        drag_magnets(car, bogies, settings)
    step_vehicle(car, bogies, wheelsets, settings)
    if needs.brakes_on_track:
        account_for_magnets(car, bogies, settings)


def end_cycle(lanes: Lanes, needs: Needs) -> None:
    """Do what comes after the steps of a controller cycle: warm the discs, feed the measures."""
    car, wheelsets, settings = vectors(lanes.rig.car), vectors(lanes.rig.wheelsets), vectors(lanes.settings)
    if needs.warms_discs:
        warm_discs(wheelsets, settings)
    observe_cycle(car, wheelsets, vectors(lanes.measures), vectors(lanes.wheelset_measures), settings)


def _update_faults(lanes: Lanes, cases: Cases, running: Any) -> None:
    """Decide lane by lane which faults are active."""
    for k in range(running.size):
        case = running[k]
        if case != IDLE and cases.parameters[case].fault_count > 0:
            car, wheelsets = lane(lanes.rig.car, k), lane(lanes.rig.wheelsets, k)
            update_faults(car, wheelsets, cases.parameters[case], cases.wheelset_parameters[case])


def _follow_commands_of_valves(lanes: Lanes, cases: Cases, running: Any) -> None:
    """Divide lane by lane the force between the brakes, command the sanders, limit faulty valves."""
    for k in range(running.size):
        case = running[k]
        if case != IDLE:
            p, car, wheelsets = cases.parameters[case], lane(lanes.rig.car, k), lane(lanes.rig.wheelsets, k)
            if p.has_dynamic_brake > 0.0:
                demand_dynamic_brake(car, wheelsets, p)
            if p.has_sanders > 0.0:
                command_sanders(car, wheelsets, p)
            if p.fault_count > 0:
                limit_valves(car, wheelsets, p)

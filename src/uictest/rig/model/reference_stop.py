"""A stop in which all wheelsets keep one slide from beginning to end: the best of them is the reference.

The rail takes from a wheelset the force of the creep curve at that slide or, where this is less, what the
brake gives at the demanded pressure without what slows its rotation: then it rolls. The rail is that of the
stop: its friction along the track, over time and at random, and what sliding makes of it, from wheelset to
wheelset. Left out: loads other than at rest, the lag of the air behind the demand, discs that warm.
"""

from collections.abc import Sequence
from typing import Any

from uictest.core.measures import StopMeasures
from uictest.core.physics import (
    clamping_force,
    contact_stiffness,
    creep_force,
    demanded_pressure,
    gradient_force,
    maximum,
    running_resistance,
    torque,
)
from uictest.rig.model.brake_command import follow_commands
from uictest.rig.model.cycle import start_cycle
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import RailMemory, clean_rail, forget_rail
from uictest.rig.model.start import start
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.wheelset_parameters import WheelsetParameters

_WHEELS = 2.0
_INFINITE = float("inf")


def keep_slide_to_end(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
    measures: StopMeasures,
    numbers: Sequence[float],
) -> int:
    """Set ``measures.reference_distance`` to the distance at a slide, m, infinite without standstill.

    ``numbers`` are the slide and the step of the integration, s. All records are zeroed, ``rail`` as in
    :mod:`uictest.rig.model.rail`. Returns the number of steps.
    """
    slide, step = numbers[0], numbers[1]
    start(car, bogies, wheelsets, p, wheelset_parameters)
    if p.cleans_rail > 0.0:
        forget_rail(memory, p)
    measures.reference_distance = _INFINITE
    deceleration = 0.0
    while car.time < p.cycles * p.cycle_time:
        if p.command_count > 1:
            follow_commands(car, measures, p)
        start_cycle(car, wheelsets, p, rail)
        if p.cleans_rail > 0.0:
            clean_rail(car, wheelsets, p, memory)
        force = _force_of_rail(slide, step, deceleration, car, wheelsets, p)
        force += running_resistance(
            car.speed, p.resistance_constant, p.resistance_linear, p.resistance_quadratic
        )
        deceleration = (force + gradient_force(p.total_mass, p.gradient, p.gravity)) / p.total_mass
        if step * deceleration >= car.speed:
            measures.reference_distance = car.position + 0.5 * car.speed * car.speed / deceleration
            break
        car.position += step * (car.speed - 0.5 * step * deceleration)
        car.speed -= step * deceleration
        car.time += step
        car.cycle += 1
    return car.cycle


def _force_of_rail(
    slide: float, step: float, deceleration: float, car: Car, wheelsets: Sequence[Wheelset], p: Parameters
) -> float:
    """Let the wheelsets slide for a step, or roll where the brake is weaker; return the force on all, N."""
    car.command_pressure = demanded_pressure(
        car.time, car.demand_start, car.demand_change, car.demand_begins, car.demand_rate
    )
    stiffness = contact_stiffness(p.creep_stiffness, p.static_wheel_load * p.load_scale)
    total = 0.0
    for i in range(4):
        wheelset = wheelsets[i]
        of_wheel, _ = creep_force(
            slide * car.speed,
            car.speed,
            p.static_wheel_load,
            stiffness,
            wheelset.friction,
            wheelset.friction_ratio,
            wheelset.friction_decay,
            wheelset.reduction_adhesion,
            wheelset.reduction_slip,
        )
        sliding, rolling = _WHEELS * of_wheel, _force_of_brake(wheelset, car, deceleration, p)
        slip = slide * car.speed if rolling > sliding else 0.0
        wheelset.contact_loss += sliding * slip * step
        wheelset.rotation = (car.speed - slip) / wheelset.wheel_radius
        total += sliding if rolling > sliding else rolling
    return total


def _force_of_brake(wheelset: Wheelset, car: Car, deceleration: float, p: Parameters) -> float:
    """Return what a rolling wheelset asks of the rail, N.

    The caliper squeezes and is at rest: the equilibrium of :mod:`uictest.core.physics.caliper`.
    """
    spring = 1.0 / p.free_compliance - p.piston_damping
    contact = wheelset.squeezing_stiffness - p.contact_damping
    load = car.command_pressure * p.piston_area - p.preload - wheelset.coulomb_friction - spring * p.clearance
    stroke = p.clearance + maximum(load, 0.0) / (spring + contact)
    wheelset.clamping_force = clamping_force(stroke, p.clearance, p.contact_stiffness, p.lever_ratio)
    pads = p.calipers_per_wheelset, p.pads_per_caliper, wheelset.pad_friction, p.disc_radius
    braking = wheelset.brake_force * torque(wheelset.clamping_force, *pads)
    turning = wheelset.rotational_inertia * deceleration / wheelset.wheel_radius
    return maximum(braking - turning, 0.0) / wheelset.wheel_radius

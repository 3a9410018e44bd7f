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
from uictest.rig.model.cycle import start_cycle
from uictest.rig.model.parameters import Parameters, WheelsetParameters
from uictest.rig.model.pneumatics import follow_commands
from uictest.rig.model.rail import RailMemory, clean_rail, forget_rail
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.stop import start

_WHEELS = 2.0
_INFINITE = float("inf")
_COARSE, _FINE = 0.05, 0.005
"""s, of the steps that find the best slide, and of those that give its distance: within 0.3 %; chosen."""


def find_reference(
    cars: Sequence[Car],
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
    measures: StopMeasures,
    slides: Sequence[float],
) -> None:
    """Set ``measures.reference_distance`` to the distance at the best of the slides, m.

    It is infinite if no slide stops the train. All records are zeroed; there are cars, with their bogies and
    wheelsets, for one stop more than slides, which ascend. ``rail`` is as in :mod:`uictest.rig.model.rail`.
    """
    last = len(slides)
    for k in range(last + 1):
        start(cars[k], bogies[2 * k : 2 * k + 2], wheelsets[4 * k : 4 * k + 4], p, wheelset_parameters)
    shortest, best = _INFINITE, last - 1
    for k in range(last):
        given = cars[k], wheelsets[4 * k : 4 * k + 4], p, rail, memory, measures
        distance = _stopping_distance(slides[k], _COARSE, shortest, *given)
        if distance <= shortest:
            shortest, best = distance, k
    given = cars[last], wheelsets[4 * last : 4 * last + 4], p, rail, memory, measures
    measures.reference_distance = _stopping_distance(slides[best], _FINE, _INFINITE, *given)


def _stopping_distance(
    slide: float,
    step: float,
    limit: float,
    car: Car,
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    rail: Any,
    memory: RailMemory,
    measures: StopMeasures,
) -> float:
    """Return the distance of a stop at a slide, m, infinite without standstill before the limit."""
    if p.cleans_rail > 0.0:
        forget_rail(memory, p)
    stiffness = contact_stiffness(p.creep_stiffness, p.static_wheel_load * p.load_scale)
    deceleration = 0.0
    while car.time < p.cycles * p.cycle_time and car.position <= limit:
        if p.command_count > 1:
            follow_commands(car, measures, p)
        start_cycle(car, wheelsets, p, rail)
        if p.cleans_rail > 0.0:
            clean_rail(car, wheelsets, p, memory)
        force = _force_of_rail(slide, step, deceleration, stiffness, car, wheelsets, p)
        force += running_resistance(
            car.speed, p.resistance_constant, p.resistance_linear, p.resistance_quadratic
        )
        deceleration = (force + gradient_force(p.total_mass, p.gradient, p.gravity)) / p.total_mass
        if step * deceleration >= car.speed:
            return car.position + 0.5 * car.speed * car.speed / deceleration
        car.position += step * (car.speed - 0.5 * step * deceleration)
        car.speed -= step * deceleration
        car.time += step
        car.cycle += 1
    return _INFINITE


def _force_of_rail(
    slide: float,
    step: float,
    deceleration: float,
    stiffness: float,
    car: Car,
    wheelsets: Sequence[Wheelset],
    p: Parameters,
) -> float:
    """Let the wheelsets slide for a step, or roll where the brake is weaker; return the force on all, N."""
    car.command_pressure = demanded_pressure(
        car.time, car.demand_start, car.demand_change, car.demand_begins, car.demand_rate
    )
    total, sliding, friction, cleaned = 0.0, 0.0, -1.0, -1.0
    for i in range(4):
        wheelset = wheelsets[i]
        if wheelset.friction != friction or wheelset.cleaned_share != cleaned:  # most rails are even
            friction, cleaned = wheelset.friction, wheelset.cleaned_share
            of_wheel, _ = creep_force(
                slide * car.speed,
                car.speed,
                p.static_wheel_load,
                stiffness,
                friction,
                wheelset.friction_ratio,
                wheelset.friction_decay,
                wheelset.reduction_adhesion,
                wheelset.reduction_slip,
            )
            sliding = _WHEELS * of_wheel
        rolling = _force_of_brake(wheelset, car, deceleration, p)
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

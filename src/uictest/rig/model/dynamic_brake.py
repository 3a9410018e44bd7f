"""The dynamic brake: its demand once per controller cycle, its torque in every step.

The friction demand is one for the car, since one brake line feeds its four wheelsets; what the motors of the
car give at the speed of the train is taken off it. So the friction brake replaces what is still to build up
and what fade-out, power limit, a failure or the WSP take, through the dynamics of its line.

A controller of contract version 2 takes a share of it off single wheelsets. One of version 1 cannot and loses
it: with its first hold or vent the dynamic brake of the car drops, for the rest of the application.

A friction brake that is relieved holds its force within the loop of its caliper. From the pressure of the
brake line the blending knows what the calipers hold, and while that is too much, it demands the pressure of
the releasing line.
"""

from collections.abc import Sequence

from uictest.core.physics import (
    FILL,
    clamp,
    demanded_pressure,
    dynamic_force,
    held_excess,
    loop_width,
    maximum,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset

_BAND = 0.005
"""Share of the commanded force, chosen, by which friction may miss its demand before the loop is changed."""


def start_dynamic_brake(wheelset: Wheelset, number: int, p: Parameters) -> None:
    """Give wheelset ``number``, from 0, the motor that it has."""
    wheelset.motor_force = p.motor_forces[number]
    wheelset.motor_power = p.motor_powers[number]


def demand_dynamic_brake(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Divide the force that the command asks for between both brakes, for the coming cycle; scalar code."""
    if p.controller_contract == 1:
        for i in range(4):
            if wheelsets[i].valve_command != FILL:
                car.dynamic_dropped = 1.0
    pressure = demanded_pressure(
        car.time, car.demand_start, car.demand_change, car.demand_begins, car.demand_rate
    )
    excess = maximum(pressure - p.zero_force_pressure, 0.0)
    wanted = p.force_per_pressure * excess
    available = 0.0
    total = 0.0
    for i in range(4):
        motor = wheelsets[i].motor_force, wheelsets[i].motor_power, p.fade_end, p.fade_rate
        force = dynamic_force(maximum(car.speed, 0.0), *motor)
        available += (1.0 - car.dynamic_dropped) * (1.0 - car.dynamic_failed) * force
        total += wheelsets[i].motor_effort * force
    car.blended_share = clamp(total / wanted, 0.0, 1.0) if wanted > 0.0 else 0.0
    of_friction = (1.0 - car.blended_share) * excess
    _watch_calipers(car, wheelsets, of_friction, _BAND * excess, p)
    if excess > 0.0 and car.relieved > 0.0:
        car.blended_share += loop_width(of_friction, p.coulomb_width, p.load_width) / excess
    request = 0.0
    if available > 0.0:
        request = 1.0 if wanted >= available else wanted / available
    for i in range(4):
        wheelset = wheelsets[i]
        wanted_effort = request * (1.0 - wheelset.dynamic_reduction)
        effort = wheelset.motor_effort + p.motor_response * (wanted_effort - wheelset.motor_effort)
        wheelset.motor_effort = (1.0 - car.dynamic_failed) * effort
        wheelset.dynamic_brake = wheelset.motor_effort if wheelset.motor_force > 0.0 else 0.0


def _watch_calipers(
    car: Car, wheelsets: Sequence[Wheelset], wanted: float, band: float, p: Parameters
) -> None:
    """Find what the calipers hold, and whether that is too much; a vented one begins its loop anew.

    ``wanted`` is the pressure above zero force that squeezing calipers would need, Pa.
    """
    for i in range(4):
        if wheelsets[i].valve_command != FILL:
            car.held_excess = 0.0
    in_line = car.line_pressure - p.atmospheric_pressure - p.zero_force_pressure
    car.held_excess = held_excess(car.held_excess, in_line, p.coulomb_width, p.load_width)
    surplus = car.held_excess - wanted
    if abs(surplus) > band:
        car.relieved = 1.0 if surplus > 0.0 else 0.0


def brake_dynamically(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set the torque of the dynamic brake on each wheelset for one step, from its own rotation."""
    for i in range(4):
        wheelset = wheelsets[i]
        rim_speed = abs(wheelset.rotation) * wheelset.wheel_radius
        motor = wheelset.motor_force, wheelset.motor_power, p.fade_end, p.fade_rate
        largest = dynamic_force(rim_speed, *motor)
        wheelset.dynamic_torque = wheelset.motor_effort * wheelset.wheel_radius * largest

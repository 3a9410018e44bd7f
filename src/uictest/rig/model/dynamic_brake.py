"""The dynamic brake: its demand once per controller cycle, its torque in every step.

The friction demand is one for the car, since one brake line feeds its four wheelsets; what the motors of the
car can give at the speed of the train is taken off it, whether or not they all can use it. The friction
brake replaces what fade-out, power limit or a failure take, through the dynamics of its line.

A controller of contract version 2 takes a share of it off single wheelsets, which the friction brake does not
replace: the blending counts on what is available. One of version 1 cannot and loses it: with its first hold
or vent the dynamic brake of the car drops, for the rest of the application, and the friction brake takes
over.
"""

from collections.abc import Sequence

from uictest.core.physics import (
    FILL,
    clamp,
    demanded_pressure,
    dynamic_force,
    maximum,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset


def start_dynamic_brake(wheelset: Wheelset, number: int, p: Parameters) -> None:
    """Give wheelset ``number``, from 0, the motor that it has."""
    wheelset.motor_force = p.motor_forces[number]
    wheelset.motor_power = p.motor_powers[number]


def demand_dynamic_brake(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Divide the force that the command asks for between both brakes, for the coming cycle; scalar code."""
    if p.controller_contract == 1:
        _drop_if_wheels_slide(car, wheelsets)
    pressure = demanded_pressure(
        car.time, car.demand_start, car.demand_change, car.demand_begins, car.demand_rate
    )
    wanted = p.force_per_pressure * maximum(pressure - p.zero_force_pressure, 0.0)
    available = 0.0
    for i in range(4):
        available += _available(wheelsets[i], car, p)
    share = 0.0
    request = 0.0
    if available > 0.0:
        share = 1.0 if wanted <= available else available / wanted
        request = 1.0 if wanted >= available else wanted / available
    car.blended_share += clamp(share - car.blended_share, -p.blending_change, p.blending_change)
    for i in range(4):
        _follow(wheelsets[i], car, request, p)


def _drop_if_wheels_slide(car: Car, wheelsets: Sequence[Wheelset]) -> None:
    for i in range(4):
        if wheelsets[i].valve_command != FILL:
            car.dynamic_dropped = 1.0


def _available(wheelset: Wheelset, car: Car, p: Parameters) -> float:
    works = (1.0 - car.dynamic_dropped) * (1.0 - car.dynamic_failed)
    return works * dynamic_force(
        maximum(car.speed, 0.0), wheelset.motor_force, wheelset.motor_power, p.fade_end, p.fade_rate
    )


def _follow(wheelset: Wheelset, car: Car, request: float, p: Parameters) -> None:
    """Let the effort of a motor follow what is asked of it; a failed one gives nothing at once."""
    wanted = request * (1.0 - wheelset.dynamic_reduction)
    effort = wheelset.motor_effort + p.motor_response * (wanted - wheelset.motor_effort)
    wheelset.motor_effort = (1.0 - car.dynamic_failed) * effort
    wheelset.dynamic_brake = wheelset.motor_effort if wheelset.motor_force > 0.0 else 0.0


def brake_dynamically(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set the torque of the dynamic brake on each wheelset for one step, from its own rotation; in lanes."""
    _brake_wheelset(wheelsets[0], p)
    _brake_wheelset(wheelsets[1], p)
    _brake_wheelset(wheelsets[2], p)
    _brake_wheelset(wheelsets[3], p)


def _brake_wheelset(wheelset: Wheelset, p: Parameters) -> None:
    rim_speed = abs(wheelset.rotation) * wheelset.wheel_radius
    largest = dynamic_force(rim_speed, wheelset.motor_force, wheelset.motor_power, p.fade_end, p.fade_rate)
    wheelset.dynamic_torque = wheelset.motor_effort * wheelset.wheel_radius * largest

"""Drag braking: from a speed on, traction holds the train while its brake acts, for a time.

The traction is what an ideal locomotive gives: at every step just the force that keeps the car body at the
speed, at its centre of gravity. It pulls and never brakes.
"""

from uictest.core.physics import maximum
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car

_HELD_WITHIN = 1.001
"""A speed above that share of the one to be held is not held; chosen."""
_NOT_YET, _HOLDS, _HELD = 0, 1, 2


def hold_speed(car: Car, p: Parameters) -> None:
    """Begin or end to hold the speed with the coming cycle; scalar code."""
    if car.drag_phase == _NOT_YET and car.speed <= p.drag_speed:
        car.drag_phase = _HOLDS
        car.drag_ends = car.time + p.drag_duration
    if car.drag_phase == _HOLDS and car.time > car.drag_ends - 0.5 * p.step:
        car.drag_phase = _HELD
    car.holds_speed = 1.0 if car.drag_phase == _HOLDS else 0.0
    if car.holds_speed > 0.0 and car.speed <= p.drag_speed * _HELD_WITHIN:
        car.held_time += p.cycle_time


def traction_force(car: Car, drag: float, p: Parameters) -> float:
    """Return the force on the car body, N, against ``drag`` N and the forces summed on it; in lanes."""
    missing = (p.drag_speed - car.speed) * p.body_mass_rate
    return car.holds_speed * maximum(missing + drag - car.longitudinal_force, 0.0)

"""The shortest stop that physics allows: a bound that no brake can beat."""

import math

from uictest.scenario.parts.vehicle import Vehicle

STANDARD_GRAVITY = 9.80665


def stopping_time_at_least(speed: float, friction: float, gradient: float, vehicle: Vehicle) -> float:
    """Seconds below which no stop from ``speed`` (m/s) can end, infinite when the car never stops.

    Friction, gradient and the running resistance at the initial speed act in full until the end.
    """
    resistance = vehicle.running_resistance
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    deceleration = STANDARD_GRAVITY * (friction + gradient) + drag / vehicle.total_mass
    return speed / deceleration if deceleration > 0.0 else math.inf

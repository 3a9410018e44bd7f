"""Loads of the wheels under a steady deceleration: what braking takes from the trailing ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uictest.core.units import STANDARD_GRAVITY
from uictest.plans import scenario

_WHEELS = 8
Array = NDArray[np.float64]


def wheel_loads(vehicle: scenario.Vehicle, deceleration: Array) -> Array:
    """Return the load of one wheel of each wheelset, N, shape (4, n), at decelerations in m/s2.

    The body leans on the leading bogie, each bogie on its leading wheelset: moments about the rail, springs
    at rest. Body and bogie pull at each other at the heights of link and secondary springs, shared by
    stiffness.
    """
    body, bogie, wheelset = vehicle.body, vehicle.bogie, vehicle.wheelset
    height = _coupling_height(vehicle)
    lean = body.mass * (body.height - height) / (2.0 * vehicle.half_pivot_distance)
    turning = (
        0.5 * body.mass * height
        + bogie.mass * bogie.height
        + 2.0 * wheelset.mass * wheelset.radius
        + 2.0 * wheelset.rotational_inertia / wheelset.radius
    ) / (2.0 * bogie.half_wheelbase)
    shares = np.array([0.25 * b * lean + 0.5 * w * turning for b in (1.0, -1.0) for w in (1.0, -1.0)])
    static = vehicle.total_mass * STANDARD_GRAVITY / _WHEELS
    loads: Array = static + np.outer(shares, deceleration)
    return loads


def _coupling_height(vehicle: scenario.Vehicle) -> float:
    sides = 2.0
    spring = sides * vehicle.secondary.longitudinal_stiffness
    link = vehicle.traction_link.stiffness
    return (spring * vehicle.secondary.height + link * vehicle.traction_link.height) / (spring + link)

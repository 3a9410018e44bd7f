"""The vehicle of the independent rig: masses, and a row of coordinates for each spring."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_GRAVITY: Final = 9.80665
_SIDE: Final = np.array([1.0, -1.0, 1.0, -1.0])


class Car:
    """Coordinates are x, z and pitch of the body and of both bogies, and x of the wheelsets.

    Attributes:
        masses: or moments of inertia, of each coordinate.
        weight: along the track per gradient, N.
        inertia: of a wheelset that turns, kg m2.
        static_load: of one wheel, N.
        rows: what of the coordinates stretches each spring; the last four carry the wheelsets.
        stiffness, damping: of each spring.
        behind: of each wheelset, distance to the first, m.
    """

    def __init__(self, car: Any) -> None:
        body, bogie, wheelset = car.loaded_body, car.bogie, car.wheelset
        masses = [body.mass, body.mass, body.pitch_inertia]
        masses += 2 * [bogie.mass, bogie.mass, bogie.pitch_inertia] + 4 * [wheelset.mass]
        self.masses = np.array(masses, dtype=float)
        self.inertia = float(wheelset.rotational_inertia)
        self.weight = np.zeros(13)
        moving = [0, 3, 6, 9, 10, 11, 12]
        self.weight[moving] = self.masses[moving] * _GRAVITY
        self.static_load = (body.mass + 2.0 * bogie.mass + 4.0 * wheelset.mass) * _GRAVITY / 8.0
        pivot, base = float(car.half_pivot_distance), float(bogie.half_wheelbase)
        rows, stiffness, damping = [], [], []

        def spring(first: Array, second: Array, k: float, c: float) -> None:
            rows.append(first - second)
            stiffness.append(float(k))
            damping.append(float(c))

        soft, link, hard = car.secondary, car.traction_link, car.primary
        for j, ahead in enumerate((pivot, -pivot)):
            for height, k, c in (
                (soft.height, 2.0 * soft.longitudinal_stiffness, 2.0 * soft.longitudinal_damping),
                (link.height, link.stiffness, link.damping),
            ):
                spring(_x(0, height - body.height), _x(3 + 3 * j, height - bogie.height), k, c)
            k, c = 2.0 * soft.vertical_stiffness, 2.0 * soft.vertical_damping
            spring(_z(0, ahead), _z(3 + 3 * j, 0.0), k, c)
        for i in range(4):
            at = 3 + 3 * (i // 2)
            k, c = 2.0 * hard.longitudinal_stiffness, 2.0 * hard.longitudinal_damping
            spring(np.eye(13)[9 + i], _x(at, wheelset.radius - bogie.height), k, c)
        for i in range(4):
            k, c = 2.0 * hard.vertical_stiffness, 2.0 * hard.vertical_damping
            spring(_z(3 + 3 * (i // 2), float(_SIDE[i]) * base), np.zeros(13), k, c)
        self.rows, self.stiffness, self.damping = np.array(rows), np.array(stiffness), np.array(damping)
        self.behind = pivot + base - np.array([pivot, pivot, -pivot, -pivot]) - _SIDE * base


def _x(frame: int, above: float) -> Array:
    """Return the row of the longitudinal place of a point above the centre of a frame."""
    row = np.zeros(13)
    row[frame], row[frame + 2] = 1.0, -float(above)
    return row


def _z(frame: int, ahead: float) -> Array:
    """Return the row of the height of a point ahead of the centre of a frame."""
    row = np.zeros(13)
    row[frame + 1], row[frame + 2] = 1.0, ahead
    return row

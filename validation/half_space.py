"""Longitudinal creep force of an elliptic contact by the theory of the elastic half-space.

Written for the validation alone: no formula of the rig's creep law is in it, and Kalker's coefficient c11
comes out instead of going in. Two equal half-spaces carry Hertz's pressure on an ellipse of rectangular
elements. A tangential load moves one surface against the other by (Cerruti; Kalker, Three-Dimensional Elastic
Bodies in Rolling Contact, Kluwer 1990)

    u = 1/(pi G) integral [(1 - nu)/r + nu x^2/r^3] p dA

and while the wheel rolls on by one element dx, slip = creepage dx - u(x) + u(x + dx). Elements stick, without
slip, or slip at the friction that belongs to their *own* slip speed. Lateral tractions, which are small, are
left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Friction = Callable[[Array], Array]
"""Friction coefficient as a function of the local slip speed, m/s."""

_ROUNDS = 60
_SETTLED = 1e-6
"""Largest change of a coefficient between two rounds that ends them."""


@dataclass(frozen=True)
class HalfSpaceContact:
    """An elliptic contact on a grid of elements.

    Args:
        along: semi-axis in the direction of rolling, m.
        across: the other semi-axis, m.
        shear_modulus: of both bodies, Pa.
        poisson: Poisson's ratio of both bodies.
        layer: thickness of a layer between the bodies over its shear modulus, m/Pa.
        elements: number of elements along and across the ellipse.
    """

    along: float
    across: float
    shear_modulus: float
    poisson: float
    layer: float = 0.0
    elements: int = 24
    _pressure: Array = field(init=False, repr=False)
    _rolled: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Find the elements inside the ellipse and what each moves where."""
        places = (np.arange(self.elements) + 0.5) * 2.0 / self.elements - 1.0
        x, y = (each.ravel() for each in np.meshgrid(places * self.along, places * self.across))
        height = 1.0 - (x / self.along) ** 2 - (y / self.across) ** 2
        x, y, pressure = x[height > 0.0], y[height > 0.0], np.sqrt(height[height > 0.0])
        east, north = x[:, None] - x, y[:, None] - y
        moved = self._influence(east, north) - self._influence(east + self._step, north)
        if self.layer > 0.0:
            moved += self._sheared(east, north) - self._sheared(east + self._step, north)
        object.__setattr__(self, "_pressure", pressure / pressure.sum())
        object.__setattr__(self, "_rolled", moved)

    @property
    def _step(self) -> float:
        """The length of an element, m."""
        return 2.0 * self.along / self.elements

    def _influence(self, east: Array, north: Array) -> Array:
        """Return the displacement of places by a unit force on an element that far from them, m/N."""
        half = np.array([self.along, self.across]) / self.elements
        total = np.zeros_like(east)
        for side, sign in ((1.0, 1.0), (-1.0, -1.0)):
            for end, turn in ((1.0, 1.0), (-1.0, -1.0)):
                x, y = east + side * half[0], north + end * half[1]
                r = np.hypot(x, y)
                along_x, along_y = y * np.log(x + r), x * np.log(y + r)
                total += sign * turn * (along_x + (1.0 - self.poisson) * along_y)
        return np.asarray(total / (np.pi * self.shear_modulus * 4.0 * half[0] * half[1]))

    def _sheared(self, east: Array, north: Array) -> Array:
        """Return what the layer yields under a unit force on an element: there, and nowhere else, m/N."""
        here = np.hypot(east, north) < 0.5 * min(self.along, self.across) / self.elements
        area = 4.0 * self.along * self.across / self.elements**2
        return np.where(here, self.layer / area, 0.0)

    def force(self, creepage: float, speed: float, load: float, friction: Friction) -> float:
        """Return the creep force in N at a creepage, for a speed in m/s and a wheel load in N."""
        bound, slipping = load * self._pressure, np.zeros(self._pressure.size, dtype=bool)
        rigid = creepage * self._step
        limit = bound * friction(np.zeros_like(bound))
        for _ in range(_ROUNDS):
            traction, slip = self._solved(slipping, limit, rigid)
            now = np.where(slipping, slip > 0.0, traction > limit)
            wanted = bound * friction(speed * np.maximum(slip, 0.0) / self._step)
            settled = np.max(np.abs(wanted - limit) / bound) < _SETTLED
            if settled and np.array_equal(now, slipping):
                return float(traction.sum())
            slipping, limit = now, 0.5 * (limit + wanted)
        raise ArithmeticError(f"no creep force at creepage {creepage:g}")

    def _solved(self, slipping: NDArray[np.bool_], limit: Array, rigid: float) -> tuple[Array, Array]:
        """Return tractions, N, and local slip over one element, m, for a division into stick and slip."""
        traction = np.where(slipping, limit, 0.0)
        stuck = ~slipping
        if stuck.any():
            known = rigid - self._rolled[np.ix_(stuck, slipping)] @ limit[slipping]
            traction[stuck] = np.linalg.solve(self._rolled[np.ix_(stuck, stuck)], known)
        return traction, rigid - self._rolled @ traction

"""A train of point axles on sanded rail: one mass, no wheel dynamics, no WSP.

A nozzle just ahead of axle k lays the density q(v)/v at each place that it passes; each axle leaves the share
kappa of what lay before it. So axle j at a place that it reaches when the train has run s meets

    d_j(s) = sum over nozzles k <= j of kappa^(j - k) q(v(s'))/v(s'),    s' = s - behind_j + behind_k >= 0

and carries min(f(d_j), demand/g) of its load, with the adhesion

    f(d) = mu0 + (mu_e - mu0) (1 - exp(-m d/(mu_e - mu0))).

The train decelerates by g times the mean over its axles. It brakes fully from the first metre, and all
sanders work from the first metre to standstill.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

GRAVITY: Final = 9.81
"""m/s2."""
_STEP: Final = 2.0
"""Distance of a step, m; the distances of half of it differ by less than 0.5 m."""
_CAR, _PIVOTS, _WHEELBASE = 20.0, 14.0, 2.6
"""Length over couplers, distance of the pivots and wheelbase, m; chosen: a multiple unit of 20 m cars."""


@dataclass(frozen=True, slots=True)
class SandLaw:
    """Adhesion over density.

    Args:
        slope: m, of the first sand, m/g.
        end: mu_e, with any amount of sand.
        untreated: mu0.
    """

    slope: float
    end: float
    untreated: float = 0.02

    def adhesion(self, density: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return f for densities in g/m."""
        gain = self.end - self.untreated
        return self.untreated - gain * np.expm1(-self.slope * density / gain)


@dataclass(frozen=True, slots=True)
class Sander:
    """A sander; it lays `density`, g/m, up to the rate `rate`, g/s, just ahead of an axle, counted from 1."""

    axle: int
    rate: float
    density: float = float("inf")

    def laid(self, speed: float) -> float:
        """Return the density that it lays at a speed in m/s, g/m."""
        return min(self.rate / max(speed, 0.01), self.density)


@dataclass(frozen=True, slots=True)
class SandedStop:
    """Distance in m, and the sand that each sander has laid in its first 30 s, g."""

    distance: float
    sand_in_30_s: tuple[float, ...]


def places_of_axles(cars: int = 4) -> NDArray[np.float64]:
    """Return how far each axle runs behind the first one, m."""
    bogie = np.array([0.0, _WHEELBASE])
    car = np.concatenate([bogie, bogie + _PIVOTS])
    return np.concatenate([car + _CAR * k for k in range(cars)])


def stop(
    speed: float,
    demand: float,
    law: SandLaw,
    sanders: Sequence[Sander] = (),
    kept: float = 0.8,
    step: float = _STEP,
) -> SandedStop:
    """Brake to standstill.

    Args:
        speed: initial, m/s.
        demand: deceleration that the brake would give on any rail that carries it, m/s2.
        law: adhesion over density.
        sanders: in any order.
        kept: kappa.
        step: distance of a step, m.
    """
    behind = places_of_axles()
    nozzles = [Nozzle(sander, behind, kept, step) for sander in sanders]
    used = [0.0] * len(sanders)
    squared, time, run = speed**2, 0.0, 0.0
    while True:
        now = float(np.sqrt(squared))
        density = np.zeros(behind.size)
        for nozzle in nozzles:
            nozzle.add_sand(density, now)
        carried = np.minimum(law.adhesion(density), demand / GRAVITY)
        deceleration = GRAVITY * float(carried.mean())
        left = squared - 2.0 * deceleration * step
        passed = step if left > 0.0 else squared / (2.0 * deceleration)
        if time < 30.0:
            used = [mass + each.laid[0] * passed for mass, each in zip(used, nozzles, strict=True)]
        run += passed
        if left <= 0.0:
            return SandedStop(run, tuple(used))
        time += 2.0 * step / (now + float(np.sqrt(left)))
        squared = left


class Nozzle:
    """What the nozzle of a sander has laid, latest first, and what each axle finds of it.

    Args:
        sander: whose nozzle it is.
        behind: how far each axle runs behind the first one, m.
        kept: kappa.
        step: distance of a step, m.
    """

    def __init__(self, sander: Sander, behind: NDArray[np.float64], kept: float, step: float) -> None:
        self._sander, self._first = sander, sander.axle - 1
        later = behind[self._first :] - behind[self._first]
        self._steps_ago = np.round(later / step).astype(int)
        self._left = kept ** np.arange(later.size)
        self.laid = np.zeros(self._steps_ago[-1] + 1)

    def add_sand(self, density: NDArray[np.float64], speed: float) -> None:
        """Lay the sand of a step, and add what is left of all of it under each axle."""
        self.laid[1:] = self.laid[:-1]
        self.laid[0] = self._sander.laid(speed)
        density[self._first :] += self._left * self.laid[self._steps_ago]


def bisect(function: Callable[[float], float], low: float, high: float, target: float) -> float:
    """Return where a decreasing function has a value; the nearer end where it has it nowhere."""
    for _ in range(24):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) > target else (low, middle)
    return 0.5 * (low + high)

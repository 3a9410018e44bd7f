"""One recorded stop on a rail that sliding cleans: its unknowns and its residuals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from uictest.recorded.fitting.balances import Balances
from uictest.recorded.fitting.least_squares import Groups
from uictest.recorded.fitting.stretches import HIGHEST, LOWEST, RailUnderStop

Array = NDArray[np.float64]

_START_SHARE = 0.7
"""Friction of the rail as found to begin with, over that of a rail which nothing cleans; chosen."""
_LONGEST_DELAY = 0.05
"""s by which speed sensors of wheelsets may answer later than that of the train, or earlier; chosen."""
_GAIN_ERROR = 0.01
"""Standard deviation to which the brake force of each wheelset is known, share; chosen."""
_LOWEST_GAIN, _HIGHEST_GAIN = 0.8, 1.2
_WHEELSETS = 4
_KEPT = 8
"""Impulses of the rail that are kept: of the point that a gradient is taken at, and of its neighbours."""


@dataclass(frozen=True, eq=False)
class CleanedStop:
    """One stop on a rail that sliding cleans: its unknowns are the friction of the free stretches, the delay
    of the wheel speeds in s and, where brake forces are recorded, a factor on that of each wheelset.
    """

    rail: RailUnderStop

    @property
    def levels(self) -> int:
        """How many of the unknowns are frictions; they come first."""
        return len(self.rail.free)

    @cached_property
    def start(self) -> list[float]:
        """Values of the unknowns to begin with."""
        friction = [_START_SHARE * level for level in self.rail.stretches.start]
        return [*friction, 0.0, *[1.0] * self._gains]

    @property
    def bounds(self) -> tuple[list[float], list[float]]:
        """Lowest and highest values of the unknowns."""
        lowest = [*[LOWEST] * self.levels, -_LONGEST_DELAY, *[_LOWEST_GAIN] * self._gains]
        return lowest, [*[HIGHEST] * self.levels, _LONGEST_DELAY, *[_HIGHEST_GAIN] * self._gains]

    def known(self, x: Array) -> Array:
        """Return by how many standard deviations the factors on the brake forces differ from one."""
        return np.asarray((x[self.levels + 1 :] - 1.0) / _GAIN_ERROR)

    def residuals(self, x: Array, energy: float, recovered_friction: float) -> Groups:
        """Return the residuals of the balances."""
        of_rail = tuple(x[: self.levels + 1].tolist())
        balances, by_rail = self._by_rail(of_rail, energy, recovered_friction)
        factors = x[self.levels + 1 :][:, None] if self._gains else 1.0
        return balances.residuals_by(by_rail, factors)

    def largest_share(self, x: Array, energy: float, recovered_friction: float) -> float:
        """Return the cleaned share of the cleanest rail under a sliding wheelset."""
        _, share = self.rail.met(x[: self.levels], energy, recovered_friction)
        return float(np.max(share, where=self._balances.samples.sliding, initial=0.0))

    @property
    def _balances(self) -> Balances:
        return self.rail.stretches.balances

    @property
    def _gains(self) -> int:
        return 0 if self._balances.samples.torque is None else _WHEELSETS

    @cached_property
    def _by_rail(self) -> Callable[[tuple[float, ...], float, float], tuple[Balances, Array]]:
        """Levels and delay, energy and recovered friction: the balances and the impulse of the rail.

        A gradient varies one unknown at a time: most leave those of the rail under this stop as they are.
        """

        @lru_cache(_KEPT)
        def found(of_rail: tuple[float, ...], energy: float, recovered: float) -> tuple[Balances, Array]:
            *levels, delay = of_rail
            balances = self._without_delay(delay)
            friction, _ = self.rail.met(np.array(levels), energy, recovered, balances.samples.slip)
            return balances, balances.rail_impulse(friction)

        return found

    def _without_delay(self, delay: float) -> Balances:
        """Return the balances with wheel speeds that are read later by a delay."""
        s = self._balances.samples
        wheels = np.array([np.interp(s.time + delay, s.time, each) for each in s.wheel_speed])
        return replace(self._balances, samples=replace(s, wheel_speed=wheels, slip=s.speed - wheels))

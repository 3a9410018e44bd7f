"""The rail under a recorded stop: stretches of constant friction, and one that sliding cleans."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.recorded.fitting.balances import Balances
from uictest.recorded.fitting.least_squares import Groups

Array = NDArray[np.float64]
Standing = Literal["found", "at least", "not reached"]

LOWEST, HIGHEST = 0.001, 1.0
"""Friction coefficients that a scenario accepts."""
_FEWEST = 4
"""Windows of sliding in a stretch below which its friction is not determined; chosen."""
_START_SHARE = 1.15
"""Friction to begin with, over the largest adhesion used; chosen."""
_BOUND_PERCENTILE = 95.0
"""Of the adhesion used while rolling, taken as the lower bound: single windows are noise; chosen."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """One quantity: its value and the half width of its 95 % confidence interval, or why there is none.

    `at least`: nothing slid there, so that the value is only a lower bound. `not reached`: no wheelset came
    there. `windows` counts the windows that determine it.
    """

    name: str
    standing: Standing
    value: float
    half_width: float
    windows: int

    def __str__(self) -> str:
        """Return the estimate for a reader."""
        if self.standing == "not reached":
            return f"{self.name}: no wheelset came there"
        if self.standing == "at least":
            return f"{self.name}: at least {self.value:.4f}; nothing slid there, so it may be higher"
        share = 100.0 * self.half_width / self.value
        return f"{self.name}: {self.value:.4f} +- {self.half_width:.4f} ({share:.1f} %, 95 % confidence)"


@dataclass(frozen=True, slots=True, eq=False)
class Stretches:
    """The rail under a stop in stretches between `breaks`, m from the brake command, rising."""

    balances: Balances
    breaks: tuple[float, ...]

    @property
    def number(self) -> NDArray[np.intp]:
        """Number of the stretch under each wheelset at each sample, from 0, (4, n)."""
        return stretch_of(self.balances.samples.place, self.breaks)

    @property
    def counts(self) -> list[int]:
        """Windows of sliding in each stretch."""
        sliding, where = self.balances.windows.sliding, self._number_in_windows
        return [int((sliding & (where == k)).sum()) for k in range(len(self.breaks) + 1)]

    @property
    def free(self) -> list[int]:
        """The stretches whose friction the stop determines."""
        return [k for k, count in enumerate(self.counts) if count >= _FEWEST]

    @property
    def start(self) -> list[float]:
        """A friction to begin with for each of the free stretches."""
        used = self.balances.adhesion_used()[self.balances.windows.sliding]
        begin = float(np.clip(_START_SHARE * np.median(used), 0.01, 0.9)) if len(used) else 0.1
        return [begin] * len(self.free)

    def estimates(self, values: Sequence[float], half_widths: Sequence[float]) -> tuple[Estimate, ...]:
        """Return the friction of every stretch; values and half widths are those of the free ones."""
        found = dict(zip(self.free, zip(values, half_widths, strict=True), strict=True))
        counts = self.counts
        return tuple(
            Estimate(f"friction {name}", "found", *found[k], counts[k])
            if k in found
            else self._lower_bound(k, f"friction {name}")
            for k, name in enumerate(stretch_names(self.breaks))
        )

    @property
    def _number_in_windows(self) -> NDArray[np.intp]:
        windows = self.balances.windows
        return self.number[:, (windows.first + windows.last) // 2]

    def _lower_bound(self, number: int, name: str) -> Estimate:
        there = self._number_in_windows == number
        if not there.any():
            return Estimate(name, "not reached", float("nan"), float("nan"), 0)
        used = self.balances.adhesion_used()[there & ~self.balances.windows.standing]
        bound = max(float(np.percentile(used, _BOUND_PERCENTILE)), LOWEST) if len(used) else LOWEST
        return Estimate(name, "at least", bound, float("nan"), int(there.sum()))


def stretch_of(place: Array, breaks: Sequence[float]) -> NDArray[np.intp]:
    """Return the number of the stretch, from 0, in which each place (m) lies; `breaks` in rising order, m."""
    return np.searchsorted(np.asarray(breaks, dtype=np.float64), place, side="right")


def stretch_names(breaks: Sequence[float]) -> list[str]:
    """Return the name of each stretch, as in "from 50 m to 120 m"."""
    if not breaks:
        return ["everywhere"]
    ends = [f"{place:g} m" for place in breaks]
    inner = [f"from {a} to {b}" for a, b in pairwise(ends)]
    return [f"up to {ends[0]}", *inner, f"from {ends[-1]} on"]


class RailUnderStop:
    """The rail under a stop whose balances are drawn, for any friction of it."""

    def __init__(self, stretches: Stretches) -> None:
        self.stretches = stretches
        self.free = stretches.free
        self._number = stretches.number
        balances = stretches.balances
        s = balances.samples
        self._cleaned = None
        if balances.scenario.rail.cleaning_in_force is not None:
            self._cleaned = rig.RecordedRail(balances.scenario, s.time, s.speed, s.place, s.load)

    def found(self, levels: Array) -> Array:
        """Return the friction of the rail as found under each wheelset, (4, n), from the free stretches'."""
        every = np.full(len(self.stretches.breaks) + 1, HIGHEST)
        every[self.free] = levels
        return np.asarray(every[self._number])

    def met(
        self, levels: Array, energy: float, recovered_friction: float, slip: Array | None = None
    ) -> tuple[Array, Array]:
        """Return friction and cleaned share under each wheelset, (4, n), where sliding cleans the rail.

        Args:
            levels: friction of the free stretches as found.
            energy: Wc, J/m.
            recovered_friction: mur.
            slip: slip speeds, m/s, (4, n); None: as recorded.
        """
        assert self._cleaned is not None
        recorded = self.stretches.balances.samples.slip
        return self._cleaned.met(
            self.found(levels), recorded if slip is None else slip, energy, recovered_friction
        )

    def met_as_stated(self, levels: Array) -> tuple[Array, Array | None]:
        """Return friction and cleaned share under each wheelset, (4, n), with the cleaning as stated."""
        cleaning = self.stretches.balances.scenario.rail.cleaning_in_force
        if cleaning is None:
            return self.found(levels), None
        return self.met(levels, float(cleaning.energy), float(cleaning.recovered_friction))


_UNCLEANED_SHARE = 0.7
"""Friction of the rail as found to begin with, over that of a rail which nothing cleans; chosen."""
_LONGEST_DELAY = 0.05
"""s by which speed sensors of wheelsets may answer later than that of the train, or earlier; chosen."""
_GAIN_ERROR = 0.01
"""Standard deviation to which the brake force of each wheelset is known, share; chosen."""
_LOWEST_GAIN, _HIGHEST_GAIN = 0.8, 1.2
"""Span of the brake force of a wheelset that a fit may find, over the stated one; chosen."""
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
        friction = [_UNCLEANED_SHARE * level for level in self.rail.stretches.start]
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
            met = self.rail.met(np.array(levels), energy, recovered, balances.samples.slip)
            return balances, balances.rail_impulse(*met)

        return found

    @cached_property
    def _without_delay(self) -> Callable[[float], Balances]:
        """The balances with wheel speeds that are read later by a delay, which few of the unknowns change."""

        @lru_cache(_KEPT)
        def read_earlier(delay: float) -> Balances:
            s = self._balances.samples
            wheels = np.array([np.interp(s.time + delay, s.time, each) for each in s.wheel_speed])
            return replace(self._balances, samples=replace(s, wheel_speed=wheels, slip=s.speed - wheels))

        return read_earlier

"""The rail under a recorded stop: stretches of constant friction, and one that sliding cleans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.recorded.fitting.balances import Balances

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
        share = 100.0 * self.half_width / abs(self.value)
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
        if self.balances.samples.torque is None:  # The train alone tells, where all slide.
            sliding = sliding & sliding.all(axis=0)
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
            self._cleaned = rig.RecordedRail(balances.scenario, s.time, s.speed, s.place, s.load, s.slip)

    def met(self, levels: Array) -> tuple[Array, Array | None]:
        """Return friction and cleaned share under each wheelset, (4, n), by the friction of the free ones."""
        every = np.full(len(self.stretches.breaks) + 1, HIGHEST)
        every[self.free] = levels
        found = np.asarray(every[self._number])
        return (found, None) if self._cleaned is None else self._cleaned.met(found)

"""The friction that each wheelset of a recorded stop met: of the rail as found, or as sliding cleaned it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.recorded.fitting.stretches import HIGHEST, Stretches

Array = NDArray[np.float64]


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

    def met_as_stated(self, levels: Array) -> Array:
        """Return the friction that each wheelset met, (4, n), with the cleaning that the scenario states."""
        cleaning = self.stretches.balances.scenario.rail.cleaning_in_force
        if cleaning is None:
            return self.found(levels)
        return self.met(levels, float(cleaning.energy), float(cleaning.recovered_friction))[0]

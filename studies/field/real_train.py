"""The four figures of the real train's stop, and how far a stop of the rig lies from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, isfinite
from types import MappingProxyType
from typing import Final

from uictest.units import KILOMETRE_PER_HOUR

REAL_TRAIN: Final = MappingProxyType(
    {
        "braking_time": 17.6,
        "braking_distance": 197.0,
        "minimum_deceleration": 0.98,
        "maximum_deceleration": 1.52,
    }
)
"""Stated by Lee and Kang (2015): s, m, m/s2, m/s2."""
INITIAL_SPEED: Final = 80.0 * KILOMETRE_PER_HOUR
"""Stated by them, too, m/s."""
TOLERANCES: Final = MappingProxyType(
    {
        "braking_time": 0.35,
        "braking_distance": 4.0,
        "minimum_deceleration": 0.1,
        "maximum_deceleration": 0.1,
    }
)
"""Chosen: 2 % of time and distance, and the possible effect of the unknown filter of the decelerations."""
RUN: Final = ("braking_time", "braking_distance")


@dataclass(frozen=True, slots=True)
class FieldStop:
    """What a stop of the rig gives beside the real train's.

    Args:
        figures: the measures of :data:`REAL_TRAIN`, SI; NaN where the train did not stop.
        actuations: of the WSP valve of each wheelset.
        largest_slide: of any wheelset, share.
    """

    figures: Mapping[str, float]
    actuations: tuple[int, ...]
    largest_slide: float

    @property
    def misfits(self) -> dict[str, float]:
        """The difference of each figure from the real train's, in tolerances; infinite if there is none."""
        return {name: _misfit(name, self.figures[name]) for name in REAL_TRAIN}

    @property
    def misfit(self) -> float:
        """The largest of the misfits."""
        return max(self.misfits.values())

    @property
    def agrees(self) -> bool:
        """Whether all four figures lie within their tolerances."""
        return self.misfit <= 1.0

    @property
    def agrees_in_run(self) -> bool:
        """Whether time and distance lie within their tolerances."""
        return max(self.misfits[name] for name in RUN) <= 1.0


def _misfit(name: str, figure: float) -> float:
    off = abs(figure - REAL_TRAIN[name]) / TOLERANCES[name]
    return off if isfinite(off) else inf


def even_braking_delay() -> float:
    """Return the delay, s, after which an even deceleration takes the real train's time and distance.

    T = v / a + delay and D = v (T + delay) / 2.
    """
    return 2.0 * REAL_TRAIN["braking_distance"] / INITIAL_SPEED - REAL_TRAIN["braking_time"]

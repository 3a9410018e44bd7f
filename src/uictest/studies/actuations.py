"""Valve actuations of the slide test by the origin of the clamping force, as the paper counts them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.studies.neighbourhood import FOUR_CALIPER, WITHOUT_CALIPER

Counts = NDArray[np.float64]
"""Actuations in repeats of a stop, in the order of their seeds."""

COUNTED: Final = MappingProxyType(
    {
        "caliper": ("full", 1),
        "none": ("none", 2),
        "full": ("full", 2),
        "thermal": ("thermal", 2),
        "reference": (FOUR_CALIPER, 2),
    }
)
"""Rig (or setting of the rig with one caliper) and module, 1 to 4, whose actuations each name stands for."""
PAPER: Final = MappingProxyType({"caliper": 11, "none": 21, "full": 11})
"""Counts in one stop, stated by Lee and Kang (2015)."""
BANDS: Final = MappingProxyType({"caliper": (10.0, 12.0), "none": (19.0, 23.0), "full": (10.0, 12.0)})
"""Bands about the paper's counts, both ends included; chosen."""
APART: Final = 1.3
"""Ratio above which the actuations without compensation are clearly more than those with it; chosen."""


def counts(stops: Mapping[str, Sequence[rig.SimulatedStop]]) -> dict[str, Counts]:
    """Return every count of :data:`COUNTED` in the repeats of a stop on every rig."""
    return {key: _of_module(stops[name], module) for key, (name, module) in COUNTED.items()}


def mean_counts(stops: Sequence[rig.SimulatedStop]) -> Counts:
    """Return the actuations per wheelset in repeats of a stop, mean of modules 2 to 4."""
    return np.asarray(np.mean([_of_module(stops, module) for module in WITHOUT_CALIPER], axis=0))


def in_order(caliper: Counts, compensated: Counts, none: Counts) -> NDArray[np.bool_]:
    """Return in which repeats none is clearly above the compensated count, and farther from the caliper's."""
    return (none > APART * compensated) & (abs(compensated - caliper) < abs(none - caliper))


def in_bands(counts: Mapping[str, Counts]) -> NDArray[np.bool_]:
    """Return in which repeats all three counts of the paper lie in their bands."""
    within = [(counts[key] >= lower) & (counts[key] <= upper) for key, (lower, upper) in BANDS.items()]
    return np.asarray(np.all(within, axis=0))


def _of_module(stops: Sequence[rig.SimulatedStop], module: int) -> Counts:
    return np.array([float(stop.wheelset_measures[module - 1].valve_actuations) for stop in stops])

"""Plausible values of recordings of trains, and channels of states instead of signals."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.instants import usual_interval
from uictest.core.units import BAR, KILOMETRE_PER_HOUR

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Implausible:
    """The reason for which samples are implausible in their unit, and the likely unit; empty: none fits."""

    reason: str
    likely_unit: str


@dataclass(frozen=True, slots=True)
class Limit:
    """A number in SI, and its text for messages."""

    value: float
    text: str


# All chosen, far beyond what occurs: 603 km/h is the fastest run of a train (L0 series, 2015), compressed-air
# brakes work below 12 bar, a caliper clamps with some ten kN.
LARGEST: Final = MappingProxyType(
    {
        "m/s": Limit(1000.0 * KILOMETRE_PER_HOUR, "1000 km/h"),
        "Pa": Limit(100.0 * BAR, "100 bar"),
        "N": Limit(1e7, "10 MN"),
        "N m": Limit(1e6, "1000 kN m"),
        "m": Limit(1e10, "10 million km"),
    }
)
"""SI unit -> largest magnitude of a sample."""
SHORTEST_INTERVAL: Final = Limit(1e-5, "0.01 ms")
LONGEST_INTERVAL: Final = Limit(5.0, "5 s")
"""Between two samples; chosen. An interval longer than a second shows no slide."""
_USUAL_INTERVAL: Final = 0.01
"""s: of several units that are plausible, the one whose interval comes closest is the likeliest; chosen."""
LONGEST_RECORD: Final = Limit(86_400.0, "one day")
FEW: Final = 0.1
"""Share of samples beyond the largest that may be faults; more say that the unit is wrong; chosen."""


def beyond(samples: Array, si: str) -> NDArray[np.bool_]:
    """Return the mask of finite samples, in SI, that are implausibly large."""
    limit = LARGEST.get(si)
    if limit is None:
        return np.zeros(len(samples), dtype=np.bool_)
    return np.asarray(np.isfinite(samples) & (np.abs(samples) > limit.value))


def implausible_unit(
    samples: Array, si: str, unit: str, sizes: Mapping[str, float], faulty: float = FEW
) -> Implausible | None:
    """Return the reason for which samples are implausible in a unit; None if they are plausible.

    Args:
        samples: as SI, converted from `unit`.
        si: the SI unit.
        unit: the stated unit of the samples; a key of `sizes`.
        sizes: unit -> its size in SI, the likelier first.
        faulty: share of samples that may be beyond the largest for other reasons.

    """
    numbers, limit = np.abs(samples[~np.isnan(samples)]), LARGEST.get(si)
    if limit is None or not len(numbers) or np.mean(numbers > limit.value) <= faulty:
        return None
    largest = float(numbers.max())
    likely = next((other for other, size in sizes.items() if largest / sizes[unit] * size <= limit.value), "")
    return Implausible(
        f"reaches {largest / sizes[unit]:.4g} {unit}; at most {limit.text} is plausible", likely
    )


def implausible_time(
    time: Array, unit: str, sizes: Mapping[str, float], longest: float = LONGEST_RECORD.value
) -> Implausible | None:
    """Return the reason for which times, s, are implausible; None if they are plausible or do not rise.

    `unit` is their stated unit, a key of `sizes` (unit -> s); they may span `longest`, s.
    """
    rising = len(time) > 1 and bool(np.isfinite(time).all()) and bool((time[1:] > time[:-1]).all())
    if not rising or _is_plausible_time(time, 1.0, longest):
        return None
    fitting = [
        other for other, size in sizes.items() if _is_plausible_time(time, size / sizes[unit], longest)
    ]
    first, last, step = time[0] / sizes[unit], time[-1] / sizes[unit], usual_interval(time) / sizes[unit]
    likely = min(fitting, key=lambda other: abs(math.log(step * sizes[other] / _USUAL_INTERVAL)), default="")
    return Implausible(
        f"runs from {first:.6g} to {last:.6g} {unit} with a sample every {step:.4g} {unit};"
        f" {SHORTEST_INTERVAL.text} to {LONGEST_INTERVAL.text} between samples and at most"
        f" {LONGEST_RECORD.text} are plausible",
        likely,
    )


def _is_plausible_time(time: Array, factor: float, longest: float) -> bool:
    interval, duration = usual_interval(time) * factor, float(time[-1] - time[0]) * factor
    return SHORTEST_INTERVAL.value <= interval <= LONGEST_INTERVAL.value and duration <= longest


STATES: Final = MappingProxyType(
    {
        "valve_command": MappingProxyType({"fill": 0, "hold": 1, "vent": 2}),
        "hold_magnet": MappingProxyType({"off": 0, "on": 1}),
        "vent_magnet": MappingProxyType({"off": 0, "on": 1}),
        "diagnosis": MappingProxyType({}),
        "active_faults": MappingProxyType({}),
        "speed_valid": MappingProxyType({"no": 0, "yes": 1}),
        "brake_command": MappingProxyType({"released": 0, "applied": 1}),
    }
)
"""Kind of state -> names of its states and the numbers that stand for them; bits have no names."""

_WHEELSET_SUFFIX: Final = re.compile(r"_[1-4]$")


def state_kind(channel: str) -> str | None:
    """Return the kind of state of a canonical channel; None for a signal."""
    kind = _WHEELSET_SUFFIX.sub("", channel)
    return kind if kind in STATES else None


def states_of(channel: str) -> Mapping[str, int]:
    """Return the names of the states of a canonical channel and their numbers; empty for bits and signals."""
    return STATES.get(state_kind(channel) or "", {})

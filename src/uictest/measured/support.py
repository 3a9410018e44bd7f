"""Which measures a record supports, and why the others are not applicable."""

from __future__ import annotations

from collections.abc import Iterator
from types import MappingProxyType
from typing import Final

import numpy as np

from uictest.measured.channels import of_wheelsets
from uictest.measured.prepare import MeasuredStop
from uictest.recording import TIME

_WHEELS: Final = ("speed", *of_wheelsets("wheel_speed"))

_THROUGHOUT: Final = MappingProxyType(
    {
        "initial_adhesion": _WHEELS,
        "maximum_slide": _WHEELS,
        "locked_time": _WHEELS,
        "longest_lock": _WHEELS,
        "sliding_duration": _WHEELS,
        "minimum_deceleration": ("speed",),
        "maximum_deceleration": ("speed",),
        "reservoir_minimum_pressure": ("reservoir_pressure",),
        "valve_actuations": of_wheelsets("valve_command"),
        "maximum_clamping_force": of_wheelsets("clamping_force"),
    }
)
"""Measure -> channels that must be known throughout the stop."""

_AT_THE_ENDS: Final = MappingProxyType(
    {
        "braking_distance": ("speed", "distance"),
        "mean_deceleration": ("speed", "distance"),
        "braking_time": ("speed",),
        "standstill": ("speed",),
    }
)
"""Measure -> channels that must be known at the brake command and at standstill."""

_NEVER: Final = MappingProxyType(
    {
        "energy_residual": "a record holds no energy balance",
        "air_residual": "a record holds no air balance",
        "air_consumed": "a record holds no flow of air",
        "air_vented": "a record holds no flow of air",
    }
)

_FROM_THE_COMMAND: Final = frozenset(
    {"braking_distance", "braking_time", "mean_deceleration", "minimum_deceleration", "initial_adhesion"}
)
"""Measures that count from the brake command."""


def unsupported(stop: MeasuredStop) -> dict[str, str]:
    """Return the measures that a record does not support, each with the reason."""
    reasons = dict(_NEVER)
    if stop.standstill is None:
        reasons["standstill"] = "the record ends before standstill"
    for measure, channels in {**_THROUGHOUT, **_AT_THE_ENDS}.items():
        found = list(_reasons(stop, measure, channels))
        if found and measure not in reasons:
            reasons[measure] = "; ".join(dict.fromkeys(found))
    return reasons


def _reasons(stop: MeasuredStop, measure: str, channels: tuple[str, ...]) -> Iterator[str]:
    if stop.trigger.late and measure in _FROM_THE_COMMAND:
        yield "the record begins after the brake command"
    missing = [name for name in channels if name not in stop.recording.channels]
    if missing:
        yield f"not recorded: {', '.join(missing)}"
    for defect in stop.defects:
        if defect.spoils and defect.channel in channels:
            yield str(defect)
    for name in channels:
        if name in stop.recording.channels:
            yield from _unknown(stop, name, throughout=measure in _THROUGHOUT)


def _unknown(stop: MeasuredStop, name: str, *, throughout: bool) -> Iterator[str]:
    unknown = ~np.isfinite(stop.recording[name])
    time = stop.recording[TIME]
    if throughout and unknown.any():
        first, last = time[unknown][[0, -1]]
        yield f"{name} is not known from {first:.6g} to {last:.6g} s after the brake command"
    elif name == "distance" and (
        unknown[0] or (stop.standstill is not None and not np.isfinite(stop.standstill[1]))
    ):
        yield (
            "the distance is not known: the speed it is integrated from has a gap"
            if not unknown[0]
            else ("distance is not known at the brake command")
        )

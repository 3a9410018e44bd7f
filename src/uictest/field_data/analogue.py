"""Defects of pressure sensors and loadcells: readings that stick, or are off with the brake released."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Final

import numpy as np

from uictest.field_data.channels import of_wheelsets
from uictest.field_data.defect import Defect
from uictest.field_data.raw import RawChannel

_LARGEST_OFFSET: Final = MappingProxyType(
    {"cylinder_pressure": (0.15e5, "Pa"), "tank_pressure": (0.15e5, "Pa"), "clamping_force": (1000.0, "N")}
)
"""Reading with the brake released that a sound sensor may show; chosen."""
_RELEASED = 0.02
"""s after the brake command in which no brake acts yet; chosen."""
_LEAST_CHANGE = 0.1
"""Share of the largest reading by which the other wheelsets' sensors must change meanwhile; chosen."""


def analogue_defects(channels: Mapping[str, RawChannel], begin: float, end: float) -> Iterator[Defect]:
    """Yield the defects of pressures and forces in a stop from `begin` to `end` (s in the file's time)."""
    for kind, (largest, unit) in _LARGEST_OFFSET.items():
        names = [name for name in of_wheelsets(kind) if name in channels]
        for name in names:
            yield from _offset(channels[name], begin, largest, unit)
            others = [channels[other] for other in names if other != name]
            yield from _stuck(channels[name], others, begin, end)


def _offset(channel: RawChannel, begin: float, largest: float, unit: str) -> Iterator[Defect]:
    before = channel.time <= begin + _RELEASED
    reading = channel.samples[before & (channel.time >= begin - 1.0) & np.isfinite(channel.samples)]
    if len(reading) and abs(float(np.median(reading))) > largest:
        text = f"reads {float(np.median(reading)):.4g} {unit} with the brake released"
        yield Defect("offset", channel.name, text, spoils=True)


def _stuck(channel: RawChannel, others: list[RawChannel], begin: float, end: float) -> Iterator[Defect]:
    reading = _part(channel, begin, end)
    if len(reading) < 3 or np.ptp(reading) > 0.0:
        return
    changes = [
        np.ptp(part) > _LEAST_CHANGE * np.max(np.abs(part))
        for o in others
        if len(part := _part(o, begin, end))
    ]
    if any(changes):
        yield Defect("stuck", channel.name, f"stays at {reading[0]:.6g} throughout the stop", spoils=True)


def _part(channel: RawChannel, begin: float, end: float) -> np.ndarray:
    inside = (channel.time >= begin) & (channel.time <= end) & np.isfinite(channel.samples)
    return channel.samples[inside]

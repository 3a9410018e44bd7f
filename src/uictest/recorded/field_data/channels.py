"""The channels this program knows by name: those of a simulated recording, and the brake command."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

from uictest.rig import CAR_CHANNELS, WHEELSET_CHANNELS

WHEELSETS: Final = (1, 2, 3, 4)
"""Numbers of the wheelsets, from the leading end."""

CHANNEL_UNITS: Final = MappingProxyType(
    {
        **dict(CAR_CHANNELS),
        "brake_command": "1",
        **{f"{name}_{n}": unit for n in WHEELSETS for name, unit in WHEELSET_CHANNELS},
    }
)
"""Canonical channel -> its SI unit. Pressures are gauge, wheel speeds circumferential."""


def of_wheelsets(kind: str) -> tuple[str, ...]:
    """Return the channels of one kind of all wheelsets, as in `wheel_speed_1` .. `wheel_speed_4`."""
    return tuple(f"{kind}_{n}" for n in WHEELSETS)

"""Channels of states instead of signals: a state holds until the next sample."""

from __future__ import annotations

import re
from types import MappingProxyType
from typing import Final

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

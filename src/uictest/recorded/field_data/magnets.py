"""Valve commands of a record that holds the two magnets of each valve instead."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from uictest.core.physics import FILL, HOLD, VENT
from uictest.recorded.field_data.channels import WHEELSETS
from uictest.recorded.field_data.raw_channels import Array, RawChannel

_ON = 0.5


def with_valve_commands(channels: Mapping[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels with the valve command of every wheelset whose two magnets have common times."""
    return {**dict(_commands(channels)), **channels}


def _commands(channels: Mapping[str, RawChannel]) -> Iterator[tuple[str, RawChannel]]:
    for n in WHEELSETS:
        hold, vent = (channels.get(f"{magnet}_{n}") for magnet in ("hold_magnet", "vent_magnet"))
        if hold is not None and vent is not None and np.array_equal(hold.time, vent.time):
            name, sources = f"valve_command_{n}", f"{hold.source}, {vent.source}"
            yield name, RawChannel(name, sources, hold.time, _command(hold.samples, vent.samples))


def _command(hold: Array, vent: Array) -> Array:
    """Return the commands; a valve that vents does so whatever its other magnet shows."""
    command = np.where(vent > _ON, VENT, np.where(hold > _ON, HOLD, FILL))
    return np.where(np.isfinite(hold) & np.isfinite(vent), command, np.nan)

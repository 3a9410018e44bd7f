"""Work and largest force of the rail in a recorded stop, from adhesion, wheel load and friction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import TIME, Recording
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans import scenario
from uictest.recorded.field_data.channels import WHEELSETS
from uictest.rig import highest_creep_forces

Array = NDArray[np.float64]
_WHEELS: Final = 2.0
"""Of a wheelset: adhesion and wheel load are those of one."""


@dataclass(frozen=True, slots=True)
class RailContact:
    """Contacts of the four wheelsets at every sample, shape (n, 4); NaN where a channel is missing.

    Args:
        rail_work: of the rail on the wheelset since the first sample, against its motion, J.
        contact_loss: energy turned into heat in its contacts since then, J.
        highest_force: that both contacts could transmit, N.
        mass: of the train, kg.

    """

    rail_work: Array
    contact_loss: Array
    highest_force: Array
    mass: float


def rail_contact(recording: Recording, condition: scenario.RailCondition) -> RailContact:
    """Return the contacts of a recorded stop.

    Work is integrated by trapezoids; a gap adds none. The mass is that of the mean wheel loads.
    """
    speed = recording["speed"]
    load, friction = _channels(recording, "wheel_load"), _channels(recording, "friction")
    force = _WHEELS * _channels(recording, "adhesion") * load
    slip = speed[:, None] - _channels(recording, "wheel_speed")
    time = recording[TIME]
    highest = partial(highest_creep_forces, condition, speed)
    mean_load = np.nanmean(load, axis=0) if np.isfinite(load).any(axis=0).all() else np.full(4, np.nan)
    return RailContact(
        _integrated(force * speed[:, None], time),
        _integrated(force * slip, time),
        _WHEELS * np.stack([highest(load[:, i], friction[:, i]) for i in range(len(WHEELSETS))], axis=1),
        _WHEELS * float(mean_load.sum()) / STANDARD_GRAVITY,
    )


def _channels(recording: Recording, kind: str) -> Array:
    """Return a channel of each wheelset, shape (n, 4)."""
    unknown = np.full(len(recording), np.nan)
    return np.stack([recording.channels.get(f"{kind}_{n}", unknown) for n in WHEELSETS], axis=1)


def _integrated(power: Array, time: Array) -> Array:
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(time)[:, None]
    return np.concatenate((np.zeros((1, power.shape[1])), np.cumsum(np.nan_to_num(steps), axis=0)))

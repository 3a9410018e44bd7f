"""The recorded stop and the simulated one over the same time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uictest.core.recording import TIME, Recording
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.recorded.field_data import RecordedStop, of_wheelsets
from uictest.rig import SimulatedStop

_COMPARED = ("speed", *of_wheelsets("wheel_speed"))


@dataclass(frozen=True, slots=True)
class Agreement:
    """How far the simulated stop follows the recorded one: time in s, distance in m, speed in m/s."""

    recorded_time: float
    simulated_time: float
    recorded_distance: float
    simulated_distance: float
    speed_difference: float

    def __str__(self) -> str:
        """Return the comparison for a reader."""
        speed = self.speed_difference / KILOMETRE_PER_HOUR
        return (
            f"recorded stop {self.recorded_time:.2f} s, {self.recorded_distance:.1f} m;"
            f" simulated {self.simulated_time:.2f} s, {self.simulated_distance:.1f} m;"
            f" train speeds differ by {speed:.2f} km/h (root mean square)"
        )


def overlay(recorded: RecordedStop, simulated: SimulatedStop) -> Recording:
    """Return train and wheel speeds of both stops on the raster of the record, m/s."""
    assert simulated.recording is not None
    time = np.asarray(recorded.recording[TIME])
    channels = {TIME: time}
    for name in _COMPARED:
        other = simulated.recording
        channels[f"{name}_recorded"] = np.asarray(recorded.recording[name])
        channels[f"{name}_simulated"] = np.interp(time, other[TIME], other[name], right=0.0)
    units = {name: "s" if name == TIME else "m/s" for name in channels}
    return Recording(channels, units)


def agreement(recorded: RecordedStop, simulated: SimulatedStop, both: Recording) -> Agreement:
    """Return how far the two stops agree."""
    difference = both["speed_recorded"] - both["speed_simulated"]
    time, distance = recorded.standstill or (float("nan"), float("nan"))
    return Agreement(
        time,
        float(simulated.measures.braking_time),
        distance,
        float(simulated.measures.braking_distance),
        float(np.sqrt(np.mean(difference**2))),
    )

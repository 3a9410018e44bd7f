"""A recording: the channels of one stop over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.frame import frame_of
from uictest.core.recording.plot import figure_of

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go

TIME = "time"
"""Name of the first channel, in seconds."""

BRAKE_COMMAND_TIME = "brake_command_time"
"""Metadata key of the time of the brake command, in the recording's time, e.g. `0 s`."""

ORIGIN = "origin"
"""Metadata key of what was recorded: a train, a test rig or a simulation."""


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """Channels of equal length over one time axis.

    Args:
        channels: name -> samples, one-dimensional, real and of equal length; `time` comes first, in seconds,
            finite and strictly increasing. A missing sample is NaN.
        units: name -> unit for every channel, "s" for time, "1" for a pure number.
        metadata: facts about the stop, as text.

    Raises:
        ValueError: the channels are not as described; the message names the channel.

    """

    channels: dict[str, NDArray[Any]]
    units: dict[str, str]
    metadata: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _check_shape(self.channels)
        _check_time(self.channels[TIME])
        _check_units(self.channels, self.units)

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.channels[TIME])

    def __getitem__(self, channel: str) -> NDArray[Any]:
        """Return the samples of a channel. Raises KeyError that names the existing channels."""
        try:
            return self.channels[channel]
        except KeyError:
            raise KeyError(
                f"no channel {channel!r} in this recording of {', '.join(self.channels)}"
            ) from None

    def frame(self) -> pd.DataFrame:
        """Return one column per channel, index `time` in s; `attrs["units"]` maps channels to units."""
        return frame_of(self.channels, self.units, self.metadata)

    def plot(self, channels: Sequence[str] | None = None) -> go.Figure:
        """Return a plotly figure, one panel for each unit, over the time in s.

        Args:
            channels: names, in which `*` stands for any characters [default: speeds, slides, cylinder
                pressures and clamping forces].

        Raises KeyError for a name that is no channel.
        """
        return figure_of(self.channels, self.units, channels)


def _check_shape(channels: dict[str, NDArray[Any]]) -> None:
    if next(iter(channels), None) != TIME:
        raise ValueError(
            f"the first channel of a recording must be {TIME!r}, found: {', '.join(channels) or 'none'}"
        )
    for name, samples in channels.items():
        if samples.ndim != 1:
            raise ValueError(f"channel {name!r} has {samples.ndim} dimensions; a channel has one")
        if samples.dtype.kind not in "biuf":
            raise ValueError(f"channel {name!r} holds {samples.dtype}; a channel holds real numbers")
        if len(samples) != len(channels[TIME]):
            raise ValueError(
                f"channel {name!r} has {len(samples)} samples, {TIME!r} has {len(channels[TIME])}"
            )


def _check_time(time: NDArray[Any]) -> None:
    if not np.all(np.isfinite(time)):
        raise ValueError(f"{TIME!r} is not finite at sample {int(np.argmin(np.isfinite(time)))}")
    rising = time[1:] > time[:-1]
    if not np.all(rising):
        sample = int(np.argmin(rising)) + 1
        raise ValueError(
            f"{TIME!r} does not increase at sample {sample}: {time[sample - 1]} s, then {time[sample]} s"
        )


def _check_units(channels: dict[str, NDArray[Any]], units: dict[str, str]) -> None:
    if missing := [name for name in channels if not units.get(name)]:
        raise ValueError(f'no unit for {", ".join(missing)}; write "1" for a pure number')
    if strangers := [name for name in units if name not in channels]:
        raise ValueError(f"units for missing channels: {', '.join(strangers)}")
    if units[TIME] != "s":
        raise ValueError(f'{TIME!r} must be in "s", found {units[TIME]!r}')

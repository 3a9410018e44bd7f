"""A recording: the channels of one stop over time, as a data frame and as a figure."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats import Cells, UnreadableError, required_module, seconds_of
from uictest.core.recording.plausibility import states_of

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go

    from uictest.core.recording.formats import Dialect


TIME = "time"
"""Name of the first channel, in seconds."""

BRAKE_COMMAND_TIME = "brake_command_time"
"""Metadata key of the time of the brake command, in the recording's time, e.g. `0 s`."""

SAMPLE_INTERVALS = "sample_intervals"
"""Metadata key of channels with a time of their own before they were cut out: JSON, name -> interval in s."""

TRACK_BRAKES_BESIDE = "track_brakes_beside"
"""Metadata key of the time for which track brakes of other cars of the train acted, e.g. `4.2 s`."""

ORIGIN = "origin"
"""Metadata key of what was recorded: a train, a test rig or a simulation."""


DEFAULT: Final = ("speed", "wheel_speed_*", "slide_*", "cylinder_pressure_*", "clamping_force_*")
"""What a figure shows unless other channels are named."""

_COLOURS: Final = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7")
"""Of the train, then of each wheelset: told apart by colour-blind eyes (Okabe and Ito, 2008)."""
_DASHES: Final = ("solid", "solid", "dash", "dot", "dashdot")
_PANEL: Final = 190
"""Height of a panel in pixels; chosen."""
_FRAME: Final = 110


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
        import pandas as pd

        time, *others = self.channels
        index = pd.Index(self.channels[time], name=time)
        frame = pd.DataFrame({name: self.channels[name] for name in others}, index=index)
        frame.attrs = {"units": dict(self.units), "metadata": dict(self.metadata)}
        return frame

    def plot(self, channels: Sequence[str] | None = None) -> go.Figure:
        """Return a plotly figure, one panel for each unit, over the time in s.

        Args:
            channels: names, in which `*` stands for any characters [default: speeds, slides, cylinder
                pressures and clamping forces].

        Raises KeyError for an unknown channel, MissingExtraError without the extra `plot`.
        """
        make_subplots = required_module("plotly.subplots", "plot").make_subplots

        time, *others = self.channels
        names = (
            self._shown_by_default(others) if channels is None else list(_channels_matching(others, channels))
        )
        panels = list(dict.fromkeys(self.units[name] for name in names))
        figure = make_subplots(rows=max(len(panels), 1), shared_xaxes=True, vertical_spacing=0.04)
        for name in names:
            line, row = _line_of(name), panels.index(self.units[name]) + 1
            figure.add_scatter(x=self[time], y=self[name], name=name, line=line, row=row, col=1, mode="lines")
        for row, unit in enumerate(panels, start=1):
            figure.update_yaxes(title_text=unit, row=row, col=1)
        figure.update_xaxes(title_text=f"{time}, {self.units[time]}", row=max(len(panels), 1), col=1)
        figure.update_layout(height=_FRAME + _PANEL * max(len(panels), 1), hovermode="x unified")
        return figure

    def _shown_by_default(self, names: Sequence[str]) -> list[str]:
        """Return the default channels that hold numbers; all channels where there is none."""
        default = [name for name in names if any(fnmatchcase(name, pattern) for pattern in DEFAULT)]
        return [name for name in default if np.isfinite(self[name]).any()] or list(names)


def _channels_matching(names: Sequence[str], patterns: Iterable[str]) -> Iterator[str]:
    """Yield the channels of patterns, each once. Raises KeyError."""
    seen: set[str] = set()
    for pattern in patterns:
        matching = [name for name in names if fnmatchcase(name, pattern)]
        if not matching:
            raise KeyError(f"no channel {pattern!r} in this recording of {', '.join(names)}")
        yield from (name for name in matching if name not in seen)
        seen.update(matching)


def _line_of(name: str) -> dict[str, str]:
    match = re.search(r"_([1-4])$", name)
    wheelset = int(match[1]) if match else 0
    return {"color": _COLOURS[wheelset], "dash": _DASHES[wheelset]}


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


_TRUTH: Final = {"True": 1, "TRUE": 1, "true": 1, "False": 0, "FALSE": 0, "false": 0}
"""Names that programs give to two states."""
Samples = NDArray[Any]
"""One-dimensional: 64-bit floats, or texts where a channel holds the names of states."""


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """Channels that were sampled together.

    Args:
        name: name of the group in the file; empty where the format has no groups.
        channels: name in the file -> samples, all equally long, in any order and of any value.
        units: name -> unit as the file writes it; channels without a unit are missing.
        time: the time axis in seconds, if the format has its own; else it is one of the channels.
        numbers: name of a channel of texts -> its samples that are numbers, NaN elsewhere; its texts are
            empty there.
        first_texts: name of a channel that holds texts among numbers -> text -> where it first stands.
        first_row: of the samples of this piece, counted from zero in the file.

    """

    name: str
    channels: dict[str, Samples]
    units: dict[str, str] = field(default_factory=dict)
    time: NDArray[Any] | None = None
    numbers: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    first_texts: dict[str, dict[str, str]] = field(default_factory=dict)
    first_row: int = 0

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(next(iter(self.channels.values()))) if self.channels else 0


@dataclass(frozen=True, slots=True, eq=False)
class Contents:
    """The groups of a file and its metadata, as text.

    `skipped` maps items that are not channels (texts, images, structures) to the reason why they are skipped;
    `dialect` is the one by which a text table was read, `guesses` says why a setting of it is a guess.
    """

    groups: tuple[Group, ...]
    metadata: dict[str, str] = field(default_factory=dict)
    skipped: dict[str, str] = field(default_factory=dict)
    dialect: Dialect | None = None
    guesses: dict[str, str] = field(default_factory=dict)


def recording_of(contents: Contents, metadata: Mapping[str, str]) -> Recording:
    """Return the contents of a file of one group with a time axis in seconds as a recording.

    `metadata` is added to that of the file, and names of states are their numbers. Raises UnreadableError for
    several time axes, no time, other texts, or channels without a unit.
    """
    if len(contents.groups) != 1:
        raise UnreadableError(f"{len(contents.groups)} rasters; a recording has one")
    group = contents.groups[0]
    channels = {name: _numeric_samples(group, name) for name in group.channels if name != TIME}
    try:
        return Recording(
            {TIME: _time_axis(group), **channels},
            {TIME: "s", **{name: group.units.get(name, "") for name in channels}},
            dict(chain(contents.metadata.items(), metadata.items())),
        )
    except ValueError as error:
        raise UnreadableError(f"not a recording: {error}") from error


def numbers_of(
    group: Group, name: str, states: Mapping[str, int], cells: Cells | None = None
) -> tuple[NDArray[Any], list[str]]:
    """Return the samples of a channel with texts as the numbers of `states`, and other texts, which are NaN.

    `cells` reads numbers that are texts in formats other than text.
    """
    texts, numbers = np.asarray(group.channels[name]), group.numbers.get(name)
    if texts.dtype.kind == "U" and numbers is None:
        column = (cells or Cells()).column(texts)
        texts, numbers = column.samples, column.numbers
    if texts.dtype.kind != "U" or numbers is None:
        return texts, []
    states = {**_TRUTH, **states} if states else states
    distinct, indices = np.unique(texts, return_inverse=True)
    of_states = np.array([states.get(text, np.nan) for text in distinct.tolist()], dtype=np.float64)
    strange = {text for text in distinct.tolist() if text and text not in states}
    in_order = [text for text in group.first_texts.get(name, {}) if text in strange]
    return np.where(np.isnan(numbers), of_states[indices], numbers), in_order or sorted(strange)


def _numeric_samples(group: Group, name: str) -> NDArray[Any]:
    """Return the samples of a channel, states as their numbers. Raises UnreadableError for other texts."""
    samples, strange = numbers_of(group, name, states_of(name))
    if strange:
        location = group.first_texts.get(name, {}).get(strange[0], "")
        accepted = ", ".join(("numbers", *states_of(name)))
        where = f", the first in {location}" if location else ""
        raise UnreadableError(f"channel {name!r} contains texts{where}: {strange[0]!r}; accepted: {accepted}")
    return samples


def _time_axis(group: Group) -> np.ndarray:
    if group.time is not None:
        return group.time
    samples = group.channels.get(TIME, np.zeros(0))
    if samples.dtype.kind == "U":
        dates = seconds_of(samples, "")
        return dates - dates[:1]
    if group.units.get(TIME) != "s":
        raise UnreadableError(f"no channel {TIME!r} in seconds")
    return samples

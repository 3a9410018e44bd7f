"""TDMS files (National Instruments), by npTDMS."""

from __future__ import annotations

import io
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uictest.core import files
from uictest.core.recording.formats.file_formats import check_size, required_module
from uictest.core.recording.formats.pieces import in_step, is_wanted
from uictest.core.recording.plausibility import states_of
from uictest.core.recording.recording import TIME, Contents, Group, Recording, Samples

_EXTRA = "tdms"
AT_ONCE = 2**17
"""Rows of a group that are read at once; chosen."""
_GROUP = "stop"
_NO_DATE = np.datetime64("1971-01-01", "us")
"""Up to it a start is none: LabVIEW writes 1904-01-01 for an unknown one."""
_EVEN = 1e-9
"""Share of the sampling interval by which evenly spaced samples may miss it."""


class TimeAxis(NamedTuple):
    """Number of samples, their interval (s; zero: not stated) and the time of the first (s)."""

    length: int
    interval_s: float
    start_s: float


def read(path: Path) -> Contents:
    """Read every channel of numbers or time stamps; channels of one group and time axis belong together.

    Raises MissingExtraError without npTDMS; for a damaged file whatever npTDMS raises.
    """
    nptdms = required_module("nptdms", _EXTRA)
    with nptdms.TdmsFile.open(path) as tdms:
        check_size((len(channel),) for group in tdms.groups() for channel in group.channels())
        skipped: dict[str, str] = {}
        begun = _first_waveform_start(tdms)
        groups = tuple(
            block
            for group in tdms.groups()
            for axis, channels in _channels_by_time_axis(group, begun).items()
            for block in _blocks(group.name, axis, channels, max(axis.length, 1), skipped)
        )
        facts = {str(key): str(value) for key, value in tdms.properties.items()}
        return Contents(groups, facts, skipped)


def pieces(
    path: Path, wanted: Collection[str] | None, leading: Collection[str], at_once: int
) -> Iterator[Contents]:
    """Yield the file as :func:`in_step`; see `read_pieces`. `at_once`: rows of a group."""
    nptdms = required_module("nptdms", _EXTRA)
    unix = np.datetime64(0, "us")
    with files.temporary_folder() as folder, nptdms.TdmsFile.open(path) as tdms:
        is_cut, begun = tdms.file_status.incomplete_final_segment, _first_waveform_start(tdms)
        streams = [
            _blocks(
                group.name, axis, [_with_short_chunks(c, folder, at_once) for c in chosen], at_once, {}, unix
            )
            for group in tdms.groups()
            for axis, channels in _channels_by_time_axis(group, begun, is_cut=is_cut).items()
            if (chosen := [c for c in channels if is_wanted(c.name, group.name, wanted)])
        ]
        yield from in_step(streams, leading)


def encoded(recording: Recording) -> bytes:
    """Return a recording: one group with waveform properties where it is evenly sampled, facts at the root.

    Raises MissingExtraError without npTDMS.
    """
    nptdms = required_module("nptdms", _EXTRA)
    waveform = _waveform_properties(recording)
    objects = [nptdms.RootObject(properties=dict(recording.metadata)), nptdms.GroupObject(_GROUP)]
    for name, samples in recording.channels.items():
        listed = ", ".join(f"{number} = {state}" for state, number in states_of(name).items())
        states = {"states": listed} if listed else {}
        properties = {"unit_string": recording.units[name], **states, **waveform}
        objects.append(nptdms.ChannelObject(_GROUP, name, np.asarray(samples), properties=properties))
    content = io.BytesIO()
    with nptdms.TdmsWriter(content) as writer:
        writer.write_segment(objects)
    return content.getvalue()


def _waveform_properties(recording: Recording) -> dict[str, object]:
    time = recording[TIME]
    if len(time) < 2:
        return {}
    interval = (time[-1] - time[0]) / (len(time) - 1)
    even = time[0] + interval * np.arange(len(time))
    if np.max(np.abs(time - even)) > _EVEN * interval:
        return {}
    return {"wf_start_offset": float(time[0]), "wf_increment": float(interval), "wf_samples": len(time)}


def _blocks(
    group: str,
    axis: TimeAxis,
    channels: Sequence[Any],
    at_once: int,
    skipped: dict[str, str],
    origin: np.datetime64 | None = None,
) -> Iterator[Group]:
    """Yield channels of one time axis in blocks of `at_once` rows.

    Time stamps count from `origin`, else from the first. `skipped` is an output: the reason for each channel
    without numbers.
    """
    length, interval, start = axis
    for first in range(0, length, at_once):
        last = min(first + at_once, length)
        time = start + interval * np.arange(first, last) if interval > 0.0 else None
        block = Group(group, {}, time=time, first_row=first)
        for channel in channels:
            samples = _samples_as_floats(channel[first:last], origin)
            if samples is None:
                skipped[f"{group}/{channel.name}"] = "holds no numbers"
                continue
            block.channels[channel.name] = samples
            if unit := channel.properties.get("unit_string"):
                block.units[channel.name] = str(unit)
        if block.channels:
            yield block


def _first_waveform_start(tdms: Any) -> Any:
    """Return the start of the first waveform of a file; None where a channel does not state its own."""
    channels = [channel for group in tdms.groups() for channel in group.channels()]
    stamps = [channel.properties.get("wf_start_time") for channel in channels]
    known = [stamp for stamp in stamps if stamp is not None and np.datetime64(stamp) > _NO_DATE]
    return min(known) if known and len(known) == len(stamps) else None


def _channels_by_time_axis(
    group: Any, begun: Any = None, *, is_cut: bool = False
) -> dict[TimeAxis, list[Any]]:
    """Return the channels of a group by their time axis.

    A start counts from the time at which the file has `begun`, where it states one. In a file that `is_cut`
    off, channels of one interval and start are taken as long as the shortest.
    """
    by_axis: dict[TimeAxis, list[Any]] = {}
    for channel in group.channels():
        interval = float(channel.properties.get("wf_increment", 0.0))
        start = float(channel.properties.get("wf_start_offset", 0.0))
        if begun is not None:
            start += float((channel.properties["wf_start_time"] - begun) / np.timedelta64(1, "us")) * 1e-6
        by_axis.setdefault(TimeAxis(0 if is_cut else len(channel), interval, start), []).append(channel)
    if is_cut:
        return {axis._replace(length=min(map(len, channels))): channels for axis, channels in by_axis.items()}
    return by_axis


def _samples_as_floats(data: Any, origin: np.datetime64 | None) -> Samples | None:
    """Return data of a channel as floats, stamps in s after `origin` or the first; None where it has none."""
    samples = np.asarray(data)
    if samples.dtype.kind == "M":
        since = samples - (samples[:1] if origin is None else origin)
        return np.asarray(since / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)
    if samples.ndim != 1 or samples.dtype.kind not in "biuf":
        return None
    return samples.astype(np.float64)


class _StoredChannel:
    """A channel of numbers copied to a file, whose rows are read from there."""

    def __init__(self, channel: Any, path: Path) -> None:
        self.name, self.properties, self.dtype = channel.name, channel.properties, channel.dtype
        self._path = path
        with path.open("wb") as file:
            for chunk in channel.data_chunks():
                np.asarray(chunk[:], dtype=self.dtype).tofile(file)

    def __getitem__(self, rows: slice) -> Any:
        count, offset = rows.stop - rows.start, rows.start * self.dtype.itemsize
        return np.fromfile(self._path, self.dtype, count, offset=offset)


def _with_short_chunks(channel: Any, folder: Path, rows: int) -> Any:
    """Return a channel, or a copy where its chunks are long: npTDMS reads all of one for each of its rows."""
    longest = len(next(channel.data_chunks(), ()))
    if longest <= rows or channel.dtype.kind not in "biufM":
        return channel
    return _StoredChannel(channel, folder / f"{len(list(folder.iterdir()))}.raw")

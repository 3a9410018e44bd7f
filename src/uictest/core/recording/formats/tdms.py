"""TDMS files (National Instruments), by npTDMS."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.recording.formats.file_formats import check_size, required_module
from uictest.core.recording.plausibility import states_of
from uictest.core.recording.recording import TIME, Contents, Group, Recording, Samples

EXTRA = "tdms"
_GROUP = "stop"
_NO_DATE = np.datetime64("1971-01-01", "us")
"""Up to it a start is none: LabVIEW writes 1904-01-01 for an unknown one."""
_EVEN = 1e-9
"""Share of the sampling interval by which samples of an even raster may miss it."""


def read(path: Path) -> Contents:
    """Read every channel of numbers or time stamps; channels of one group and raster belong together.

    Raises MissingExtraError without npTDMS; for a damaged file whatever npTDMS raises.
    """
    nptdms = required_module("nptdms", EXTRA)
    with nptdms.TdmsFile.open(path) as tdms:
        channels = [channel for group in tdms.groups() for channel in group.channels()]
        check_size((len(channel),) for channel in channels)
        skipped: dict[str, str] = {}
        begun = begin_of(tdms)
        groups = tuple(each for group in tdms.groups() for each in _groups(group, begun, skipped))
        facts = {str(key): str(value) for key, value in tdms.properties.items()}
        return Contents(groups, facts, skipped)


def encoded(recording: Recording) -> bytes:
    """Return a recording: one group with waveform properties where its raster is even, facts at the root.

    Raises MissingExtraError without npTDMS.
    """
    nptdms = required_module("nptdms", EXTRA)
    raster = _waveform(recording)
    objects = [nptdms.RootObject(properties=dict(recording.metadata)), nptdms.GroupObject(_GROUP)]
    for name, samples in recording.channels.items():
        properties = {"unit_string": recording.units[name], **_names_of_states(name), **raster}
        objects.append(nptdms.ChannelObject(_GROUP, name, np.asarray(samples), properties=properties))
    content = io.BytesIO()
    with nptdms.TdmsWriter(content) as writer:
        writer.write_segment(objects)
    return content.getvalue()


def _waveform(recording: Recording) -> dict[str, object]:
    time = recording[TIME]
    if len(time) < 2:
        return {}
    interval = (time[-1] - time[0]) / (len(time) - 1)
    even = time[0] + interval * np.arange(len(time))
    if np.max(np.abs(time - even)) > _EVEN * interval:
        return {}
    return {"wf_start_offset": float(time[0]), "wf_increment": float(interval), "wf_samples": len(time)}


def _names_of_states(name: str) -> dict[str, object]:
    listed = ", ".join(f"{number} = {state}" for state, number in states_of(name).items())
    return {"states": listed} if listed else {}


def _groups(group: Any, begun: Any, skipped: dict[str, str]) -> Iterator[Group]:
    for (length, interval, start), channels in rasters_of(group, begun).items():
        read = {channel.name: numbers(channel[:]) for channel in channels}
        kept = {name: samples for name, samples in read.items() if samples is not None}
        skipped |= {f"{group.name}/{name}": "holds no numbers" for name in read if name not in kept}
        units = {c.name: str(u) for c in channels if (u := c.properties.get("unit_string"))}
        time = start + interval * np.arange(length) if interval > 0.0 else None
        if kept and length:
            yield Group(group.name, kept, {n: u for n, u in units.items() if n in kept}, time)


def begin_of(tdms: Any) -> Any:
    """Return when the first waveform of a file begins; None where not all of its channels say so."""
    stamps = [each.properties.get("wf_start_time") for group in tdms.groups() for each in group.channels()]
    known = [each for each in stamps if each is not None and np.datetime64(each) > _NO_DATE]
    return min(known) if known and len(known) == len(stamps) else None


def rasters_of(
    group: Any, begun: Any = None, *, is_cut: bool = False
) -> dict[tuple[int, float, float], list[Any]]:
    """Return the channels of a group by length, interval and start, s; interval zero: not stated.

    A start counts from when the file has `begun`, where it says when its waveforms begin.
    Of a file that `is_cut` off, channels of one raster count as long as the shortest.
    """
    rasters: dict[tuple[int, float, float], list[Any]] = {}
    for channel in group.channels():
        interval = float(channel.properties.get("wf_increment", 0.0))
        start = float(channel.properties.get("wf_start_offset", 0.0))
        if begun is not None:
            start += float((channel.properties["wf_start_time"] - begun) / np.timedelta64(1, "us")) * 1e-6
        rasters.setdefault((0 if is_cut else len(channel), interval, start), []).append(channel)
    if is_cut:
        return {(min(map(len, each)), *key[1:]): each for key, each in rasters.items()}
    return rasters


def numbers(data: Any, origin: Any = None) -> Samples | None:
    """Return data of a channel as floats, stamps in s after `origin` or the first; None where it has none."""
    samples = np.asarray(data)
    if samples.dtype.kind == "M":
        since = samples - (samples[:1] if origin is None else origin)
        return np.asarray(since / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)
    if samples.ndim != 1 or samples.dtype.kind not in "biuf":
        return None
    return samples.astype(np.float64)

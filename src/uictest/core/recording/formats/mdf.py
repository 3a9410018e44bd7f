"""MDF files (ASAM MDF 4, and older ones for reading), by asammdf."""

from __future__ import annotations

import io
import re
import tempfile
from collections.abc import Iterator
from datetime import UTC, datetime
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.recording.formats.file_formats import check_size, distinct, required_module
from uictest.core.recording.plausibility import states_of
from uictest.core.recording.recording import TIME, Contents, Group, Recording, Samples

VERSION = "4.10"
EXTRA = "mdf"
_FRAMES = re.compile("(CAN|LIN|FLX|ETH|MOST)_[A-Za-z]*Frame")  # as ASAM names the channels of bus logging
RAW_FRAMES = (
    "holds raw frames of a bus: decode them with their DBC and save the signals, in asammdf (Bus logging) or"
    " by mdf.extract_bus_logging({'CAN': [('bus.dbc', 0)]}).save('signals.mf4')"
)
_COMMENT_TEXT = re.compile(r"<TX[^>]*>(.*?)</TX>", re.DOTALL)
# A simulated stop has no date; one that is always the same keeps files of the same stop alike.
_NO_DATE = datetime(1970, 1, 1, tzinfo=UTC)


def read(path: Path) -> Contents:
    """Read every channel of numbers or of the names of states.

    Raises MissingExtraError without asammdf; for a damaged file whatever asammdf raises.
    """
    asammdf = required_module("asammdf", EXTRA)
    with asammdf.MDF(path, temporary_folder=Path(tempfile.gettempdir())) as mdf:
        counts = [(len(group.channels), int(group.channel_group.cycles_nr)) for group in mdf.groups]
        check_size(shape for channels, cycles in counts for shape in [(cycles,)] * channels)
        skipped: dict[str, str] = {}
        groups = tuple(group for k in range(len(mdf.groups)) for group in _group(mdf, k, skipped))
        return Contents(groups, _facts(mdf), skipped)


def encoded(recording: Recording) -> bytes:
    """Return a recording as MDF 4.10: one group for its one raster, names of states, facts in the header.

    Raises MissingExtraError without asammdf.
    """
    asammdf = required_module("asammdf", EXTRA)
    time = np.asarray(recording[TIME], dtype=np.float64)
    signals = [
        asammdf.Signal(
            samples=np.asarray(samples),
            timestamps=time,
            name=name,
            unit=recording.units[name],
            conversion=_names_of_states(name, np.asarray(samples)),
        )
        for name, samples in recording.channels.items()
        if name != TIME
    ]
    content = io.BytesIO()
    with asammdf.MDF(version=VERSION) as mdf:
        mdf.header.comment = "\n".join(f"{key}: {value}" for key, value in recording.metadata.items())
        mdf.header.start_time = _NO_DATE
        mdf.append(signals, acq_name="stop", comment="uictest", common_timebase=True)
        mdf.save(content, overwrite=True)
    return content.getvalue()


def _group(mdf: Any, number: int, skipped: dict[str, str]) -> Iterator[Group]:
    if frames := raw_frames(mdf.groups[number]):
        skipped[frames] = RAW_FRAMES
        return
    master = mdf.masters_db.get(number)
    channels: dict[str, Samples] = {}
    units: dict[str, str] = {}
    time = None
    for index, channel in enumerate(mdf.groups[number].channels):
        if index == master:
            continue
        signal = mdf.get(group=number, index=index, ignore_invalidation_bits=True)
        name = distinct(str(channel.name), channels)
        if not holds_samples(signal):
            skipped[name] = f"holds {signal.samples.dtype} of {signal.samples.ndim} dimensions"
            continue
        channels[name] = valid_samples(signal)
        time = signal.timestamps if master is not None else None
        if signal.unit:
            units[name] = str(signal.unit)
    if channels:
        yield Group(group_name(mdf.groups[number]), channels, units, time)


def raw_frames(group: Any) -> str:
    """Return the name of the frames where a group is a log of a bus, else nothing."""
    return next((str(each.name) for each in group.channels if _FRAMES.fullmatch(str(each.name))), "")


def group_name(group: Any) -> str:
    """Return the name of a group; version 3 has none."""
    return str(getattr(group.channel_group, "acq_name", "") or "")


def holds_samples(signal: Any) -> bool:
    """Return whether a signal of asammdf holds numbers or texts, one a record."""
    return signal.samples.ndim == 1 and signal.samples.dtype.kind in "biufS"


def valid_samples(signal: Any) -> Samples:
    """Return the samples as floats, those marked invalid as NaN, or as texts."""
    if signal.samples.dtype.kind == "S":
        return np.char.decode(signal.samples, "utf-8", "replace")
    samples = np.array(signal.samples, dtype=np.float64)
    if signal.invalidation_bits is not None:
        samples[np.asarray(signal.invalidation_bits, dtype=bool)] = np.nan
    return samples


def _names_of_states(name: str, samples: Samples) -> dict[str, object] | None:
    """Return what names the states of a channel; None where a sample has no name, which would be lost."""
    states = states_of(name)
    if not states or not np.isin(samples[~np.isnan(samples)], list(states.values())).all():
        return None
    pairs = enumerate(states.items())
    return {
        key: value
        for k, (state, number) in pairs
        for key, value in ((f"val_{k}", float(number)), (f"text_{k}", state))
    }


def _facts(mdf: Any) -> dict[str, str]:
    comment = str(mdf.header.comment or "")
    text = _COMMENT_TEXT.search(comment)
    lines = (line.partition(":") for line in (unescape(text[1]) if text else comment).splitlines())
    return {key.strip(): value.strip() for key, colon, value in lines if colon and key.strip()}

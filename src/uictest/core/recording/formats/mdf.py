"""MDF files (ASAM MDF 4, and older ones for reading), by asammdf."""

from __future__ import annotations

import contextlib
import io
import re
import tempfile
from collections.abc import Collection, Iterator
from dataclasses import replace
from datetime import UTC, datetime
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.recording.formats.file_formats import (
    UnreadableError,
    check_size,
    distinct,
    facts_in,
    required_module,
)
from uictest.core.recording.formats.pieces import in_step, is_wanted
from uictest.core.recording.plausibility import states_of
from uictest.core.recording.recording import TIME, Contents, Group, Recording, Samples

VERSION = "4.10"
_EXTRA = "mdf"
_FRAMES = re.compile("(CAN|LIN|FLX|ETH|MOST)_[A-Za-z]*Frame")  # as ASAM names the channels of bus logging
_RAW_FRAMES = (
    "holds raw frames of a bus: decode them with their DBC and save the signals, in asammdf (Bus logging) or"
    " by mdf.extract_bus_logging({'CAN': [('bus.dbc', 0)]}).save('signals.mf4')"
)
_COMMENT_TEXT = re.compile(r"<TX[^>]*>(.*?)</TX>", re.DOTALL)
AT_ONCE = 16 * 2**20
"""Bytes of the records of a group that are read at once; chosen."""
_ALL = 2**40
"""The same where all of a file is read."""
_UNFINISHED = b"UnFinMF "
"""Beginning of a file whose writer did not finish it: asammdf completes a copy of it."""
# A simulated stop has no date; one that is always the same keeps files of the same stop alike.
_NO_DATE = datetime(1970, 1, 1, tzinfo=UTC)


def read(path: Path) -> Contents:
    """Read every channel of numbers or of the names of states.

    Raises MissingExtraError without asammdf; for a damaged file whatever asammdf raises.
    """
    with _open_mdf(path, _ALL) as mdf:
        counts = [(len(group.channels), int(group.channel_group.cycles_nr)) for group in mdf.groups]
        check_size(shape for channels, cycles in counts for shape in [(cycles,)] * channels)
        skipped: dict[str, str] = {}
        groups = tuple(group for k in range(len(mdf.groups)) for group in _blocks(mdf, k, None, skipped))
        return Contents(groups, _facts_of_header(mdf), skipped)


def pieces(
    path: Path, wanted: Collection[str] | None, leading: Collection[str], at_once: int
) -> Iterator[Contents]:
    """Yield the file as :func:`in_step`; see `read_pieces`. `at_once`: bytes of the records of a group."""
    with _open_mdf(path, at_once) as mdf:
        measured = [k for k, group in enumerate(mdf.groups) if not _name_of_raw_frames(group)]
        if mdf.groups and not measured:
            raise UnreadableError(_RAW_FRAMES)
        yield from in_step([_blocks(mdf, k, wanted, {}) for k in measured], leading)


@contextlib.contextmanager
def _open_mdf(path: Path, at_once: int) -> Iterator[Any]:
    """Lend an open file. asammdf maps one that it opens by its path, and all of it stays mapped."""
    asammdf = required_module("asammdf", _EXTRA)
    with path.open("rb") as file:
        source = path if file.read(8) == _UNFINISHED else file
        with asammdf.MDF(source, temporary_folder=Path(tempfile.gettempdir())) as mdf:
            mdf.configure(read_fragment_size=at_once)
            yield mdf


def _blocks(
    mdf: Any, number: int, wanted: Collection[str] | None, skipped: dict[str, str]
) -> Iterator[Group]:
    """Yield the wanted channels of a group in blocks. `skipped` is an output: channel -> reason.

    Every record is read and decompressed once. asammdf's public `iter_get` reads all of a group for each of
    its channels, 7 times as slow for six channels; `select` reads from the beginning for each block.
    """
    group, master = mdf.groups[number], mdf.masters_db.get(number)
    if frames := _name_of_raw_frames(group):
        skipped[frames] = _RAW_FRAMES
        return
    name = str(getattr(group.channel_group, "acq_name", "") or "")  # version 3 has none
    indices: dict[str, int] = {}
    for index, channel in enumerate(group.channels):
        if index != master:
            indices[distinct(str(channel.name), indices)] = index
    indices = {channel: index for channel, index in indices.items() if is_wanted(channel, name, wanted)}
    if not indices or not group.channel_group.cycles_nr:
        return
    first_row = 0
    for fragment in mdf._mdf._load_data(group):
        block = Group(name, {}, first_row=first_row)
        for channel, index in indices.items():
            signal = mdf.get(group=number, index=index, data=fragment, ignore_invalidation_bits=True)
            if signal.samples.ndim != 1 or signal.samples.dtype.kind not in "biufS":
                skipped[channel] = f"holds {signal.samples.dtype} of {signal.samples.ndim} dimensions"
                continue
            block.channels[channel] = _valid_samples(signal)
            if signal.unit:
                block.units[channel] = str(signal.unit)
        if block.channels and master is not None:
            time = np.array(mdf.get_master(number, data=fragment, one_piece=True), dtype=np.float64)
            block = replace(block, time=time)
        if block.channels:
            first_row += len(block)
            yield block


def _name_of_raw_frames(group: Any) -> str:
    """Return the name of the frames if a group is a log of a bus, else an empty text."""
    names = (str(channel.name) for channel in group.channels)
    return next((name for name in names if _FRAMES.fullmatch(name)), "")


def encoded(recording: Recording) -> bytes:
    """Return a recording as MDF 4.10: one group, with names of states, and facts in the header.

    Raises MissingExtraError without asammdf.
    """
    asammdf = required_module("asammdf", _EXTRA)
    time = np.asarray(recording[TIME], dtype=np.float64)
    signals = [
        asammdf.Signal(
            samples=np.asarray(samples),
            timestamps=time,
            name=name,
            unit=recording.units[name],
            conversion=_state_conversion(name, np.asarray(samples)),
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


def _valid_samples(signal: Any) -> Samples:
    """Return the samples as floats, those marked invalid as NaN, or as texts."""
    if signal.samples.dtype.kind == "S":
        return np.char.decode(signal.samples, "utf-8", "replace")
    samples = np.array(signal.samples, dtype=np.float64)
    if signal.invalidation_bits is not None:
        samples[np.asarray(signal.invalidation_bits, dtype=bool)] = np.nan
    return samples


def _state_conversion(name: str, samples: Samples) -> dict[str, object] | None:
    """Return the conversion of numbers to names of states; None where a sample has no name."""
    states = states_of(name)
    if not states or not np.isin(samples[~np.isnan(samples)], list(states.values())).all():
        return None
    pairs = enumerate(states.items())
    return {
        key: value
        for k, (state, number) in pairs
        for key, value in ((f"val_{k}", float(number)), (f"text_{k}", state))
    }


def _facts_of_header(mdf: Any) -> dict[str, str]:
    comment = str(mdf.header.comment or "")
    text = _COMMENT_TEXT.search(comment)
    return facts_in((unescape(text[1]) if text else comment).splitlines())

"""MDF and TDMS files block by block; groups with time bases of their own go in step."""

from __future__ import annotations

import contextlib
import itertools
import math
import tempfile
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from operator import itemgetter
from pathlib import Path
from typing import Any, Final

import numpy as np

from uictest.core import files
from uictest.core.recording.formats import mdf, tdms
from uictest.core.recording.formats.file_formats import UnreadableError, distinct, required_module
from uictest.core.recording.recording import Contents, Group

AT_ONCE: Final = {"mdf": 16 * 2**20, "tdms": 2**17}
"""What is read of a group at once: bytes of the records of an MDF group, rows of a TDMS group; chosen."""
_OVERLAP: Final = 3
"""Samples before and after a piece that the groups beside the leading one have, to interpolate; chosen."""
_UNFINISHED: Final = b"UnFinMF "
"""Beginning of an MDF file whose writer did not finish it: asammdf completes a copy of it."""
Blocks = Iterator[Group]


def mdf_pieces(
    path: Path, wanted: Collection[str] | None, leading: Collection[str], at_once: int
) -> Iterator[Contents]:
    """Yield an MDF file as :func:`in_step`; see `read_pieces`.

    asammdf maps what it opens by its path, and all of the file stays mapped: it gets an open file.
    """
    asammdf = required_module("asammdf", mdf.EXTRA)
    with contextlib.ExitStack() as stack:
        file: Any = stack.enter_context(path.open("rb"))
        if file.read(8) == _UNFINISHED:
            file = path
        opened = stack.enter_context(asammdf.MDF(file, temporary_folder=Path(tempfile.gettempdir())))
        opened.configure(read_fragment_size=at_once)
        measured = [k for k, group in enumerate(opened.groups) if not mdf.raw_frames(group)]
        if opened.groups and not measured:
            raise UnreadableError(mdf.RAW_FRAMES)
        streams = [_mdf_blocks(opened, k, wanted) for k in measured]
        yield from in_step(streams, leading)


def _mdf_blocks(opened: Any, number: int, wanted: Collection[str] | None) -> Blocks:
    """Yield the wanted channels of a group block by block.

    Every record is read and decompressed once: what asammdf's own functions read by offset and count, they
    read from the beginning of the file each time.
    """
    inner, group = opened._mdf, opened.groups[number]
    master, name = inner.masters_db.get(number), mdf.group_name(group)
    named: dict[str, int] = {}
    for index, channel in enumerate(group.channels):
        if index != master:
            named[distinct(str(channel.name), named)] = index
    chosen = [(index, text) for text, index in named.items() if _is_wanted(text, name, wanted)]
    if not chosen or not group.channel_group.cycles_nr:
        return
    first_row = 0
    for fragment in inner._load_data(group):
        read = {
            text: inner.get(group=number, index=index, data=fragment, ignore_invalidation_bits=True)
            for index, text in chosen
        }
        kept = {text: signal for text, signal in read.items() if mdf.holds_samples(signal)}
        channels = {text: mdf.valid_samples(signal) for text, signal in kept.items()}
        units = {text: str(signal.unit) for text, signal in kept.items() if signal.unit}
        time = None
        if master is not None:
            time = np.array(inner.get_master(number, data=fragment, one_piece=True), dtype=np.float64)
        if channels:
            block = Group(name, channels, units, time, first_row=first_row)
            first_row += len(block)
            yield block


def tdms_pieces(
    path: Path, wanted: Collection[str] | None, leading: Collection[str], at_once: int
) -> Iterator[Contents]:
    """Yield a TDMS file as :func:`in_step`; see `read_pieces`."""
    nptdms = required_module("nptdms", tdms.EXTRA)
    with files.temporary_folder() as folder, nptdms.TdmsFile.open(path) as opened:
        is_cut, begun = opened.file_status.incomplete_final_segment, tdms.begin_of(opened)
        streams = [
            _tdms_blocks(
                group.name, raster, [_short_chunks(each, folder, at_once) for each in chosen], at_once
            )
            for group in opened.groups()
            for raster, channels in tdms.rasters_of(group, begun, is_cut=is_cut).items()
            if (chosen := [each for each in channels if _is_wanted(each.name, group.name, wanted)])
        ]
        yield from in_step(streams, leading)


def _tdms_blocks(
    name: str, raster: tuple[int, float, float], channels: Sequence[Any], at_once: int
) -> Blocks:
    length, interval, start = raster
    units = {each.name: str(unit) for each in channels if (unit := each.properties.get("unit_string"))}
    for first in range(0, length, at_once):
        last = min(first + at_once, length)
        rows = np.arange(first, last)
        read = {each.name: tdms.numbers(each[first:last], np.datetime64(0, "us")) for each in channels}
        kept = {each: samples for each, samples in read.items() if samples is not None}
        if kept:
            time = start + interval * rows if interval > 0.0 else None
            stated = {each: unit for each, unit in units.items() if each in kept}
            yield Group(name, kept, stated, time, first_row=first)


PIECES: Final = {"mdf": mdf_pieces, "tdms": tdms_pieces}
"""What reads the pieces of each format."""


class _Stored:
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


def _short_chunks(channel: Any, folder: Path, rows: int) -> Any:
    """Return a channel, or a copy where its chunks are long: npTDMS reads all of one for each of its rows."""
    longest = len(next(channel.data_chunks(), ()))
    if longest <= rows or channel.dtype.kind not in "biufM":
        return channel
    return _Stored(channel, folder / f"{len(list(folder.iterdir()))}.raw")


def _is_wanted(channel: str, group: str, wanted: Collection[str] | None) -> bool:
    return wanted is None or channel in wanted or f"{group}/{channel}" in wanted


def in_step(streams: Sequence[Blocks], leading: Collection[str]) -> Iterator[Contents]:
    """Yield the blocks of the group with a channel of `leading`, and what the other groups have meanwhile.

    The others begin and end some samples before and after the block where they have them. A block that lasts
    longer than one of theirs is divided: beside a slow group a fast one would be held for hours.

    Raises UnreadableError where several groups have no times, or times that go back.
    """
    begun = [(first, stream) for stream in streams if (first := next(stream, None)) is not None]
    begun.sort(key=lambda each: not any(_is_wanted(name, each[0].name, leading) for name in each[0].channels))
    if not begun:
        return
    (first, stream), *others = begun
    beside = [_Follower(*other) for other in others]
    span = min((each.lasts for each in beside), default=math.inf)
    for block in itertools.chain((first,), stream):
        for part in _parts(block, span):
            yield Contents((part, *(each.beside(part) for each in beside)))


def _parts(block: Group, span: float) -> Iterator[Group]:
    """Yield the rows of a block that lie within `span` (s) of each other."""
    if math.isinf(span):
        yield block
        return
    times = _rising(block)
    begins = np.flatnonzero(np.diff((times - times[0]) // span)) + 1
    for rows in itertools.pairwise((0, *begins.tolist(), len(times))):
        part = _changed(block, itemgetter(slice(*rows)))
        yield replace(part, first_row=block.first_row + rows[0])


class _Follower:
    """A group of which the part beside each block of the leading group is taken, one after the other."""

    def __init__(self, first: Group, following: Blocks) -> None:
        second = next(following, None)
        self._held, self._following = first, itertools.chain(() if second is None else (second,), following)
        times = _rising(first)
        duration = float(times[-1] - times[0])
        self.lasts = math.inf if second is None or not duration > 0.0 else duration
        """How long a block is, s; infinite where there is only one."""

    def beside(self, part: Group) -> Group:
        """Return the samples beside a part of the leading group, and a few around; parts come in order."""
        begin, end = _rising(part)[[0, -1]]
        while _rising(self._held)[-1] <= end and (block := next(self._following, None)) is not None:
            self._held = _joined(self._held, block)
        times = _rising(self._held)
        first = max(int(np.searchsorted(times, begin)) - _OVERLAP, 0)
        last = int(np.searchsorted(times, end, side="right")) + _OVERLAP
        self._held = _changed(self._held, lambda samples: samples[first:])
        return _changed(self._held, lambda samples: samples[: last - first])


def _changed(group: Group, change: Callable[[Any], Any]) -> Group:
    channels = {name: change(samples) for name, samples in group.channels.items()}
    return replace(group, channels=channels, time=change(group.time))


def _joined(one: Group, other: Group) -> Group:
    channels = {
        name: np.concatenate((one.channels[name], other.channels[name]))
        for name in one.channels
        if name in other.channels
    }
    time = np.concatenate((_rising(one), _rising(other)))
    return replace(one, channels=channels, time=time)


def _rising(group: Group) -> Any:
    """Return the times of a group beside others. Raises UnreadableError where they do not rise."""
    if group.time is None:
        raise UnreadableError(
            f"group {group.name!r} has no times of its own beside other groups: such a file is not read in"
            " pieces; write all channels over one time"
        )
    if not bool(np.all(np.diff(group.time) >= 0.0)):
        raise UnreadableError(
            f"the times of group {group.name!r} go back, so that other groups cannot be laid beside it; write"
            " all channels over one time"
        )
    return group.time

"""Long files, read in pieces: one is given after the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uictest.core.recording.formats import csv_text, isolation, parquet
from uictest.core.recording.formats.cells import MOST_LOCATED
from uictest.core.recording.formats.file_formats import UnreadableError, format_of, module_of
from uictest.core.recording.formats.layout import COMMENT, Dialect, cells_of, encoding_advice
from uictest.core.recording.recording import Contents, Group

_BLOCK = 2 * 2**20
"""Bytes of text that are parsed at once, of which Arrow reads up to 32 blocks ahead; chosen."""
_ROWS = 2**17
"""Rows of a Parquet file that are decoded at once; chosen."""
_OVERLAP = 3
"""Samples before and after a piece that the groups beside the leading one have, to interpolate; chosen."""
_LONGEST = 200
"""Characters of a message of Arrow that are shown; chosen."""
_SAMPLED = 200
"""Lines by which a column of text is told from one of numbers; chosen."""


def read_pieces(
    path: Path,
    dialect: Dialect,
    wanted: Collection[str] | None = None,
    leading: Collection[str] = (),
    texts: Collection[str] = (),
) -> Iterator[Contents]:
    """Yield a CSV, Parquet, MDF or TDMS file piece by piece, with its `wanted` channels; None: with all.

    Columns of a text that may hold texts among numbers are `texts`, or show it in its first lines.
    Times that are written as dates become Unix time, s. Of several groups with their own times, the one that
    has a channel of `leading` comes first and is read block by block; the others have what lies beside each
    block, and some samples around it. MDF and TDMS are read in a process of their own.

    Raises as `read_contents`.
    """
    path.stat()
    if not path.is_file():
        raise UnreadableError("not a file")
    kind = format_of(path)
    if kind in ("mdf", "tdms"):
        asked = None if wanted is None else sorted(wanted)
        request = {"wanted": asked, "leading": list(leading), "at_once": module_of(kind).AT_ONCE}
        yield from isolation.read_apart(kind, path, request)
    elif kind in ("csv", "parquet"):
        opened = partial(_open_csv, texts=texts) if kind == "csv" else _open_parquet
        yield from _contents_of_batches(path, dialect, wanted, opened)
    else:
        raise UnreadableError(
            f"{kind} is not read in pieces; write it as Parquet: uictest export {path.name} --to parquet"
        )


class Table(NamedTuple):
    """A table that is read in batches.

    Args:
        names: of the columns of a batch, in their order.
        units: name -> unit.
        batches: of Arrow.
        source: the text that is read; None where columns of texts stay such.

    """

    names: list[str]
    units: dict[str, str]
    batches: Iterator[Any]
    source: csv_text.TextTable | None = None


def _contents_of_batches(
    path: Path, dialect: Dialect, wanted: Collection[str] | None, opened: Callable[..., Table]
) -> Iterator[Contents]:
    import pyarrow as pa

    try:
        table, first_row = opened(path, dialect, wanted), 0
        locations: dict[str, dict[str, str]] = {name: {} for name in table.names}
        for batch in table.batches:
            group = Group("", {}, dict(table.units), first_row=first_row)
            for k, name in enumerate(table.names):
                _add_column(group, name, batch.column(k), table.source, locations[name])
            yield Contents((group,))
            first_row += batch.num_rows
    except UnicodeEncodeError as error:
        raise UnreadableError("the name of the file is not UTF-8, which Arrow needs: rename it") from error
    except UnicodeError as error:
        advice = f"{encoding_advice(dialect.encoding)} in a channel map (--map)"
        raise UnreadableError(f"is not {dialect.encoding} throughout; {advice}") from error
    except (pa.ArrowException, OSError) as error:
        if isinstance(error, OSError) and error.errno:
            raise
        reason = "".join(c if c.isprintable() else "?" for c in str(error).splitlines()[0])
        raise UnreadableError(
            f"damaged, or not a table of numbers throughout: {reason[:_LONGEST]}"
        ) from error


def _add_column(
    group: Group, name: str, column: Any, source: csv_text.TextTable | None, locations: dict[str, str]
) -> None:
    """Add the samples of a column to a group; dates are Unix time, s. `locations` are of earlier texts."""
    if source is not None and parquet.holds_texts(column.type):
        read = source.cells.column(column)
        # To look for those of a column of texts alone would take as long as to read it.
        for text in read.first_rows() if read.is_mixed else ():
            if text not in locations and len(locations) < MOST_LOCATED:
                locations[text] = source.location_of(name, text)
        csv_text.add_texts(group, name, read, dict(locations))
    elif parquet.is_moment(column.type):
        group.channels[name] = parquet.seconds_of_moments(column)
    else:
        group.channels[name] = parquet.samples_of_column(column)


def _open_parquet(path: Path, dialect: Dialect, wanted: Collection[str] | None) -> Table:
    import pyarrow.parquet as pq

    file = pq.ParquetFile(path, pre_buffer=False)  # else all that is to be read stays in memory
    columns, units = parquet.columns_of(file.schema_arrow)
    names = [name for name in columns if wanted is None or name in wanted]
    batches = file.iter_batches(_ROWS, columns=[columns[name] for name in names], use_threads=True)
    stated = {name: units[name] for name in names if name in units}
    return Table(names, stated, batches)


def _open_csv(path: Path, dialect: Dialect, wanted: Collection[str] | None, texts: Collection[str]) -> Table:
    import pyarrow as pa
    from pyarrow import csv

    table = csv_text.opened(path, dialect)
    chosen = [name for name in table.names if wanted is None or name in wanted]
    below = table.heading[table.layout.first_line - 1 :]
    first = [line for line in below if line.strip() and not line.startswith(COMMENT)]
    rows = [cells_of(line, dialect.delimiter) for line in first[:_SAMPLED]]
    # A delimiter may end each line of samples.
    ended = bool(rows) and all(len(row) == len(table.names) + 1 and not row[-1] for row in rows)
    names = [*table.names, ""] if ended else table.names
    if names[-1] == csv_text.REMARK and rows and all(len(row) == len(names) - 1 for row in rows):
        names = names[:-1]
        chosen = [name for name in chosen if name != csv_text.REMARK]
    all_texts = bool(dialect.thousands)  # which Arrow does not read
    texts = {name for name in chosen if all_texts or name in texts or _is_text_column(table, name, rows)}
    read = csv.ReadOptions(
        skip_rows=table.layout.first_line - 1, column_names=names, block_size=_BLOCK, encoding=table.encoding
    )
    parse = csv.ParseOptions(
        delimiter=dialect.delimiter, invalid_row_handler=_handler_of_invalid_rows(path, table.encoding)
    )
    convert = csv.ConvertOptions(
        include_columns=chosen,
        column_types={name: pa.string() if name in texts else pa.float64() for name in chosen},
        null_values=table.cells.marks,
        decimal_point=dialect.decimal,
    )
    numbers = [name for name in chosen if name not in texts]
    units = {name: unit for name, unit in zip(table.names, table.units, strict=True) if unit}
    return Table(chosen, units, _checked_batches(table, numbers, read, parse, convert), table)


def _is_text_column(table: csv_text.TextTable, name: str, rows: Sequence[Sequence[str]]) -> bool:
    column = table.names.index(name)
    return any(table.cells.is_text(row[column]) for row in rows if column < len(row))


def _checked_batches(table: csv_text.TextTable, numbers: Sequence[str], *options: Any) -> Iterator[Any]:
    """Yield the batches of a table, in which the columns of `numbers` must be such throughout."""
    import pyarrow as pa
    from pyarrow import csv

    try:
        yield from csv.open_csv(table.path, *options)
    except pa.ArrowInvalid:
        table.require_complete(numbers)
        raise


def _handler_of_invalid_rows(path: Path, encoding: str) -> Callable[[Any], str]:
    """Return a handler that skips comments and an unfinished last line; another line is an error."""
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - csv_text.LONGEST_LINE, 0))
        last = file.read().decode(encoding, "replace").rpartition("\n")[2]
    return lambda row: "skip" if row.text.startswith(COMMENT) or row.text == last else "error"


def is_wanted(channel: str, group: str, wanted: Collection[str] | None) -> bool:
    """Return whether a channel is wanted, by its name or by group and name; None: all are."""
    return wanted is None or channel in wanted or f"{group}/{channel}" in wanted


def in_step(streams: Sequence[Iterator[Group]], leading: Collection[str]) -> Iterator[Contents]:
    """Yield the blocks of the group with a channel of `leading`, and the samples of other groups meanwhile.

    The others begin and end some samples before and after the block where they have them. A block that lasts
    longer than one of theirs is divided: else a fast group would be held in memory for hours of a slow one.

    Raises UnreadableError where several groups have no times, or times that go back.
    """
    begun = [(first, stream) for stream in streams if (first := next(stream, None)) is not None]

    def is_leading(block: Group) -> bool:
        return any(is_wanted(name, block.name, leading) for name in block.channels)

    begun.sort(key=lambda begin: not is_leading(begin[0]))
    if not begun:
        return
    (first, stream), *others = begun
    followers = [_Follower(*other) for other in others]
    span = min((follower.lasts for follower in followers), default=math.inf)
    for block in itertools.chain((first,), stream):
        for part in _parts_within_span(block, span):
            yield Contents((part, *(follower.during(part) for follower in followers)))


def _parts_within_span(block: Group, span: float) -> Iterator[Group]:
    """Yield the rows of a block that lie within `span` (s) of each other."""
    if math.isinf(span):
        yield block
        return
    times = _nondecreasing_times(block)
    begins = np.flatnonzero(np.diff((times - times[0]) // span)) + 1
    for rows in itertools.pairwise((0, *begins.tolist(), len(times))):
        part = _with_samples_mapped(block, itemgetter(slice(*rows)))
        yield replace(part, first_row=block.first_row + rows[0])


class _Follower:
    """A group from which the part over the time of each block of the leading group is taken, in order."""

    def __init__(self, first: Group, following: Iterator[Group]) -> None:
        second = next(following, None)
        self._held, self._following = first, itertools.chain(() if second is None else (second,), following)
        times = _nondecreasing_times(first)
        duration = float(times[-1] - times[0])
        self.lasts = math.inf if second is None or not duration > 0.0 else duration
        """Duration of a block, s; infinite where there is only one."""

    def during(self, part: Group) -> Group:
        """Return the samples during a part of the leading group, and a few around; parts come in order."""
        begin, end = _nondecreasing_times(part)[[0, -1]]
        while (
            _nondecreasing_times(self._held)[-1] <= end and (block := next(self._following, None)) is not None
        ):
            self._held = _concatenated(self._held, block)
        times = _nondecreasing_times(self._held)
        first = max(int(np.searchsorted(times, begin)) - _OVERLAP, 0)
        last = int(np.searchsorted(times, end, side="right")) + _OVERLAP
        self._held = _with_samples_mapped(self._held, lambda samples: samples[first:])
        return _with_samples_mapped(self._held, lambda samples: samples[: last - first])


def _with_samples_mapped(group: Group, change: Callable[[Any], Any]) -> Group:
    channels = {name: change(samples) for name, samples in group.channels.items()}
    return replace(group, channels=channels, time=change(group.time))


def _concatenated(one: Group, other: Group) -> Group:
    channels = {
        name: np.concatenate((one.channels[name], other.channels[name]))
        for name in one.channels
        if name in other.channels
    }
    time = np.concatenate((_nondecreasing_times(one), _nondecreasing_times(other)))
    return replace(one, channels=channels, time=time)


def _nondecreasing_times(group: Group) -> Any:
    """Return the times of a group. Raises UnreadableError where it has none or they go back."""
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

"""Long files, read in pieces: one is given after the other."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.recording.formats import csv_text, isolation, parquet, streams
from uictest.core.recording.formats.file_formats import UnreadableError, format_of
from uictest.core.recording.formats.layout import COMMENT, Dialect, encoding_advice, encoding_of, table_layout
from uictest.core.recording.recording import Contents, Group, Samples

_BLOCK = 2 * 2**20
"""Bytes of text that are parsed at once, of which Arrow reads up to 32 blocks ahead; chosen."""
_ROWS = 2**17
"""Rows of a Parquet file that are decoded at once; chosen."""
_LONGEST = 200
"""Characters of a message of Arrow that are shown; chosen."""
_SAMPLED = 200
"""Lines by which a column of text is told from one of numbers; chosen."""


def read_pieces(
    path: Path, dialect: Dialect, wanted: Collection[str] | None = None, leading: Collection[str] = ()
) -> Iterator[Contents]:
    """Yield a CSV, Parquet, MDF or TDMS file piece by piece, with its `wanted` channels; None: with all.

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
        request = {"wanted": asked, "leading": list(leading), "at_once": streams.AT_ONCE[kind]}
        yield from isolation.read_apart(kind, path, request)
    elif kind in ("csv", "parquet"):
        yield from _tables(path, dialect, wanted, _csv if kind == "csv" else _parquet)
    else:
        raise UnreadableError(
            f"{kind} is not read in pieces; write it as Parquet: uictest export {path.name} --to parquet"
        )


Table = tuple[list[str], dict[str, str], Iterator[Any]]


def _tables(
    path: Path, dialect: Dialect, wanted: Collection[str] | None, opened: Callable[..., Table]
) -> Iterator[Contents]:
    import pyarrow as pa

    dated: set[str] = set()
    try:
        names, units, batches = opened(path, dialect, wanted)
        for batch in batches:
            columns = {name: _samples(name, batch.column(k), dated) for k, name in enumerate(names)}
            yield Contents((Group("", columns, {**units, **dict.fromkeys(dated, "s")}),))
    except UnicodeEncodeError as error:
        raise UnreadableError("the name of the file is not UTF-8, which Arrow needs: rename it") from error
    except UnicodeError as error:
        advice = f"{encoding_advice(dialect.encoding)} in a channel map (--map)"
        raise UnreadableError(f"is not {dialect.encoding} throughout; {advice}") from error
    except (pa.ArrowException, OSError) as error:
        if isinstance(error, OSError) and error.errno:
            raise
        told = "".join(each if each.isprintable() else "?" for each in str(error).splitlines()[0])
        raise UnreadableError(f"damaged, or not a table of numbers throughout: {told[:_LONGEST]}") from error


def _parquet(path: Path, dialect: Dialect, wanted: Collection[str] | None) -> Table:
    import pyarrow.parquet as pq

    file = pq.ParquetFile(path, pre_buffer=False)  # else all that is to be read stays in memory
    parquet.reject_same_names(file.schema_arrow.names)
    names = [name for name in file.schema_arrow.names if wanted is None or name in wanted]
    units = parquet.units_of(file.schema_arrow)
    batches: Iterator[Any] = file.iter_batches(_ROWS, columns=names, use_threads=True)
    return names, units, batches


def _csv(path: Path, dialect: Dialect, wanted: Collection[str] | None) -> Table:
    import pyarrow as pa
    from pyarrow import csv

    encoding = encoding_of(path, dialect.encoding)
    if dialect.thousands:
        raise UnreadableError("thousands separators are not read in pieces: write the numbers without them")
    heading = csv_text.heading_of(path, encoding, dialect)
    layout = table_layout(heading, dialect)
    names, stated = csv_text.names_and_units(heading, layout, dialect)
    units = {name: unit for name, unit in zip(names, stated, strict=True) if unit}
    chosen = [name for name in names if wanted is None or name in wanted]
    first = [line for line in heading[layout.first_line - 1 :][:_SAMPLED] if not line.startswith(COMMENT)]
    kinds = {name: _kind([_cell(line, k, dialect) for line in first]) for k, name in enumerate(names)}
    # A delimiter may end each line of samples.
    ended = bool(first) and all(_is_ended(line.rstrip("\r\n"), len(names), dialect) for line in first)
    read = csv.ReadOptions(
        skip_rows=layout.first_line - 1,
        column_names=[*names, ""] if ended else names,
        block_size=_BLOCK,
        encoding=encoding,
    )
    parse = csv.ParseOptions(delimiter=dialect.delimiter, invalid_row_handler=_on_other_lines(path, encoding))
    convert = csv.ConvertOptions(
        include_columns=chosen,
        column_types={name: pa.float64() if kinds[name] else pa.string() for name in chosen},
        null_values=["", "nan", "NaN", "NAN", "null", "NULL", "N/A", "-"],
        decimal_point=dialect.decimal,
    )
    return chosen, units, _batches(path, read, parse, convert)


def _batches(path: Path, read: Any, *options: Any) -> Iterator[Any]:
    """Yield the batches of a table; an error names the row, which Arrow knows with one thread alone."""
    import pyarrow as pa
    from pyarrow import csv

    try:
        yield from csv.open_csv(path, read, *options)
    except pa.ArrowInvalid:
        read.use_threads = False
        for _ in csv.open_csv(path, read, *options):
            pass
        raise


def _on_other_lines(path: Path, encoding: str) -> Callable[[Any], str]:
    """Return what to do with a line of other cells: comments and an unfinished last line are skipped."""
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - csv_text.LONGEST_LINE, 0))
        last = file.read().decode(encoding, "replace").rpartition("\n")[2]
    return lambda row: "skip" if row.text.startswith(COMMENT) or row.text == last else "error"


def _is_ended(line: str, cells: int, dialect: Dialect) -> bool:
    return line.endswith(dialect.delimiter) and line.count(dialect.delimiter) == cells


def _cell(line: str, column: int, dialect: Dialect) -> str:
    cells = line.rstrip("\r\n").split(dialect.delimiter)
    return cells[column].strip().replace(dialect.decimal, ".") if column < len(cells) else ""


def _kind(cells: Sequence[str]) -> bool:
    """Return whether cells are numbers, as far as they are filled."""
    filled = [cell for cell in cells if cell]
    try:
        [float(cell) for cell in filled]
    except ValueError:
        return False
    return True


def _samples(name: str, column: Any, dated: set[str]) -> Samples:
    """Return the samples of a column; `dated` remembers which columns are texts of dates."""
    import pandas as pd
    import pyarrow as pa

    if pa.types.is_duration(column.type):
        return parquet.samples_of_column(column)
    texts = parquet.holds_texts(column.type)
    if not texts and not parquet.holds_times(column.type):
        return np.asarray(column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False))
    first = next((value for value in itertools.islice(column, _SAMPLED) if value.is_valid), None)
    if texts and name not in dated and (first is None or not csv_text.is_date(first.as_py())):
        return parquet.samples_of_column(column)
    dated.add(name)
    cells = pd.Series(column.to_pandas())
    stamps = pd.to_datetime(cells, format="ISO8601", errors="coerce", utc=True)
    if len(unread := cells[stamps.isna() & cells.notna()]):
        raise UnreadableError(f"{name}: {unread.iloc[0]!r}: write dates as 2026-05-31T12:00:00.000")
    return np.asarray((stamps - pd.Timestamp(0, tz="UTC")).dt.total_seconds(), dtype=np.float64)

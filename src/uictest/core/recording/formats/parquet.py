"""Recordings as Parquet files: units beside the channels and in the schema, facts in the schema."""

from __future__ import annotations

import io
import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats.cells import LONGEST_TEXT, over_midnight
from uictest.core.recording.formats.file_formats import UnreadableError, check_size
from uictest.core.recording.formats.layout import names_and_units_of
from uictest.core.recording.recording import Contents, Group, Recording, Samples

if TYPE_CHECKING:
    import pyarrow as pa


SCHEMA = "uictest/recording/1"
_SCHEMA, _UNITS, _METADATA, _UNIT = b"uictest.schema", b"uictest.units", b"uictest.metadata", b"unit"


def parquet_bytes(recording: Recording) -> bytes:
    """Return a recording as a Parquet file: the same recording gives the same bytes."""
    return channels_bytes(recording.channels, recording.units, recording.metadata, {_SCHEMA: SCHEMA})


def channels_bytes(
    channels: Mapping[str, NDArray[Any]],
    units: Mapping[str, str],
    metadata: Mapping[str, str],
    marks: Mapping[bytes, str] | None = None,
) -> bytes:
    """Return channels of equal length as such a file; unlike those of a recording, their clock may step.

    Args:
        channels: name -> samples.
        units: name -> unit, of every channel.
        metadata: facts, as text.
        marks: further entries of the schema's metadata.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    fields = [
        pa.field(name, pa.from_numpy_dtype(samples.dtype), metadata={_UNIT: units[name]})
        for name, samples in channels.items()
    ]
    schema_metadata = {
        **(marks or {}),
        _UNITS: json.dumps(dict(units), ensure_ascii=False),
        _METADATA: json.dumps(dict(metadata), ensure_ascii=False),
    }
    table = pa.table(list(channels.values()), schema=pa.schema(fields, metadata=schema_metadata))
    content = io.BytesIO()
    # Samples hardly recur: to look for those that do takes half of writing, and files are a fifth larger.
    pq.write_table(table, content, compression="zstd", use_dictionary=False)
    return content.getvalue()


def read_parquet(path: Path) -> Recording:
    """Read a recording.

    The unit of a channel is its field's `unit`; for a file from a tool that drops field
    metadata, it is the one in the schema metadata. Missing samples of a channel become NaN.

    Raises:
        ValueError: the file is not a Parquet file, or its channels are not a recording.
        OSError: the file cannot be read.

    """
    import pyarrow.parquet as pq

    try:
        # ParquetFile, not read_table: the latter takes a "friction=0.10" in a path for a partition key.
        with path.open("rb") as file, pq.ParquetFile(file) as parquet:
            return _recording_of_table(parquet.read(use_threads=False))
    except ValueError as error:
        raise ValueError(f"{path}: not a recording: {error}") from error


def _recording_of_table(table: pa.Table) -> Recording:
    schema_metadata = table.schema.metadata or {}
    channels = {name: table.column(name).to_numpy() for name in table.column_names}
    # What another program wrote as true and false are numbers, too.
    channels |= {name: samples.astype("f8") for name, samples in channels.items() if samples.dtype == bool}
    units = _texts(schema_metadata.get(_UNITS, b"{}")) | _units_of_fields(table.schema)
    metadata = _texts(schema_metadata.get(_METADATA, b"{}"))
    return Recording(channels, {name: units.get(name, "") for name in channels}, metadata)


def _texts(content: bytes) -> dict[str, str]:
    texts: Any = json.loads(content)
    if not isinstance(texts, dict):
        raise ValueError(f"expected a JSON object in the schema metadata, found {texts!r}")
    return {str(key): str(value) for key, value in texts.items()}


def read(path: Path) -> Contents:
    """Read every column of numbers, truth values or short texts. Raises UnreadableError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with path.open("rb") as file, pq.ParquetFile(file) as parquet:
            rows, schema = parquet.metadata.num_rows, parquet.schema_arrow
            columns, units = columns_of(schema)
            read = [column for column in columns.values() if _holds_samples(schema.field(column).type)]
            check_size([(rows,)] * len(schema))
            table = parquet.read(columns=read, use_threads=False)
    except (pa.ArrowException, OSError) as error:
        raise UnreadableError("no Parquet file, or a damaged one") from error
    skipped = {field.name: f"holds {field.type}" for field in schema if field.name not in read}
    channels = {n: samples_of_column(table.column(column)) for n, column in columns.items() if column in read}
    stated = {name: unit for name, unit in units.items() if name in channels}
    return Contents(
        (Group("", channels, stated),), _json_texts((schema.metadata or {}).get(_METADATA)), skipped
    )


encoded = parquet_bytes


def columns_of(schema: pa.Schema) -> tuple[dict[str, str], dict[str, str]]:
    """Return the column of each channel by the channel's name, and the units of those that state one.

    A unit in brackets after a name is taken as the unit where the file states no other.

    Raises UnreadableError for a name that several columns have.
    """
    for name, count in Counter(schema.names).items():
        if count > 1:
            raise UnreadableError(f"{count} columns have the name {name!r}")
    times = {field.name: "s" for field in schema if holds_times(field.type)}
    units = {**_json_texts((schema.metadata or {}).get(_UNITS)), **_units_of_fields(schema), **times}
    split = dict(zip(schema.names, names_and_units_of(schema.names), strict=True))
    alike = Counter(name for name, _ in split.values())
    columns: dict[str, str] = {}
    for column, (name, unit) in split.items():
        plain = name if unit and column not in units and alike[name] == 1 else column
        columns[plain] = column
        units |= {plain: unit} if plain != column else {}
    return columns, units


def _holds_samples(kind: pa.DataType) -> bool:
    import pyarrow as pa

    numbers = pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)
    return bool(numbers or pa.types.is_decimal(kind) or holds_times(kind) or holds_texts(kind))


def holds_times(kind: pa.DataType) -> bool:
    """Return whether a column holds dates, times of a day or durations."""
    import pyarrow as pa

    return is_moment(kind) or bool(pa.types.is_duration(kind))


def holds_texts(kind: pa.DataType) -> bool:
    """Return whether a column holds texts."""
    import pyarrow as pa

    if pa.types.is_dictionary(kind):
        return holds_texts(kind.value_type)
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def samples_of_column(column: Any) -> Samples:
    """Return the samples of a column of numbers, times or short texts."""
    import pyarrow as pa

    if holds_texts(column.type):
        return np.array([(text or "")[:LONGEST_TEXT] for text in column.to_pylist()], dtype=np.str_)
    if is_moment(column.type):
        moments = seconds_of_moments(column)
        return moments - next(iter(moments[np.isfinite(moments)]), 0.0)
    if pa.types.is_duration(column.type):
        durations = column.to_numpy(zero_copy_only=False)
        return np.asarray(durations / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    numbers = column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False)
    return np.asarray(numbers, dtype=np.float64)


def is_moment(kind: pa.DataType) -> bool:
    """Return whether a column holds dates or times of a day."""
    import pyarrow as pa

    return bool(pa.types.is_timestamp(kind) or pa.types.is_time(kind))


def seconds_of_moments(column: Any) -> Samples:
    """Return dates as Unix time and times of a day since its midnight, s; one that is missing becomes NaN."""
    import pyarrow as pa

    if pa.types.is_time(column.type):
        of_day = column.cast(pa.time64("us")).cast(pa.int64()).to_numpy(zero_copy_only=False)
        return over_midnight(np.asarray(1e-6 * of_day, dtype=np.float64))
    stamps = column.to_numpy(zero_copy_only=False).astype("datetime64[us]")
    return np.asarray((stamps - np.datetime64(0, "us")) / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)


def _units_of_fields(schema: pa.Schema) -> dict[str, str]:
    marked = ((field.name, (field.metadata or {}).get(_UNIT, b"")) for field in schema)
    return {name: unit.decode("utf-8", "replace") for name, unit in marked if unit}


def _json_texts(content: bytes | None) -> dict[str, str]:
    try:
        texts = json.loads(content or b"{}")
    except (ValueError, RecursionError):
        return {}
    return {str(key): str(value) for key, value in texts.items()} if isinstance(texts, dict) else {}

"""Parquet files, this program's own and others'."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from uictest.core.recording.formats.file_formats import UnreadableError, check_size
from uictest.core.recording.parquet import parquet_bytes
from uictest.core.recording.recording import Contents, Group, Recording, Samples

if TYPE_CHECKING:
    import pyarrow as pa

_LONGEST_TEXT = 64


def read(path: Path) -> Contents:
    """Read every column of numbers, truth values or short texts. Raises UnreadableError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with path.open("rb") as file, pq.ParquetFile(file) as parquet:
            rows, schema = parquet.metadata.num_rows, parquet.schema_arrow
            reject_same_names(schema.names)
            names = [field.name for field in schema if _holds_samples(field.type)]
            check_size([(rows,)] * len(schema))
            table = parquet.read(columns=names, use_threads=False)
    except (pa.ArrowException, OSError) as error:
        raise UnreadableError("no Parquet file, or a damaged one") from error
    facts = {key.decode("utf-8", "replace"): value for key, value in (schema.metadata or {}).items()}
    units = units_of(schema)
    skipped = {field.name: f"holds {field.type}" for field in schema if field.name not in names}
    channels = {name: samples_of_column(table.column(name)) for name in names}
    return Contents((Group("", channels, units),), _object(facts.get("uictest.metadata")), skipped)


def encoded(recording: Recording) -> bytes:
    """Return a recording as a file."""
    return parquet_bytes(recording)


def reject_same_names(names: list[str]) -> None:
    """Raise UnreadableError for a name that several columns have."""
    for name, count in Counter(names).items():
        if count > 1:
            raise UnreadableError(f"{count} columns have the name {name!r}")


def _holds_samples(kind: pa.DataType) -> bool:
    import pyarrow as pa

    numbers = pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)
    return bool(numbers or pa.types.is_decimal(kind) or holds_times(kind) or holds_texts(kind))


def holds_times(kind: pa.DataType) -> bool:
    """Return whether a column holds dates or durations."""
    import pyarrow as pa

    return bool(pa.types.is_timestamp(kind) or pa.types.is_duration(kind))


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
        return np.array([(text or "")[:_LONGEST_TEXT] for text in column.to_pylist()], dtype=np.str_)
    if pa.types.is_timestamp(column.type):
        return _seconds(column.to_numpy().astype("datetime64[us]"))
    if pa.types.is_duration(column.type):
        return np.asarray(column.to_numpy() / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    return np.asarray(column.cast(pa.float64(), safe=False).to_numpy(), dtype=np.float64)


def _seconds(stamps: Any) -> Samples:
    """Return time stamps as seconds after the first; one that is missing becomes NaN."""
    since = (stamps - stamps[~np.isnat(stamps)][:1]) / np.timedelta64(1, "us") * 1e-6
    return np.asarray(since, dtype=np.float64)


def units_of(schema: pa.Schema) -> dict[str, str]:
    """Return the unit of every column that states one."""
    of_schema = _object((schema.metadata or {}).get(b"uictest.units"))
    times = {field.name: "s" for field in schema if holds_times(field.type)}
    return {**of_schema, **_field_units(schema), **times}


def _field_units(schema: pa.Schema) -> dict[str, str]:
    marked = ((field.name, (field.metadata or {}).get(b"unit", b"")) for field in schema)
    return {name: unit.decode("utf-8", "replace") for name, unit in marked if unit}


def _object(content: bytes | None) -> dict[str, str]:
    try:
        texts = json.loads(content or b"{}")
    except (ValueError, RecursionError):
        return {}
    return {str(key): str(value) for key, value in texts.items()} if isinstance(texts, dict) else {}

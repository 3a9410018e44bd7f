"""Recordings as Parquet files: units beside the channels and in the schema, facts in the schema."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from uictest.core.recording.recording import Recording

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
    """Return channels of equal length as such a file, also those that are no recording: their clock may step.

    Args:
        channels: name -> samples.
        units: name -> unit, of every channel.
        metadata: facts, as text.
        marks: further entries of the schema's metadata.
    """
    import pyarrow.parquet as pq

    content, table = io.BytesIO(), _table(channels, units, metadata, marks or {})
    # Samples hardly recur: to look for those that do takes half of writing, and files are a fifth larger.
    pq.write_table(table, content, compression="zstd", use_dictionary=False)
    return content.getvalue()


def read_parquet(path: Path) -> Recording:
    """Read a recording.

    The unit of a channel is its field's `unit`; for a file from a tool that drops field
    metadata, it is the one in the schema metadata. Missing samples of a channel become NaN.

    Raises:
        ValueError: the file is no Parquet file, or its channels are no recording.
        OSError: the file cannot be read.

    """
    import pyarrow.parquet as pq

    try:
        # ParquetFile, not read_table: the latter takes a "friction=0.10" in a path for a partition key.
        with path.open("rb") as file, pq.ParquetFile(file) as parquet:
            return _recording(parquet.read(use_threads=False))
    except ValueError as error:
        raise ValueError(f"{path}: not a recording: {error}") from error


def _table(
    channels: Mapping[str, NDArray[Any]],
    units: Mapping[str, str],
    metadata: Mapping[str, str],
    marks: Mapping[bytes, str],
) -> pa.Table:
    import pyarrow as pa

    fields = [
        pa.field(name, pa.from_numpy_dtype(samples.dtype), metadata={_UNIT: units[name]})
        for name, samples in channels.items()
    ]
    schema_metadata = {
        **marks,
        _UNITS: json.dumps(dict(units), ensure_ascii=False),
        _METADATA: json.dumps(dict(metadata), ensure_ascii=False),
    }
    return pa.table(list(channels.values()), schema=pa.schema(fields, metadata=schema_metadata))


def _recording(table: pa.Table) -> Recording:
    schema_metadata = table.schema.metadata or {}
    units = _texts(schema_metadata.get(_UNITS, b"{}"))
    return Recording(
        channels={name: _samples(table.column(name)) for name in table.column_names},
        units={field.name: _unit(field.metadata or {}, units.get(field.name, "")) for field in table.schema},
        metadata=_texts(schema_metadata.get(_METADATA, b"{}")),
    )


def _samples(column: pa.ChunkedArray) -> Any:
    """Return the samples of a channel; what another program wrote as true and false are numbers, too."""
    samples = column.to_numpy()
    return samples.astype("f8") if samples.dtype == bool else samples


def _unit(metadata: Mapping[bytes, bytes], otherwise: str) -> str:
    unit = metadata.get(_UNIT)
    return unit.decode("utf-8") if unit else otherwise


def _texts(content: bytes) -> dict[str, str]:
    texts: Any = json.loads(content)
    if not isinstance(texts, dict):
        raise ValueError(f"expected a JSON object in the schema metadata, found {texts!r}")
    return {str(key): str(value) for key, value in texts.items()}

"""Messages between this process and a child: a JSON object and some blocks of bytes, with their lengths."""

import json
import struct
from collections.abc import Sequence
from typing import Any, BinaryIO, Final, NamedTuple

_COUNT: Final = struct.Struct("<I")
_LENGTH: Final = struct.Struct("<Q")
_MOST_BLOCKS: Final = 64
_LARGEST: Final = 1 << 32


class Message(NamedTuple):
    """What is sent at once."""

    head: dict[str, Any]
    blocks: tuple[bytes, ...] = ()


class BrokenMessageError(Exception):
    """What the other side sent is no message."""


class StreamEndedError(Exception):
    """The other side has ended."""


def write_message(stream: BinaryIO, head: dict[str, Any], blocks: Sequence[bytes] = ()) -> None:
    """Write a message at once."""
    parts = [json.dumps(head).encode(), *blocks]
    stream.write(_COUNT.pack(len(parts)) + b"".join(_LENGTH.pack(len(part)) for part in parts))
    for part in parts:
        stream.write(part)
    stream.flush()


def read_message(stream: BinaryIO) -> Message:
    """Wait for a message and return it. Raises BrokenMessageError, StreamEndedError."""
    (count,) = _COUNT.unpack(_exactly(stream, _COUNT.size))
    if not 0 < count <= _MOST_BLOCKS:
        raise BrokenMessageError(f"{count} blocks")
    lengths = [_LENGTH.unpack(_exactly(stream, _LENGTH.size))[0] for _ in range(count)]
    if sum(lengths) > _LARGEST:
        raise BrokenMessageError(f"{sum(lengths)} bytes")
    head, *blocks = [_exactly(stream, length) for length in lengths]
    try:
        said = json.loads(head)
    except (ValueError, RecursionError) as error:
        raise BrokenMessageError("no JSON") from error
    if not isinstance(said, dict):
        raise BrokenMessageError("no JSON object")
    return Message(said, tuple(blocks))


def _exactly(stream: BinaryIO, size: int) -> bytes:
    content = stream.read(size)
    if len(content) != size:
        raise StreamEndedError
    return content

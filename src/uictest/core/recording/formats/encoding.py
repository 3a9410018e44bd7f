"""The encoding of a text file, and where a file breaks it."""

from __future__ import annotations

import codecs
from pathlib import Path
from typing import Final

_BYTE_ORDER_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
MARK: Final = "\ufeff"
"""The byte-order mark as a character: UTF-16 of a named byte order keeps it at the start of the text."""


def encoding_of(path: Path, stated: str) -> str:
    """Return the encoding of a byte-order mark, else the stated one. Raises OSError."""
    with path.open("rb") as file:
        beginning = file.read(4)
    return next((name for mark, name in _BYTE_ORDER_MARKS if beginning.startswith(mark)), stated)


def undecodable(path: Path, encoding: str) -> str:
    """Return where a file does not match its encoding, and what to write instead. Raises OSError."""
    content = path.read_bytes()
    try:
        content.decode(encoding)
    except UnicodeDecodeError as error:
        before = content[: error.start].decode(encoding, "replace")
        start = max(before.rfind("\n"), before.rfind("\r")) + 1
        line = 1 + before.count("\n") + before.count("\r") - before.count("\r\n")
        byte = 1 + len(before[start:].lstrip(MARK).encode(encoding.removesuffix("-sig"), "replace"))
        wrong = f"line {line}, byte {byte}: {content[error.start]:#04x} is not {_shown(encoding)}"
        return f"{wrong}; {_advice(encoding)} in a channel map (--map)"
    return f"not a text in {_shown(encoding)}"


def _shown(encoding: str) -> str:
    return encoding.removesuffix("-sig").upper()


def _advice(encoding: str) -> str:
    if encoding.startswith("utf"):
        return "for a file of a Windows program, write csv: {encoding: cp1252}"
    return "write the file's encoding in csv: {encoding: ...}"

"""The format of a file, and the module that writes it."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from uictest.recording.formats.problems import UnreadableError

if TYPE_CHECKING:
    from uictest.recording.recording import Recording

FORMATS: Final = MappingProxyType(
    {"csv": "csv_text", "mdf": "mdf", "tdms": "tdms", "mat": "mat", "parquet": "parquet"}
)
"""Format -> the module of this package that reads and writes it."""

SUFFIXES: Final = MappingProxyType(
    {"csv": ".csv", "mdf": ".mf4", "tdms": ".tdms", "mat": ".mat", "parquet": ".parquet"}
)
"""Format -> suffix of the files that are written."""

_BEGINNINGS: Final = (
    (b"MDF     ", "mdf"),
    (b"UnFinMF ", "mdf"),
    (b"TDSm", "tdms"),
    (b"PAR1", "parquet"),
    (b"MATLAB ", "mat"),
    (b"\x89HDF\r\n\x1a\n", "mat"),
)
_TEXT_SUFFIXES: Final = (".csv", ".txt", ".tsv", ".asc", ".dat")
_ENOUGH: Final = 128


def format_of(path: Path) -> str:
    """Return the format of a file: by how it begins, and for text by its suffix.

    Raises UnreadableError for a file of no known format, OSError for one that cannot be opened.
    """
    with path.open("rb") as file:
        beginning = file.read(_ENOUGH)
    if not beginning:
        raise UnreadableError("the file is empty")
    for magic, name in _BEGINNINGS:
        if beginning.startswith(magic):
            return name
    if path.suffix.lower() in _TEXT_SUFFIXES:
        return "csv"
    raise UnreadableError(
        f"not a recording: known are Parquet, MDF, TDMS and MAT files and texts ({', '.join(_TEXT_SUFFIXES)})"
    )


def writer_of(name: str) -> Callable[[Recording, Path], None]:
    """Return the function that writes a recording in a format of FORMATS."""
    module = importlib.import_module(f"uictest.recording.formats.{FORMATS[name]}")
    write: Callable[[Recording, Path], None] = module.write
    return write

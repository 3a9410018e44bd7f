"""The formats of measurement files, the module of each, and the errors and limits of all."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from uictest.core import files

if TYPE_CHECKING:
    from uictest.core.recording.recording import Recording


class UnreadableError(ValueError):
    """A file that cannot be read as a recording; the message says why."""


class MissingExtraError(Exception):
    """A format whose library is not installed; the message is the line that installs it."""


class ReadingInterruptedError(OSError):
    """Reading was interrupted by the machine, whatever the file contains: a full disk, a killed process."""


def required_module(module: str, extra: str) -> Any:
    """Return a module. Raises MissingExtraError with the line that installs it, as `uictest[extra]`."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        raise MissingExtraError(f"{module} is not installed: pip install 'uictest[{extra}]'") from error


LARGEST_FILE = 2**30
"""bytes"""

MOST_VALUES = 50_000_000
"""Values of all channels of a file together: 400 MB."""

MOST_CHANNELS = 20_000

READING_SECONDS = 120.0
"""Time after which reading is aborted."""

READING_MEMORY = 6 * 2**30
"""Address space of the process that reads, bytes."""


def check_size(shapes: Iterable[tuple[int, ...]]) -> None:
    """Raise UnreadableError where the channels that a file declares are too many or too long together."""
    sizes = [math.prod(shape) for shape in shapes]
    if len(sizes) > MOST_CHANNELS:
        raise UnreadableError(f"{len(sizes)} channels; at most {MOST_CHANNELS} are read")
    if any(size < 0 for size in sizes) or sum(sizes) > MOST_VALUES:
        raise UnreadableError(f"{sum(sizes)} values; at most {MOST_VALUES} are read")


class FileFormat(NamedTuple):
    """A format of measurement files.

    Args:
        module: the module of this package that reads and writes it.
        suffix: of the files that are written.
        beginnings: with which bytes its files begin; none for text.

    """

    module: str
    suffix: str
    beginnings: tuple[bytes, ...] = ()


FORMATS: Final = MappingProxyType(
    {
        "csv": FileFormat("csv_text", ".csv"),
        "mdf": FileFormat("mdf", ".mf4", (b"MDF     ", b"UnFinMF ")),
        "tdms": FileFormat("tdms", ".tdms", (b"TDSm",)),
        "mat": FileFormat("mat", ".mat", (b"MATLAB ", b"\x89HDF\r\n\x1a\n")),
        "parquet": FileFormat("parquet", ".parquet", (b"PAR1",)),
    }
)
"""Every format by name."""

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
    for name, file_format in FORMATS.items():
        if beginning.startswith(file_format.beginnings):
            return name
    if path.suffix.lower() in _TEXT_SUFFIXES:
        return "csv"
    raise UnreadableError(
        f"not a recording: known are Parquet, MDF, TDMS and MAT files and texts ({', '.join(_TEXT_SUFFIXES)})"
    )


def module_of(name: str) -> Any:
    """Return the module that reads and writes a format; none is loaded before it is needed."""
    return importlib.import_module(f"uictest.core.recording.formats.{FORMATS[name].module}")


def encoded(recording: Recording, name: str) -> bytes:
    """Return a recording as a file of a format of FORMATS. Raises MissingExtraError without its library."""
    content: bytes = module_of(name).encoded(recording)
    return content


def writer_of(name: str) -> Callable[[Recording, Path], None]:
    """Return the function that writes a recording in a format of FORMATS. It raises as `encoded`, OSError."""
    return lambda recording, path: files.write_to(path, encoded(recording, name))

"""The formats of measurement files, the module of each, and the errors and limits of all."""

from __future__ import annotations

import importlib
import itertools
import math
import re
from collections.abc import Callable, Container, Iterable
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


def distinct(name: str, channels: Container[str]) -> str:
    """Return a name that is not among those of `channels`: itself, or with a number behind it."""
    if name not in channels:
        return name
    return next(other for k in itertools.count(2) if (other := f"{name} ({k})") not in channels)


def facts_in(lines: Iterable[str]) -> dict[str, str]:
    """Return what lines of remarks such as `train: 4711` state, by name."""
    pairs = (line.partition(":") for line in lines)
    return {name.strip(): fact.strip() for name, colon, fact in pairs if colon and name.strip()}


class FileFormat(NamedTuple):
    """A format of measurement files.

    Args:
        module: the module of this package that reads and writes it.
        suffix: of the files that are written.
        beginning: a regular expression of the bytes with which its files begin; empty for text.

    """

    module: str
    suffix: str
    beginning: bytes = b""


_MAT: Final = (
    rb"MATLAB [\d.]+ MAT-file|.{124}(\0[\x01\x02]IM|[\x01\x02]\0MI)|"
    # Version 4: type, rows, columns, complex or not, length of the name, in either order of bytes; the name.
    rb"([\0-\x34]\0{3}.{8}[\0\x01]\0{3}[\x02-\x40]\0{3}"
    rb"|\0\0(\x03[\xe8-\xff]|\x04[\0-\x1c]).{8}\0{3}[\0\x01]\0{3}[\x02-\x40])[A-Za-z]\w*\0"
)
FORMATS: Final = MappingProxyType(
    {
        "csv": FileFormat("csv_text", ".csv"),
        "mdf": FileFormat("mdf", ".mf4", rb"MDF     |UnFinMF "),
        "tdms": FileFormat("tdms", ".tdms", rb"TDSm"),
        "mat": FileFormat("mat", ".mat", _MAT),
        "parquet": FileFormat("parquet", ".parquet", rb"PAR1"),
    }
)
"""Every format by name."""

_WORKBOOK: Final = (
    rb"PK\x03\x04.{26}(\[Content_Types\]\.xml|_rels/|docProps/|xl/|mimetypeapplication/vnd\.oasis)"
    rb"|\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
)
_COMPRESSED: Final = (
    rb"PK\x03\x04|\x1f\x8b|BZh\d1AY&SY|\xfd7zXZ\0|\x28\xb5\x2f\xfd|7z\xbc\xaf\x27\x1c|Rar!\x1a\x07"
)
_DECODE: Final = "it holds frames of a bus: decode them with their DBC and save the signals as MDF 4 or CSV"
_REFUSED: Final = (
    ("Excel or OpenDocument workbook", _WORKBOOK, "save its sheet as CSV"),
    ("HTML page", rb"(?i)\s*<(!doctype )?html\b", "save its table as CSV"),
    ("compressed file", _COMPRESSED, "unpack it, and name the file inside"),
    ("Vector BLF", rb"LOGG.\0{3}", _DECODE),
    ("Vector ASC", rb"(\xef\xbb\xbf)?date [^\r\n]+\r?\nbase (hex|dec)", _DECODE),
    ("PEAK TRC", rb";\$FILEVERSION=", _DECODE),
    ("candump log", rb"\(\d+\.\d+\) \w+ [0-9A-F]+#", _DECODE),
    ("imc FAMOS", rb"\|C[FK],\d", "export it as CSV from imc FAMOS"),
    ("DIAdem TDM", rb"(\xef\xbb\xbf)?<\?xml[^>]*>\s*<usi:tdm\b", "save it as TDMS from DIAdem"),
    ("SIE of HBM or nCode", rb".{8}\x51\xed\xa7\xa0", "export it as CSV or MDF 4"),
    ("Arrow or Feather", rb"ARROW1|FEA1", "write it as Parquet: pandas.read_feather(FILE).to_parquet(...)"),
    ("HDF5, not MAT 7.3", rb"\x89HDF\r\n\x1a\n", "write its channels as CSV or Parquet"),
    ("text of Octave", rb"# Created by Octave", "save it with save -7 (MAT 7)"),
    ("PDF", rb"%PDF-", "it is no measurement: name the file of the samples"),
)
"""Formats that are known but not read: the name, how its files begin, what to do. The first counts."""

_TEXT_SUFFIXES: Final = (".csv", ".txt", ".tsv", ".tab", ".prn", ".asc", ".dat", ".lvm")
_ENOUGH: Final = 256


def format_of(path: Path) -> str:
    """Return the format of a file: by how it begins, and for text by its suffix.

    Raises UnreadableError for a file of no known format, OSError for one that cannot be opened.
    """
    with path.open("rb") as file:
        beginning = file.read(_ENOUGH)
    if not beginning:
        raise UnreadableError("the file is empty")
    for name, pattern, remedy in _REFUSED:
        if re.match(pattern, beginning, re.DOTALL):
            raise UnreadableError(f"{name}: {remedy}")
    for name, file_format in FORMATS.items():
        if file_format.beginning and re.match(file_format.beginning, beginning, re.DOTALL):
            return name
    if path.suffix.lower() in _TEXT_SUFFIXES:
        return "csv"
    raise UnreadableError(
        "not a recording: known are Parquet, MDF, TDMS and MAT files (versions 4 to 7.3) and texts"
        f" ({', '.join(_TEXT_SUFFIXES)}); give a table of text one of these suffixes"
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

"""The formats that a sweep can be reported in: every module of `formats/` is one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from uictest.core import files
from uictest.report.sweep import formats
from uictest.report.sweep.content import SweepContent


@dataclass(frozen=True, slots=True)
class SweepFormat:
    """A format; a module of `formats/` registers its own under the name `FORMAT`.

    Args:
        write: writes a sweep into a folder and returns the files.

    """

    write: Callable[[Path, SweepContent], list[Path]]


def one_file(name: str, to_bytes: Callable[[SweepContent], bytes]) -> SweepFormat:
    """Return the format in which a sweep becomes one file of this name."""

    def write(folder: Path, content: SweepContent) -> list[Path]:
        files.write(folder, name, to_bytes(content))
        return [folder / name]

    return SweepFormat(write)


def write_sweep_formats(folder: Path, content: SweepContent, names: Iterable[str]) -> list[Path]:
    """Write a sweep in some formats into a folder, and return the files.

    Raises OSError, and ValueError where summary.parquet cannot be read.
    """
    return [path for name in names for path in _format_named(name).write(folder, content)]


def _format_named(name: str) -> SweepFormat:
    registered: SweepFormat = import_module(f"{formats.__name__}.{name}").FORMAT
    return registered

"""The formats that a run can be reported in: every module of `formats/` is one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Final

from uictest.core import files
from uictest.report import formats
from uictest.report.content import RunContent

IN_EVERY_RUN: Final = ("csv", "junit")
"""Formats that every run is written in."""


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """A format; a module of `formats/` registers its own under the name `FORMAT`.

    Args:
        files: returns the files of a run in this format, by name.
        draws_stops: whether it draws stops, so that a report needs their traces.

    """

    files: Callable[[RunContent], Mapping[str, bytes]]
    draws_stops: bool = False


def format_named(name: str) -> ReportFormat:
    """Return a format of `formats.format_names()`."""
    registered: ReportFormat = import_module(f"{formats.__name__}.{name}").FORMAT
    return registered


def draws_stops(names: Iterable[str]) -> bool:
    """Return whether any of these formats draws stops."""
    return any(format_named(name).draws_stops for name in names)


def write_formats(folder: Path, content: RunContent, names: Iterable[str]) -> list[Path]:
    """Write a run in some formats into a folder, and return the files. Raises OSError."""
    return [path for name in names for path in _write(folder, format_named(name).files(content))]


def _write(folder: Path, contents: Mapping[str, bytes]) -> list[Path]:
    for name, content in contents.items():
        files.write(folder, name, content)
    return [folder / name for name in contents]

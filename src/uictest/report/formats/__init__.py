"""The formats of reports of a run: one module each, called like the format and found by its name."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core import files

if TYPE_CHECKING:
    from uictest.report.content import RunContent

IN_EVERY_RUN: Final = ("csv", "junit")
"""Formats that every run is written in."""


class ReportFormat(NamedTuple):
    """A format; a module here registers its own under the name `FORMAT`.

    Args:
        files: returns the files of a run in this format, by name.
        draws_stops: whether it draws stops, so that a report needs their traces.

    """

    files: Callable[[RunContent], Mapping[str, bytes]]
    draws_stops: bool = False


@cache
def format_names() -> tuple[str, ...]:
    """Return the names of all formats, in alphabetical order. Loads none of them."""
    return tuple(sorted(module.name for module in pkgutil.iter_modules(__path__)))


def format_named(name: str) -> ReportFormat:
    """Return a format of `format_names()`."""
    registered: ReportFormat = import_module(f"{__name__}.{name}").FORMAT
    return registered


def draws_stops(names: Iterable[str]) -> bool:
    """Return whether any of these formats draws stops."""
    return any(format_named(name).draws_stops for name in names)


def write_formats(folder: Path, content: RunContent, names: Iterable[str]) -> list[Path]:
    """Write a run in some formats into a folder, and return the files. Raises OSError."""
    paths = []
    for name in names:
        for file, text in format_named(name).files(content).items():
            files.write(folder, file, text)
            paths.append(folder / file)
    return paths

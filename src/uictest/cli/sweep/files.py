"""Find the sweep files among paths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from uictest.plans import scenario


def is_sweep(path: Path) -> bool:
    """Return whether a path names a sweep file."""
    return path.name.endswith(scenario.SWEEP_SUFFIXES)


def sweep_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the sweep files among the paths, and those below folders that are not hidden."""
    for path in paths:
        if path.is_dir():
            below = sorted(path.rglob("*.sweep.y*ml"), key=Path.as_posix)
            yield from (each for each in below if is_sweep(each) and not _hidden(each.relative_to(path)))
        elif is_sweep(path):
            yield path


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)

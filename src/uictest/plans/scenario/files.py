"""The files that a load may read: those at or below the folders that the user named."""

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path, PureWindowsPath
from typing import Any, Self

from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    Map,
    Scalar,
    is_file,
    nearest,
    quoted,
    read_file,
    read_library,
    single_error,
    visible,
)


@dataclass(frozen=True, slots=True)
class Roots:
    """Folders, links resolved, at or below which every file must lie that is read by reference."""

    folders: tuple[Path, ...]

    @classmethod
    def of(cls, paths: Iterable[Path], trusted: Iterable[Path] = ()) -> Self:
        """The roots for files and folders that a user named, with the folders that are trusted besides."""
        named = (path if os.path.isdir(path) else path.parent for path in paths)  # noqa: PTH112 - never raises
        return cls(tuple(dict.fromkeys(map(real, (*named, Path.cwd(), *trusted)))))

    def with_folder(self, folder: Path) -> "Roots":
        """The roots and one more."""
        return Roots((*self.folders, real(folder)))

    def contain(self, path: Path) -> bool:
        """Whether a path, links resolved, lies at or below one of the roots."""
        return any(real(path).is_relative_to(folder) for folder in self.folders)

    def around(self, folder: Path) -> Path:
        """The outermost root that ``folder`` lies in, else the folder itself."""
        around = (root for root in self.folders if real(folder).is_relative_to(root))
        return min(around, key=lambda root: len(root.parts), default=real(folder))


def real(path: Path) -> Path:
    """The path with its links resolved, whether it exists or not."""
    return Path(os.path.realpath(path))


class Files:
    """The files of one load; each is read once."""

    def __init__(self, roots: Roots | None = None) -> None:
        self._read: dict[str, Any] = {}
        self.roots = Roots.of(()) if roots is None else roots

    def at(self, path: Path) -> Map:
        """The tree of the file at ``path``."""
        tree: Map = self.once(str(path), partial(read_file, path))
        return tree

    def in_library(self, folder: str, name: str) -> Map:
        """The tree of a library file."""
        return _in_library(folder, name)

    def beside(self, reference: Scalar, key: str) -> Map:
        """The tree of the file that a relative path names. Raises ScenarioErrors at the reference."""
        path = self.path_of(reference, key)
        if not is_file(path):
            hint = nearest_file(path, "paths start at the folder of the file that names them")
            raise single_error(reference.place, f"no such file: {quoted(reference.text)}", key, hint)
        return self.at(path)

    def path_of(self, reference: Scalar, key: str) -> Path:
        """The path that a relative path names, checked only for whether it may be read.

        Raises ScenarioErrors at a reference that leads out of the roots, itself or by a link. A path on the
        command line is an argument like any other: its folder becomes a root.
        """
        name = reference.text
        if Path(name).is_absolute() or PureWindowsPath(name).is_absolute():
            hint = "write it relative to the file that names it, so that it holds on every machine"
            raise single_error(reference.place, f"{quoted(name)} is an absolute path", key, hint)
        folder = reference.place.document.folder
        path = folder / name
        if reference.place.document.display == COMMAND_LINE:
            self.roots = self.roots.with_folder(path.parent)
        elif not self.roots.contain(path):
            message = f"{quoted(name)} leads out of {visible(str(self.roots.around(folder)))}"
            raise single_error(reference.place, message, key, trust_hint(path))
        return path

    def once(self, name: str, read: Callable[[], Any]) -> Any:
        """What ``read`` returns the first time; the same for this name ever after."""
        if name not in self._read:
            self._read[name] = read()
        return self._read[name]


_in_library = cache(read_library)
"""The tree of a library file, read once by a process: the library does not change."""


def trust_hint(path: Path) -> str:
    """The hint for a file outside the roots."""
    folder = visible(str(real(path).parent))
    return (
        f"add --trust {folder}, or UICTEST_TRUST={folder} to the environment;"
        " without it only the working folder and those of the files given are read"
    )


def nearest_file(path: Path, otherwise: str) -> str:
    """The hint for a file that is missing: one beside it with nearly its name, or what else to do."""
    try:
        guess = nearest(path.name, (each.name for each in path.parent.iterdir()))
    except (OSError, ValueError):
        return otherwise
    return f"did you mean {quoted(guess)}?" if guess else otherwise

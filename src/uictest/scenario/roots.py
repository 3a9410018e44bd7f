"""Where references may lead: the folders of the files named, the working folder and trusted folders."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Self


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
    """The path with its links resolved, whether there is anything or not."""
    return Path(os.path.realpath(path))

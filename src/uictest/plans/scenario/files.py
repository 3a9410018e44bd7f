"""The files that a load may read, at or below the folders that the user named; and which are scenarios."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, partial
from pathlib import Path, PureWindowsPath
from typing import Any, Final, NamedTuple, Self

from uictest.plans import library
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    Diagnostic,
    Map,
    Scalar,
    ScenarioErrors,
    collecting,
    diagnose,
    is_file,
    nearest,
    quoted,
    read_file,
    read_library,
    single_error,
    unreadable_error,
    visible,
    whole_file,
)


class Roots(NamedTuple):
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

    def scenario_beside(self, reference: Scalar, key: str) -> Path:
        """The scenario that a reference names: a file, else one that ships. Raises ScenarioErrors there."""
        path = self.path_of(reference, key)
        shipped = library.scenarios().get(reference.text)
        if shipped is None or is_file(path):
            self.beside(reference, key)
            return path
        self.roots = self.roots.with_folder(shipped.parent)
        return shipped

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
        guess = nearest(path.name, (each.name for each in path.parent.iterdir() if each.is_file()))
    except (OSError, ValueError):
        return otherwise
    return f"did you mean {quoted(guess)}?" if guess else otherwise


SWEEP_SUFFIXES: Final = (".sweep.yaml", ".sweep.yml")
SERIES_SUFFIXES: Final = (".series.yaml", ".series.yml")
_OTHER_KINDS: Final = (*library.FOLDERS.values(), "bench", "channel-map", "validation")
_OTHER_SCHEMAS: Final = frozenset(f"uictest/{kind}/1" for kind in _OTHER_KINDS)
"""Schemas of files that may lie among scenarios and are none: parts, benches, channel maps, validations."""


def scenario_trees(
    paths: Sequence[Path], files: Files, diagnostics: list[Diagnostic]
) -> Iterator[tuple[Path, Map]]:
    """Yield the tree of every scenario file at or below ``paths``, once and in order; append errors.

    A folder is searched for ``*.yaml`` and ``*.yml``, except sweeps (``*.sweep.yaml``), series
    (``*.series.yaml``), parts, bench recipes, channel maps, validations, hidden files, and files that
    begin with an underscore (parents only). A file that is named explicitly is always read.
    """
    seen: set[str] = set()
    for given in paths:
        named = not os.path.isdir(given)  # noqa: PTH112 - Path.is_dir raises for names that are too long
        for path in [given] if named else _below(given, diagnostics):
            key = os.path.abspath(path)  # noqa: PTH100 - one file under two spellings, links left alone
            if key in seen:
                continue
            seen.add(key)
            if not named and not files.roots.contain(path):
                diagnostics.append(link_outside(path))
                continue
            tree = None
            with collecting(diagnostics, whole_file(path)):
                try:
                    tree = files.at(path)
                except ScenarioErrors as errors:
                    tree = errors.salvaged if isinstance(errors.salvaged, Map) else None
                    raise
            schema = None if tree is None else tree.get("schema")
            is_other = isinstance(schema, Scalar) and schema.value in _OTHER_SCHEMAS
            if tree is not None and (named or not is_other):
                yield path, tree


def link_outside(path: Path) -> Diagnostic:
    """The error of a file in a given folder that is a link to a place outside: it is not read."""
    return diagnose(whole_file(path), "a link that leads out of the folders given", hint=trust_hint(path))


def _below(folder: Path, diagnostics: list[Diagnostic]) -> list[Path]:
    def report(error: OSError) -> None:
        diagnostics.extend(unreadable_error(whole_file(Path(error.filename or folder)), error).diagnostics)

    inside: list[Path] = []
    for parent, folders, names in os.walk(folder, onerror=report):
        folders[:] = [name for name in folders if not name.startswith(".")]
        inside.extend(Path(parent, name) for name in names if _may_be_scenario(name))
    return sorted(inside, key=Path.as_posix)


def _may_be_scenario(name: str) -> bool:
    """Whether a file of this name in a folder is taken for a scenario, unless its schema is another."""
    return (
        name.endswith((".yaml", ".yml"))
        and not name.startswith((".", "_"))
        and not name.endswith((*SWEEP_SUFFIXES, *SERIES_SUFFIXES))
    )

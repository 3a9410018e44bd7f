"""References to parts: a library name, a relative path, or an inline mapping that may extend either."""

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, Final, Self

from uictest import library
from uictest.scenario.yaml import (
    COMMAND_LINE,
    LIBRARY,
    Document,
    Key,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    describe,
    dotted,
    inherit,
    is_file,
    models_in,
    nearest,
    plain,
    quoted,
    read_file,
    read_library,
    single_error,
    suggestion,
    validated,
    visible,
)

KIND_OF_FOLDER: Final = {
    "brakes": "brake",
    "calipers": "caliper",
    "compensations": "compensation",
    "controllers": "controller",
    "criteria": "criteria",
    "measures": "measures",
    "pads": "pad",
    "rails": "rail",
    "sensors": "sensors",
    "vehicles": "vehicle",
}


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


@dataclass(frozen=True, slots=True)
class ResolvedPart:
    """A part and the documents it was made of."""

    part: Any
    documents: tuple[Document, ...]


class Files:
    """The files of one load; each is read once."""

    def __init__(self, roots: Roots | None = None) -> None:
        self._trees: dict[str, Map] = {}
        self.roots = Roots.of(()) if roots is None else roots

    def at(self, path: Path) -> Map:
        """The tree of the file at ``path``."""
        return self._once(str(path), partial(read_file, path))

    def in_library(self, folder: str, name: str) -> Map:
        """The tree of a library file."""
        return self._once(f"library:{folder}/{name}", partial(read_library, folder, name))

    def beside(self, reference: Scalar, key: str) -> Map:
        """The tree of the file that a relative path names. Raises ScenarioErrors at the reference."""
        path = self.path_of(reference, key)
        if not is_file(path):
            raise single_error(
                reference.place, f"no such file: {quoted(reference.text)}", key, _nearest_file(path)
            )
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

    def _once(self, name: str, read: Callable[[], Map]) -> Map:
        if name not in self._trees:
            self._trees[name] = read()
        return self._trees[name]


def trust_hint(path: Path) -> str:
    """The hint for a file outside the roots."""
    folder = visible(str(real(path).parent))
    return f"add --trust {folder}; without it only the working folder and those of the files given are read"


def _nearest_file(path: Path) -> str:
    try:
        guess = nearest(path.name, (each.name for each in path.parent.iterdir()))
    except (OSError, ValueError):
        return "paths start at the folder of the file that names them"
    return (
        f"did you mean {quoted(guess)}?" if guess else "paths start at the folder of the file that names them"
    )


class Parts:
    """Resolves references to parts; a part that is referred to again is not read again."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._by_name: dict[tuple[str, str], ResolvedPart] = {}
        # Keyed by identity; keeping the node keeps its identity unique.
        self._inline: dict[int, tuple[Node, ResolvedPart]] = {}
        self._originals: dict[int, tuple[Map, Any]] = {}

    def resolve(self, node: Node, model: Any, key: Key) -> ResolvedPart:
        """The part of type ``model`` that ``node`` at ``key`` stands for. Raises ScenarioErrors."""
        full_key = dotted(key)
        if isinstance(node, Map):
            return self._resolve_inline(node, model, key)
        if not isinstance(node, Scalar) or not isinstance(node.value, str):
            message = f"expected a library name, a relative path or a mapping, found {describe(node)}"
            raise single_error(node.place, message, full_key)
        if is_path(node.text):
            return self._built(self._fetch(node, model, full_key), model, (), full_key)
        name = (folder_of(model), node.text)
        if name not in self._by_name:
            self._by_name[name] = self._built(self._fetch(node, model, full_key), model, (), full_key)
        return self._by_name[name]

    def _resolve_inline(self, node: Map, model: Any, key: Key) -> ResolvedPart:
        if id(node) not in self._inline:
            self._inline[id(node)] = (node, self._built(node, model, key, dotted(key)))
        return self._inline[id(node)][1]

    def _built(self, tree: Map, model: Any, key: Key, full_key: str) -> ResolvedPart:
        generations = [tree]

        def fetch(reference: Scalar) -> Map:
            generations.append(
                self._fetch(reference, model, f"{full_key}.extends" if full_key else "extends")
            )
            return generations[-1]

        merged, documents = inherit(tree, fetch, _reject_changed_sources)
        part = validated(model, plain(merged), merged, key)
        return ResolvedPart(self._with_origin(part, generations, model), documents)

    def _with_origin(self, part: Any, generations: Sequence[Map], model: Any) -> Any:
        """Return a part that knows the library part it names or extends, else the file at the root."""
        for tree in generations:
            display = tree.place.document.display
            if display.startswith(LIBRARY):
                original = part if tree is generations[0] else self._built(tree, model, (), "").part
                return part.with_origin(PurePosixPath(display).stem, original)
        root = generations[-1]
        if root is generations[0]:
            return part
        return part.with_origin(PurePosixPath(root.place.document.display).name, self._original(root, model))

    def _original(self, root: Map, model: Any) -> Any:
        """The part that a file at the root of `extends` describes; None where it is not a whole part."""
        if id(root) not in self._originals:
            try:
                original = validated(model, plain(root), root)
            except ScenarioErrors:
                original = None
            self._originals[id(root)] = (root, original)
        return self._originals[id(root)][1]

    def _fetch(self, reference: Scalar, model: Any, full_key: str) -> Map:
        folder = folder_of(model)
        if is_path(reference.text):
            tree = self._files.beside(reference, full_key)
        else:
            _require_known_name(reference, folder, full_key)
            tree = self._files.in_library(folder, reference.text)
        _require_schema(tree, f"uictest/{KIND_OF_FOLDER[folder]}/1")
        return tree


def folder_of(model: Any) -> str:
    """The folder of the library that holds parts of this type."""
    folder: str = models_in(model)[0].folder
    return folder


def is_path(reference: str) -> bool:
    """Whether a reference is a path rather than a library name."""
    return reference.endswith((".yaml", ".yml"))


def _require_known_name(reference: Scalar, folder: str, full_key: str) -> None:
    if reference.text in library.names(folder):
        return
    hint = suggestion(reference.text, library.names(folder))
    if "/" in reference.text or "\\" in reference.text:
        hint = "a path ends in .yaml; " + hint
    raise single_error(
        reference.place,
        f"no {KIND_OF_FOLDER[folder]} {quoted(reference.text)} in the library",
        full_key,
        hint,
    )


def _require_schema(tree: Map, expected: str) -> None:
    schema = tree.get("schema")
    if schema is None:
        raise single_error(tree.place, "missing key 'schema'", "schema", f"write `schema: {expected}`")
    if not isinstance(schema, Scalar) or schema.value != expected:
        schema_text = quoted(schema.text) if isinstance(schema, Scalar) else describe(schema)
        raise single_error(schema.place, f"expected {expected}, found {schema_text}", "schema")


def _reject_changed_sources(parent: Map, merged: Map) -> None:
    """Raise ScenarioErrors where a part describes a source anew that its parent's numbers refer to."""
    inherited, own = parent.get("sources"), merged.get("sources")
    if not isinstance(inherited, Map) or not isinstance(own, Map):
        return
    for name, entry in inherited.entries.items():
        changed = own.entries[name]
        if plain(changed.node) != plain(entry.node):
            raise single_error(
                changed.key,
                f"source {quoted(name)} describes numbers of the part that this one extends",
                f"sources.{name}",
                "give your source another name: inherited numbers keep theirs",
            )

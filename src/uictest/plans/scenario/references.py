"""References to parts: a library name, a relative path, or an inline mapping that may extend either."""

from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Any, Final, NamedTuple

from uictest.controllers import installed_names
from uictest.plans import library
from uictest.plans.scenario.declared_parameters import with_declared_parameters
from uictest.plans.scenario.files import Files
from uictest.plans.scenario.parts.external_controller import ExternalController, PythonController
from uictest.plans.scenario.program_files import mapping_for, program_files, version_stated_for
from uictest.plans.scenario.python_class import require_class
from uictest.plans.scenario.yaml import (
    LIBRARY,
    Document,
    Entry,
    Key,
    Map,
    Node,
    Place,
    Scalar,
    ScenarioErrors,
    describe,
    dotted,
    inherit,
    models_in,
    plain,
    quoted,
    require_schema,
    single_error,
    suggestion,
    validated,
)

_CONTROLLERS: Final = "controllers"


class ResolvedPart(NamedTuple):
    """A part and the documents it was made of."""

    part: Any
    documents: tuple[Document, ...]


_LIBRARY_PARTS: Final[dict[tuple[str, str], ResolvedPart]] = {}
"""Folder and name of a part of the library -> the part, made once by a process."""


class Parts:
    """Resolves references to parts; a part that is referred to again is not read again."""

    def __init__(self, files: Files) -> None:
        self.files = files
        self._by_name: dict[tuple[str, str], ResolvedPart] = {}
        # Keyed by identity; keeping the node keeps its identity unique.
        self._inline: dict[int, tuple[Node, ResolvedPart]] = {}
        self._originals: dict[int, tuple[Map, Any]] = {}

    def part(self, node: Node, model: Any, key: Key) -> ResolvedPart:
        """The part of type ``model`` that ``node`` at ``key`` stands for. Raises ScenarioErrors."""
        full_key = dotted(key)
        if isinstance(node, Map):
            if id(node) not in self._inline:
                self._inline[id(node)] = (node, self._built(node, model, key, full_key))
            return self._inline[id(node)][1]
        if not isinstance(node, Scalar) or not isinstance(node.value, str):
            message = f"expected a library name, a relative path or a mapping, found {describe(node)}"
            raise single_error(node.place, message, full_key)
        if is_path(node.text):
            return self._built(self._fetch(node, model, full_key), model, (), full_key)
        name = (folder_of(model), node.text)
        known = _LIBRARY_PARTS if node.text in library.names(name[0]) else self._by_name
        if name not in known:
            known[name] = self._built(self._fetch(node, model, full_key), model, (), full_key)
        return known[name]

    def _built(self, tree: Map, model: Any, key: Key, full_key: str) -> ResolvedPart:
        generations = [tree]

        def fetch(reference: Scalar) -> Map:
            generations.append(
                self._fetch(reference, model, f"{full_key}.extends" if full_key else "extends")
            )
            return generations[-1]

        merged, documents = inherit(tree, fetch=fetch, check=_reject_changed_sources)
        part, programs = self._validated(merged, model, key)
        return ResolvedPart(self._with_origin(part, generations, model), (*documents, *programs))

    def _validated(self, tree: Map, model: Any, key: Key) -> tuple[Any, tuple[Document, ...]]:
        """The part that a tree describes, and the files of the programs that it names."""
        if folder_of(model) != "controllers":
            return validated(model, plain(tree), tree, key), ()
        programs = program_files(tree, self.files, dotted(key))
        version = version_stated_for(tree, programs.values())
        stated = {"version": version} if version else {}
        part = validated(model, {**stated, **plain(tree), **programs}, tree, key)
        if isinstance(part, PythonController):
            require_class(part, tree, self.files, key)
        if isinstance(part, ExternalController):
            part = with_declared_parameters(part, tree, self.files, key)
        return part, tuple(file.document for file in programs.values())

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
                original, _ = self._validated(root, model, ())
            except ScenarioErrors:
                original = None
            self._originals[id(root)] = (root, original)
        return self._originals[id(root)][1]

    def _fetch(self, reference: Scalar, model: Any, full_key: str) -> Map:
        folder = folder_of(model)
        if is_path(reference.text):
            tree = self.files.beside(reference, full_key)
        elif reference.text in library.names(folder):
            tree = self.files.in_library(folder, reference.text)
        elif folder == _CONTROLLERS and reference.text in installed_names():
            return _registered(reference)
        else:
            raise _unknown_name(reference, folder, full_key)
        require_schema(tree, f"uictest/{library.FOLDERS[folder]}/1")
        return tree


def folder_of(model: Any) -> str:
    """The folder of the library that holds parts of this type."""
    folder: str = models_in(model)[0].folder
    return folder


def is_path(reference: str) -> bool:
    """Whether a reference is a path rather than a library name."""
    return reference.endswith((".yaml", ".yml"))


def _registered(reference: Scalar) -> Map:
    """Return the controller of an installed package as a part; the package is not imported."""
    name = reference.text
    place = Place(Document(f"installed:{name}", reference.place.document.folder, ""))
    texts = {"schema": "uictest/controller/1", "registered": name}
    return Map({key: Entry(place, Scalar(text, text, place)) for key, text in texts.items()}, place)


def _unknown_name(reference: Scalar, folder: str, full_key: str) -> ScenarioErrors:
    installed = installed_names() if folder == _CONTROLLERS else ()
    hint = suggestion(reference.text, (*library.names(folder), *installed))
    if folder == _CONTROLLERS and (mapping := mapping_for(reference.text)):
        hint = f"write `{mapping}`"
    elif "/" in reference.text or "\\" in reference.text:
        hint = "a path ends in .yaml; " + hint
    message = f"no {library.FOLDERS[folder]} {quoted(reference.text)} in the library"
    return single_error(reference.place, message, full_key, hint)


def _reject_changed_sources(parent: Map, merged: Map) -> None:
    """Raise ScenarioErrors where a part describes a source anew that its parent's numbers refer to."""
    inherited, own = parent.get("sources"), merged.get("sources")
    if not isinstance(inherited, Map) or not isinstance(own, Map):
        return
    for name, entry in inherited.entries.items():
        changed = own.entries.get(name)  # where none is left, the numbers that need it have no source
        if changed is not None and plain(changed.node) != plain(entry.node):
            raise single_error(
                changed.key,
                f"source {quoted(name)} describes numbers of the part that this one extends",
                f"sources.{name}",
                "give your source another name: inherited numbers keep theirs",
            )

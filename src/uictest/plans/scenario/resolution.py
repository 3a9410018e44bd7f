"""From the tree of one case to its scenario: references replaced by parts, everything validated.

A reference is a library name, a relative path, or an inline mapping that may extend either.
"""

import json
from collections.abc import Iterator, Sequence
from functools import reduce
from operator import getitem
from pathlib import Path, PurePosixPath
from typing import Any, Final, NamedTuple

from uictest.controllers import installed_names
from uictest.core.envelope import OLD, RESULT, is_of, is_old
from uictest.plans import library
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.controller import ExternalController, PythonController
from uictest.plans.scenario.programs import (
    mapping_for,
    program_files,
    require_class,
    version_stated_for,
    with_declared_parameters,
)
from uictest.plans.scenario.yaml import (
    LIBRARY,
    Diagnostic,
    Document,
    Entry,
    Files,
    Key,
    List,
    Location,
    Map,
    Node,
    Part,
    PartReference,
    Quantity,
    Scalar,
    ScenarioErrors,
    Source,
    describe,
    dotted,
    inherit,
    is_file,
    models_in,
    nearest_file,
    plain,
    quantities_in,
    quoted,
    read_document,
    read_each,
    read_library,
    require_none,
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
                self._inline[id(node)] = (node, self._built_part(node, model, key, full_key))
            return self._inline[id(node)][1]
        if not isinstance(node, Scalar) or not isinstance(node.value, str):
            message = f"expected a library name, a relative path or a mapping, found {describe(node)}"
            raise single_error(node.location, message, full_key)
        if is_path(node.text):
            return self._built_part(self._fetch(node, model, full_key), model, (), full_key)
        name = (folder_of(model), node.text)
        known = _LIBRARY_PARTS if node.text in library.names(name[0]) else self._by_name
        if name not in known:
            known[name] = self._built_part(self._fetch(node, model, full_key), model, (), full_key)
        return known[name]

    def _built_part(self, tree: Map, model: Any, key: Key, full_key: str) -> ResolvedPart:
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
            display = tree.location.document.display
            if display.startswith(LIBRARY):
                original = part if tree is generations[0] else self._built_part(tree, model, (), "").part
                return part.with_origin(PurePosixPath(display).stem, original)
        root = generations[-1]
        if root is generations[0]:
            return part
        return part.with_origin(
            PurePosixPath(root.location.document.display).name, self._original(root, model)
        )

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
            tree = read_library(folder, reference.text)
        elif folder == _CONTROLLERS and reference.text in installed_names():
            return _registered_reference(reference)
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


def _registered_reference(reference: Scalar) -> Map:
    name = reference.text
    location = Location(Document(f"installed:{name}", reference.location.document.folder, ""))
    texts = {"schema": "uictest/controller/1", "registered": name}
    return Map({key: Entry(location, Scalar(text, text, location)) for key, text in texts.items()}, location)


def _unknown_name(reference: Scalar, folder: str, full_key: str) -> ScenarioErrors:
    installed = installed_names() if folder == _CONTROLLERS else ()
    hint = suggestion(reference.text, (*library.names(folder), *installed))
    if folder == _CONTROLLERS and (mapping := mapping_for(reference.text)):
        hint = f"write `{mapping}`"
    elif "/" in reference.text or "\\" in reference.text:
        hint = "a path ends in .yaml; " + hint
    message = f"no {library.FOLDERS[folder]} {quoted(reference.text)} in the library"
    return single_error(reference.location, message, full_key, hint)


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


def _references_of_model(model: Any, above: Key = ()) -> Iterator[tuple[Key, PartReference]]:
    for name, field in model.model_fields.items():
        marks = [mark for mark in field.metadata if isinstance(mark, PartReference)]
        if marks:
            yield (*above, name), marks[0]
            continue
        for inner in models_in(field.annotation):
            yield from _references_of_model(inner, (*above, name))


PART_KEYS: Final = dict(_references_of_model(Scenario))
"""Every key that refers to a part (or, for criteria, to several)."""
DOTTED_PART_KEYS: Final = frozenset(map(dotted, PART_KEYS))
"""The same, as a file of a sweep or an option writes them."""
PART_KINDS: Final = {key: library.FOLDERS[folder_of(reference.model)] for key, reference in PART_KEYS.items()}
"""The kind of part that each of these keys refers to, such as `brake`."""


def with_default_parts(tree: Map) -> Map:
    """The scenario's tree with the default in place of every missing reference."""
    for key, reference in PART_KEYS.items():
        tree = _with_default(tree, key, reference.default)
    return tree


def _with_default(tree: Map, key: Key, default: str) -> Map:
    first, rest = str(key[0]), key[1:]
    entry = tree.entries.get(first)
    if not rest:
        named = Entry(tree.location, Scalar(default, default, tree.location))
        return tree if entry is not None else tree.with_entry(first, named)
    inner: Node = Map({}, tree.location) if entry is None else entry.node
    if not isinstance(inner, Map):
        return tree
    location = tree.location if entry is None else entry.key
    return tree.with_entry(first, Entry(location, _with_default(inner, rest, default)))


class SourcedNumber(NamedTuple):
    """A number of a part: its dotted key, the quantity and its source (None for a user's own number)."""

    key: str
    quantity: Quantity
    source: Source | None


def numbers(part: Part) -> Iterator[SourcedNumber]:
    """Yield every number of a part, in the order of its model."""
    for key, quantity in quantities_in(part):
        yield SourcedNumber(dotted(key), quantity, part.sources.get(quantity.source))


_VALIDATION_KEY: Final = "validated"
LARGEST: Final = 64 * 1024 * 1024
"""Largest file that is read, bytes: it holds every figure of every recorded stop."""
_HINT: Final = "name the validation.json that `uictest validate` wrote"


def _with_validation_path(data: dict[str, Any], tree: Map, files: Files) -> None:
    """Put the path of the validation, if a scenario names one, in the place of what it wrote.

    Raises ScenarioErrors for a file that is missing, lies outside the roots, or holds something else.
    """
    node = tree.get(_VALIDATION_KEY)
    if not isinstance(node, Scalar) or not isinstance(node.value, str):
        return
    path = files.path_of(node, _VALIDATION_KEY)
    if not is_file(path):
        raise single_error(
            node.location, f"no such file: {quoted(node.text)}", _VALIDATION_KEY, nearest_file(path, _HINT)
        )
    if reason := files.once(f"{_VALIDATION_KEY}:{path}", lambda: _why_no_validation(path)):
        raise single_error(node.location, f"{quoted(node.text)} is {reason}", _VALIDATION_KEY, _HINT)
    data[_VALIDATION_KEY] = str(path)


def _why_no_validation(path: Path) -> str:
    """Kind of a file that is not the result of a validation; empty for one that is."""
    other = "not the result of a validation"
    try:
        form = json.loads(read_document(path, LARGEST, _HINT).text)
    except (ValueError, RecursionError):
        return other
    if isinstance(form, dict) and is_old(form):
        return OLD
    return "" if is_of(form, RESULT, "validation") and form.get("domains") else other


def resolve(tree: Map, parts: Parts) -> tuple[Scenario, tuple[Document, ...]]:
    """The scenario and the documents its parts came from.

    Raises ScenarioErrors; errors in parts and errors in the scenario do not hide each other.
    """
    data: dict[str, Any] = plain(tree)
    diagnostics: list[Diagnostic] = []
    failed: set[str] = set()
    documents: list[Document] = []
    for key in PART_KEYS:
        *above, last = map(str, key)
        if (node := tree.at(*above, last)) is None:
            continue
        mapping = reduce(getitem, above, data)
        try:
            mapping[last] = _resolved_part(parts, key, node, documents)
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
            failed.add(dotted(key))
            del mapping[last]
    try:
        _with_validation_path(data, tree, parts.files)
    except ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    try:
        scenario = validated(Scenario, data, tree)
    except ScenarioErrors as errors:
        diagnostics.extend(each for each in errors.diagnostics if each.key not in failed)
    require_none(diagnostics)
    return scenario, tuple(documents)


def _resolved_part(parts: Parts, key: Key, node: Node, documents: list[Document]) -> Any:
    reference = PART_KEYS[key]
    nodes = node.items if reference.several and isinstance(node, List) else (node,)
    if not nodes:
        raise single_error(node.location, "an empty list", dotted(key), "name at least one")
    listed = nodes[0] is not node
    resolved = read_each(
        lambda item: parts.part(item[1], reference.model, (*key, item[0]) if listed else key),
        enumerate(nodes),
    )
    documents.extend(document for each in resolved for document in each.documents)
    return tuple(each.part for each in resolved) if reference.several else resolved[0].part

"""From the tree of one case to its scenario: references replaced by parts, everything validated."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core.document import RESULT, is_of
from uictest.plans import library
from uictest.plans.scenario.files import Files, Roots, nearest_file
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.references import Parts, ResolvedPart, folder_of
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Key,
    Map,
    Node,
    Part,
    PartReference,
    Place,
    Quantity,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    Source,
    dotted,
    is_file,
    models_in,
    plain,
    quantities_in,
    quoted,
    read_document,
    single_error,
    validated,
)


def _references(model: Any, above: Key = ()) -> Iterator[tuple[Key, PartReference]]:
    for name, field in model.model_fields.items():
        marks = [mark for mark in field.metadata if isinstance(mark, PartReference)]
        if marks:
            yield (*above, name), marks[0]
            continue
        for inner in models_in(field.annotation):
            yield from _references(inner, (*above, name))


PART_KEYS: Final = dict(_references(Scenario))
"""Every key that refers to a part (or, for criteria, to several)."""

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
        return (
            tree if entry is not None else tree.with_entry(first, Entry(tree.place, _scalar(default, tree)))
        )
    inner: Node = Map({}, tree.place) if entry is None else entry.node
    if not isinstance(inner, Map):
        return tree
    place = tree.place if entry is None else entry.key
    return tree.with_entry(first, Entry(place, _with_default(inner, rest, default)))


def _scalar(text: str, tree: Map) -> Scalar:
    return Scalar(text, text, tree.place)


def part_nodes(tree: Map) -> Iterator[tuple[Key, Node]]:
    """Yield every reference to a part that stands in a tree, with its key."""
    for key in PART_KEYS:
        node: Node | None = tree
        for element in key:
            node = node.get(str(element)) if isinstance(node, Map) else None
        if node is not None:
            yield key, node


class SourcedNumber(NamedTuple):
    """A number of a part: its dotted key, the quantity and its source (None for a user's own number)."""

    key: str
    quantity: Quantity
    source: Source | None


def load_part_file(path: Path, trusted: Sequence[Path] = ()) -> Part:
    """The part that a file describes, of any kind.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    files = Files(Roots.of([path], trusted))
    tree = files.at(path)
    schema = tree.get("schema")
    models = {f"uictest/{kind}/1": PART_KEYS[key].model for key, kind in PART_KINDS.items()}
    if not isinstance(schema, Scalar) or schema.text not in models:
        schema_text = quoted(schema.text) if isinstance(schema, Scalar) else "none"
        place = tree.place if schema is None else schema.place
        raise single_error(
            place, f"not a part: its schema is {schema_text}", "schema", f"accepted: {', '.join(models)}"
        )
    name = Scalar(path.name, path.name, Place(Document(str(path), path.parent, path.name)))
    part: Part = Parts(files).resolve(name, models[schema.text], ()).part
    return part


def load_part(reference: str) -> Part:
    """The library part called ``folder/name``, e.g. ``vehicles/intercity-180``.

    Raises ScenarioErrors when there is none, KeyError when there is no such folder.
    """
    folder, _, name = reference.partition("/")
    models = {folder_of(each.model): each.model for each in PART_KEYS.values()}
    if folder not in models:
        raise KeyError(folder)
    place = Place(Document(reference, Path(), reference), 1, len(folder) + 2)
    part: Part = Parts(Files()).resolve(Scalar(name, name, place), models[folder], (folder,)).part
    return part


def numbers(part: Part) -> Iterator[SourcedNumber]:
    """Yield every number of a part, in the order of its model."""
    for key, quantity in quantities_in(part):
        yield SourcedNumber(dotted(key), quantity, part.sources.get(quantity.source))


VALIDATED: Final = "validated"
"""The key of a scenario."""
LARGEST: Final = 64 * 1024 * 1024
"""Largest file that is read, bytes: it holds every figure of every recorded stop."""
_HINT: Final = "name the validation.json that `uictest validate` wrote"


def validated_file(node: Node, files: Files) -> str | None:
    """Return the path of the validation that a scenario names; None where this is no text.

    Raises ScenarioErrors for a file that is missing, lies outside the roots, or holds something else.
    """
    if not isinstance(node, Scalar) or not isinstance(node.value, str):
        return None
    path = files.path_of(node, VALIDATED)
    if not is_file(path):
        raise single_error(
            node.place, f"no such file: {quoted(node.text)}", VALIDATED, nearest_file(path, _HINT)
        )
    if not files.once(f"{VALIDATED}:{path}", lambda: _is_validation(path)):
        raise single_error(
            node.place, f"{quoted(node.text)} is not the result of a validation", VALIDATED, _HINT
        )
    return str(path)


def with_validated_file(data: dict[str, Any], tree: Map, files: Files) -> None:
    """Put the path of the validation, if a scenario names one, in the place of what it wrote."""
    node = tree.get(VALIDATED)
    path = None if node is None else validated_file(node, files)
    if path is not None:
        data[VALIDATED] = path


def _is_validation(path: Path) -> bool:
    try:
        form = json.loads(read_document(path, LARGEST, _HINT).text)
    except (ValueError, RecursionError):
        return False
    return is_of(form, RESULT, "validation") and bool(form.get("domains"))


def resolve(tree: Map, parts: Parts) -> tuple[Scenario, tuple[Document, ...]]:
    """The scenario and the documents its parts came from.

    Raises ScenarioErrors; errors in parts and errors in the scenario do not hide each other.
    """
    data: dict[str, Any] = plain(tree)
    diagnostics: list[Diagnostic] = []
    failed: set[str] = set()
    documents: list[Document] = []
    for key, node in part_nodes(tree):
        try:
            _put(data, key, _part(parts, key, node, documents))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
            failed.add(dotted(key))
            _remove(data, key)
    try:
        with_validated_file(data, tree, parts.files)
    except ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    try:
        scenario = validated(Scenario, data, tree)
    except ScenarioErrors as errors:
        diagnostics.extend(each for each in errors.diagnostics if each.key not in failed)
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return scenario, tuple(documents)


def _part(parts: Parts, key: Key, node: Node, documents: list[Document]) -> Any:
    """The part, or the tuple of parts, that stands at ``key``."""
    reference = PART_KEYS[key]
    nodes = node.items if reference.several and isinstance(node, List) else (node,)
    if not nodes:
        raise single_error(node.place, "an empty list", dotted(key), "name at least one")
    listed = nodes[0] is not node
    resolved = _resolved_parts(parts, reference.model, key, nodes, listed=listed)
    documents.extend(document for each in resolved for document in each.documents)
    return tuple(each.part for each in resolved) if reference.several else resolved[0].part


def _resolved_parts(
    parts: Parts, model: Any, key: Key, nodes: Sequence[Node], *, listed: bool
) -> list[ResolvedPart]:
    """Resolve every reference, or raise the errors of all of them."""
    resolved: list[ResolvedPart] = []
    diagnostics: list[Diagnostic] = []
    for number, node in enumerate(nodes):
        try:
            resolved.append(parts.resolve(node, model, (*key, number) if listed else key))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return resolved


def _put(data: dict[str, Any], key: Key, part: Any) -> None:
    _mapping_of(data, key)[str(key[-1])] = part


def _remove(data: dict[str, Any], key: Key) -> None:
    del _mapping_of(data, key)[str(key[-1])]


def _mapping_of(data: dict[str, Any], key: Key) -> dict[str, Any]:
    for element in key[:-1]:
        data = data[str(element)]
    return data

"""From the tree of one case to its scenario: references replaced by parts, everything validated."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core.envelope import OLD, RESULT, is_of, is_old
from uictest.plans import library
from uictest.plans.scenario.files import Files, nearest_file
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
        named = Entry(tree.place, Scalar(default, default, tree.place))
        return tree if entry is not None else tree.with_entry(first, named)
    inner: Node = Map({}, tree.place) if entry is None else entry.node
    if not isinstance(inner, Map):
        return tree
    place = tree.place if entry is None else entry.key
    return tree.with_entry(first, Entry(place, _with_default(inner, rest, default)))


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
            node.place, f"no such file: {quoted(node.text)}", _VALIDATION_KEY, nearest_file(path, _HINT)
        )
    if reason := files.once(f"{_VALIDATION_KEY}:{path}", lambda: _why_no_validation(path)):
        raise single_error(node.place, f"{quoted(node.text)} is {reason}", _VALIDATION_KEY, _HINT)
    data[_VALIDATION_KEY] = str(path)


def _why_no_validation(path: Path) -> str:
    """What a file is instead of the result of a validation; empty where it is one."""
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
        node: Node | None = tree
        mapping = data
        for element in map(str, key):
            node = node.get(element) if isinstance(node, Map) else None
        if node is None:
            continue
        for element in map(str, key[:-1]):
            mapping = mapping[element]
        try:
            mapping[str(key[-1])] = _part(parts, key, node, documents)
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
            failed.add(dotted(key))
            del mapping[str(key[-1])]
    try:
        _with_validation_path(data, tree, parts.files)
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
            resolved.append(parts.part(node, model, (*key, number) if listed else key))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return resolved

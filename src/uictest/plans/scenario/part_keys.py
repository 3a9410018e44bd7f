"""Where a scenario refers to parts."""

from collections.abc import Iterator
from typing import Any, Final

from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.references import KIND_OF_FOLDER, folder_of
from uictest.plans.scenario.yaml import Entry, Key, Map, Node, PartReference, Scalar, models_in


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

PART_KINDS: Final = {key: KIND_OF_FOLDER[folder_of(reference.model)] for key, reference in PART_KEYS.items()}
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

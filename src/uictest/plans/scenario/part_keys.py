"""Where a scenario refers to parts, and the parts of the library by name."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.plans.scenario.files import Files, Roots
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.references import KIND_OF_FOLDER, Parts, folder_of
from uictest.plans.scenario.yaml import (
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
    Source,
    dotted,
    models_in,
    quantities_in,
    quoted,
    single_error,
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

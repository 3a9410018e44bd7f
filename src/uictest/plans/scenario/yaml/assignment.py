"""Setting one dotted key of a scenario's tree."""

from typing import Final

from uictest.plans.scenario.yaml.diagnostics import single_error
from uictest.plans.scenario.yaml.tree import Entry, Map, Node, Place, Scalar, Sequence, describe, quoted

FIXED: Final = frozenset({"schema", "name", "extends", "matrix", "zip", "include", "exclude", "vary"})
"""Keys that belong to the file and not to a case."""


def with_value(tree: Map, key: str, value: Entry, part_keys: frozenset[str]) -> Map:
    """A copy of ``tree`` in which the dotted ``key`` has another value; a number names an entry of a list.

    A reference to a part on the way (one of ``part_keys``) becomes a mapping that extends what it named.
    Raises ScenarioErrors at the key of ``value``.
    """
    elements = key.split(".")
    if not all(elements):
        raise single_error(
            value.key, f"{quoted(key)} is not a key", hint="write names joined by dots: rail.friction"
        )
    if elements[0] in FIXED:
        raise single_error(
            value.key, f"{quoted(elements[0])} belongs to the file and cannot vary from case to case", key
        )
    return _assigned(tree, elements, value, "", part_keys)


def _assigned(tree: Map, elements: list[str], value: Entry, above: str, part_keys: frozenset[str]) -> Map:
    first, rest = elements[0], elements[1:]
    if not rest:
        return tree.with_entry(first, value)
    key, node = f"{above}{first}", tree.get(first)
    place = _key_place(tree, first, value)
    if isinstance(node, Sequence):
        return tree.with_entry(first, Entry(place, _assigned_in(node, rest, value, key, part_keys)))
    inner = _mapping(node, key, value.key, part_keys)
    return tree.with_entry(first, Entry(place, _assigned(inner, rest, value, f"{key}.", part_keys)))


def _assigned_in(
    listed: Sequence, elements: list[str], value: Entry, key: str, part_keys: frozenset[str]
) -> Sequence:
    """A copy of a list in which the entry that ``elements`` begins with has another value."""
    first, rest = elements[0], elements[1:]
    count = len(listed.items)
    if not first.isdecimal() or int(first) >= count:
        entries = {0: "no entries", 1: "one entry, 0"}.get(count, f"the entries 0 to {count - 1}")
        raise single_error(value.key, f"{quoted(key)} is a list of {entries}; {quoted(first)} is none", key)
    number, below = int(first), f"{key}.{first}"
    node = listed.items[number]
    if rest and isinstance(node, Sequence):
        node = _assigned_in(node, rest, value, below, part_keys)
    elif rest:
        node = _assigned(_mapping(node, below, value.key, part_keys), rest, value, f"{below}.", part_keys)
    else:
        node = value.node
    return Sequence((*listed.items[:number], node, *listed.items[number + 1 :]), listed.place)


def _key_place(tree: Map, name: str, value: Entry) -> Place:
    entry = tree.entries.get(name)
    return value.key if entry is None else entry.key


def _mapping(node: Node | None, key: str, place: Place, part_keys: frozenset[str]) -> Map:
    if node is None:
        return Map({}, place)
    if isinstance(node, Map):
        return node
    if isinstance(node, Scalar) and key in part_keys:
        return Map({"extends": Entry(node.place, node)}, place)
    raise single_error(place, f"{quoted(key)} is {describe(node)} and has no keys of its own", key)

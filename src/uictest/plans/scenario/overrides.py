"""Values at dotted keys: set in a tree, read from the command line, and checked for the rail's friction."""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import combinations
from pathlib import Path
from typing import Final, NamedTuple

from uictest.plans.scenario.expansion import EXPANSION_KEYS
from uictest.plans.scenario.resolution import DOTTED_PART_KEYS, PART_KEYS
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    DEEPEST,
    Diagnostic,
    Document,
    Entry,
    List,
    Location,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    as_written,
    common_unit,
    count_by_step,
    describe,
    diagnose,
    is_null,
    parse,
    parse_decimal_quantity,
    quantity_text,
    quoted,
    read_each,
    single_error,
    spaced_by_step,
    visible,
)

FIXED: Final = frozenset(
    {"schema", "name", "extends", "matrix", "zip", "include", "exclude", "vary", "search"}
)
"""Keys that belong to the file and not to a case."""
OF_CAR: Final = re.compile(r"^train\.\d+\.")
"""Before a key that a car of a train has of its own."""


def with_value(tree: Map, key: str, value: Entry) -> Map:
    """A copy of ``tree`` in which the dotted ``key`` has another value; a number names an entry of a list.

    A reference to a part on the way becomes a mapping that extends what it named.
    Raises ScenarioErrors at the key of ``value``.
    """
    elements = key.split(".")
    if not all(elements):
        raise single_error(
            value.key, f"{quoted(key)} is not a key", hint="write names joined by dots: rail.friction"
        )
    if len(elements) > DEEPEST:
        raise single_error(value.key, f"a key of {len(elements)} names; at most {DEEPEST} are accepted")
    if elements[0] in FIXED:
        raise single_error(
            value.key, f"{quoted(elements[0])} belongs to the file and cannot vary from case to case", key
        )
    return _with_assigned(tree, elements, value, "")


def _with_assigned(tree: Map, elements: list[str], value: Entry, above: str) -> Map:
    first, rest = elements[0], elements[1:]
    if not rest:
        return tree.with_entry(first, value)
    key, node = f"{above}{first}", tree.get(first)
    location = tree.entries[first].key if first in tree.entries else value.key
    if isinstance(node, List):
        return tree.with_entry(first, Entry(location, _assigned_in(node, rest, value, key)))
    inner = _mapping(node, key, value.key)
    return tree.with_entry(first, Entry(location, _with_assigned(inner, rest, value, f"{key}.")))


def _assigned_in(listed: List, elements: list[str], value: Entry, key: str) -> List:
    """A copy of a list in which the entry that ``elements`` begins with has another value."""
    first, rest = elements[0], elements[1:]
    count = len(listed.items)
    if not first.isdecimal() or int(first) >= count:
        entries = {0: "no entries", 1: "one entry, 0"}.get(count, f"the entries 0 to {count - 1}")
        raise single_error(value.key, f"{quoted(key)} is a list of {entries}; {quoted(first)} is none", key)
    number, below = int(first), f"{key}.{first}"
    node = listed.items[number]
    if rest and isinstance(node, List):
        node = _assigned_in(node, rest, value, below)
    elif rest:
        node = _with_assigned(_mapping(node, below, value.key), rest, value, f"{below}.")
    else:
        node = value.node
    return List((*listed.items[:number], node, *listed.items[number + 1 :]), listed.location)


def _mapping(node: Node | None, key: str, location: Location) -> Map:
    if node is None:
        return Map({}, location)
    if isinstance(node, Map):
        return node
    if isinstance(node, Scalar) and OF_CAR.sub("", key) in DOTTED_PART_KEYS:
        return Map({"extends": Entry(node.location, node)}, location)
    raise single_error(location, f"{quoted(key)} is {describe(node)} and has no keys of its own", key)


MOST_VALUES: Final = 10_000
_RANGE = re.compile(r"\s*range\((.*)\)\s*")
_OPENING, _CLOSING, _QUOTES = "([{", ")]}", "\"'"


class Override(NamedTuple):
    """A dotted key and the values it takes instead of those in the files.

    Several values are an axis of the matrix; with `swept` a single one is, too, so that the ids of cases
    tell it.
    """

    key: str
    location: Location
    values: tuple[Node, ...]
    swept: bool = False


def parse_overrides(texts: Sequence[str], seed: int | None) -> tuple[Override, ...]:
    """Read ``--set`` options and the ``--seed`` option. Raises ScenarioErrors with the errors of all."""
    overrides = read_each(_parse_override, (Document(COMMAND_LINE, Path(), text) for text in texts))
    for one, later in combinations(overrides, 2):
        if one.key.startswith(f"{later.key}."):
            message = f"the option after it sets {quoted(later.key)} as a whole, and this value is lost"
            raise single_error(one.location, message, one.key, f"write --set {later.key}=... first")
    if seed is not None:
        location = Location(Document("--seed", Path(), str(seed)))
        overrides.append(Override("seed", location, (Scalar(seed, str(seed), location),)))
    return tuple(overrides)


def _parse_override(document: Document) -> Override:
    key, equals, value = document.text.partition("=")
    if not equals or not key.strip():
        hint = "write --set key=value, for example --set rail.friction=0.10"
        raise single_error(Location(document), f"{quoted(document.text)} is not a key and a value", hint=hint)
    values = [
        node
        for start, piece in _comma_pieces(value)
        for node in _parse_values(document, len(key) + 2 + start, piece)
    ]
    return Override(key.strip(), Location(document), tuple(values))


def _comma_pieces(text: str) -> Iterator[tuple[int, str]]:
    """Split at commas outside brackets and quotes; yield each piece with its offset."""
    start, depth, quote = 0, 0, ""
    for at, char in enumerate(text):
        if quote:
            quote = "" if char == quote else quote
        elif char in _QUOTES:
            quote = char
        elif char in _OPENING:
            depth += 1
        elif char in _CLOSING:
            depth -= 1
        elif char == "," and depth == 0:
            yield start, text[start:at]
            start = at + 1
    yield start, text[start:]


def _parse_values(document: Document, column: int, piece: str) -> Iterator[Node]:
    location = Location(document, 1, column)
    if not piece.strip():
        raise single_error(location, "an empty value", hint="write null for nothing")
    match = _RANGE.fullmatch(piece)
    if match is None:
        yield parse(document, 1, column, piece)
        return
    for text in _texts_of_range(match[1], location):
        yield parse(document, 1, column, text)


def _texts_of_range(arguments: str, location: Location) -> list[str]:
    """The values of ``range(first,last,step)`` as texts, with the last one where a step lands on it."""
    try:
        first, last, step = map(parse_decimal_quantity, arguments.split(","))
    except ValueError:
        hint = "write range(first,last,step): range(0.09,0.12,0.01)"
        raise single_error(location, "not a range of numbers", hint=hint) from None
    if common_unit([first, last, step]) is None:
        raise single_error(location, "the three numbers of a range must have the same unit")
    count = count_by_step(first.number, last.number, step.number)
    if count == 0:
        raise single_error(location, f"a step of {step} never leads from {first} to {last}")
    if count > MOST_VALUES:
        raise single_error(location, f"a range of {count} values; at most {MOST_VALUES} are accepted")
    numbers = spaced_by_step(first.number, last.number, step.number)
    return [quantity_text(number, first.unit) for number in numbers]


def apply_overrides(tree: Map, overrides: Sequence[Override]) -> Map:
    """The scenario's tree with the values of the command line in place of its own."""
    for override in overrides:
        tree = without_axis(tree, override.key)
        if len(override.values) == 1 and not override.swept:
            tree = with_value(tree, override.key, Entry(override.location, override.values[0]))
        else:
            tree = _with_axis(tree, override)
    return tree


def _with_axis(tree: Map, override: Override) -> Map:
    matrix = tree.get("matrix")
    if not isinstance(matrix, Map):
        matrix = Map({}, override.location)
    axis = Entry(override.location, List(override.values, override.location))
    return tree.with_entry("matrix", Entry(override.location, matrix.with_entry(override.key, axis)))


def without_axis(tree: Map, key: str) -> Map:
    """The tree without ``key`` in its sweep sections: the command line sets its value."""
    for section in ("matrix", "zip", "include", "exclude"):
        entry = tree.entries.get(section)
        if entry is None or not _mentions(entry.node, key):
            continue
        rest = _section_without(entry.node, key, section)
        tree = tree.without(section) if rest is None else tree.with_entry(section, Entry(entry.key, rest))
    return tree


def _mentions(node: Node, key: str) -> bool:
    if isinstance(node, List):
        return any(_mentions(item, key) for item in node.items)
    return isinstance(node, Map) and key in node.entries


def _section_without(node: Node, key: str, section: str) -> Node | None:
    """A section without ``key``: included cases lose it, exclusions by it are dropped."""
    if isinstance(node, Map):
        return node.without(key) if len(node.entries) > 1 else None
    assert isinstance(node, List)
    kept = [item for item in node.items if not _mentions(item, key)]
    if section == "include":
        kept = [item.without(key) if isinstance(item, Map) else item for item in node.items]
        kept = [item for item in kept if not isinstance(item, Map) or item.entries]
    return List(tuple(kept), node.location) if kept else None


FRICTION: Final = "rail.friction"
CONDITION: Final = "rail.condition"
_CONDITION: Final = ("rail", "condition")


def sets_friction(key: str) -> bool:
    """Whether a dotted key is that of the friction or lies inside it."""
    return f"{key}.".startswith(f"{FRICTION}.")


def changed_alone(before: Map, after: Map) -> Iterator[Diagnostic]:
    """Yield a change of the condition from ``before`` to ``after`` that leaves `rail.friction` as it was.

    A friction of the command line is meant for every case.
    """
    friction = after.at("rail", "friction")
    of_command_line = friction is not None and friction.location.document.display == COMMAND_LINE
    if friction is before.at("rail", "friction") and not of_command_line:
        yield from _friction_conflict(before, after, friction)


def overridden_alone(tree: Map, overrides: Sequence[Override]) -> Iterator[Diagnostic]:
    """Yield the overrides of the condition that leave a friction of the file in force, swept or not."""
    if any(sets_friction(override.key) for override in overrides):
        return
    swept = (each for section in EXPANSION_KEYS[:-1] for each in _friction_nodes(tree.get(section)))
    friction = next(swept, tree.at("rail", "friction"))
    for override in overrides:
        if override.key.startswith(CONDITION):
            for value in override.values:
                with suppress(ScenarioErrors):  # reported where it is applied
                    changed = with_value(tree, override.key, Entry(override.location, value))
                    yield from _friction_conflict(tree, changed, friction)


def _friction_conflict(before: Map, after: Map, friction: Node | None) -> Iterator[Diagnostic]:
    condition = after.at(*_CONDITION)
    if is_null(friction) or friction is None or condition is None:
        return
    if _name_and_friction(condition) != _name_and_friction(before.at(*_CONDITION)):
        written = friction.location
        yield diagnose(
            condition.location,
            f"the rail condition changes, but rail.friction stays {quoted(as_written(friction))}"
            f" ({visible(written.document.display)}:{written.line})",
            CONDITION,
            "set rail.friction as well; null takes the friction of the condition",
        )


def _name_and_friction(condition: Node | None) -> tuple[str, str]:
    """Name and friction of a condition; its other numbers hold for any friction."""
    if condition is None:
        return PART_KEYS[_CONDITION].default, ""
    if not isinstance(condition, Map):
        return as_written(condition), ""
    return _text_or_empty(condition.get("extends")), _text_or_empty(condition.get("friction"))


def _text_or_empty(node: Node | None) -> str:
    return "" if node is None else as_written(node)


def _friction_nodes(section: Node | None) -> Iterable[Node]:
    if isinstance(section, List):
        return (friction for item in section.items for friction in _friction_nodes(item))
    return (
        [section.entries[FRICTION].node] if isinstance(section, Map) and FRICTION in section.entries else []
    )

"""matrix, zip, include and exclude: one scenario becomes many cases."""

from collections.abc import Iterator
from itertools import product
from math import prod
from typing import Final, NamedTuple

from uictest.plans.scenario.yaml import (
    Diagnostic,
    Entry,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    Sequence,
    as_written,
    describe,
    diagnose,
    quoted,
    short_example,
    suggestion,
)

MOST_CASES: Final = 10_000
EXPANSION_KEYS: Final = ("matrix", "zip", "include", "exclude")


class Setting(NamedTuple):
    """The value that one case gives to one swept key; ``number`` counts the values of that key from one."""

    key: str
    value: Entry
    number: int


Variant = tuple[Setting, ...]
"""The settings that distinguish one case of a scenario; empty if it is not swept."""


def expand(tree: Map) -> list[Variant]:
    """The cases of a scenario, in order: matrix (first key slowest) times zip, less exclude, then include.

    Raises ScenarioErrors with every error of the four sections.
    """
    diagnostics: list[Diagnostic] = []
    variants = expand_valid(tree, diagnostics)
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return variants


def expand_valid(tree: Map, diagnostics: list[Diagnostic]) -> list[Variant]:
    """As :func:`expand`, but append errors to ``diagnostics`` and return the cases of the valid values.

    If there are too many, every value occurs in at least one case.
    """
    matrix, zipped = _axes(tree, "matrix", diagnostics), _axes(tree, "zip", diagnostics)
    include, exclude = _listed(tree, "include", diagnostics), _listed(tree, "exclude", diagnostics)
    diagnostics.extend(_unequal(zipped))
    in_matrix = {axis[0].key for axis in matrix}
    diagnostics.extend(
        diagnose(axis[0].value.key, "the key is under matrix as well", f"zip.{axis[0].key}")
        for axis in zipped
        if axis[0].key in in_matrix
    )
    too_many = list(_too_many(tree, matrix, zipped))
    if too_many:
        diagnostics.extend(too_many)
        return [*_one_at_a_time([*matrix, *zipped]), *_included(include)]
    variants = _combined(matrix, zipped, alone=not include)
    swept = _keys_under(tree, "matrix") | _keys_under(tree, "zip")
    variants = _without_excluded(variants, exclude, swept, diagnostics)
    variants.extend(_included(include))
    if not variants and not diagnostics:
        entry = next(tree.entries[section] for section in reversed(EXPANSION_KEYS) if section in tree.entries)
        diagnostics.append(diagnose(entry.key, "no case remains"))
    return variants


def distinct(variants: list[Variant]) -> list[Variant]:
    """The cases without those that repeat an earlier one."""
    by_values = {_values(variant): variant for variant in reversed(variants)}
    return [variant for variant in variants if by_values[_values(variant)] is variant]


def _values(variant: Variant) -> frozenset[tuple[str, str]]:
    return frozenset((setting.key, as_written(setting.value.node)) for setting in variant)


Axis = tuple[Setting, ...]


def _axes(tree: Map, section: str, diagnostics: list[Diagnostic]) -> list[Axis]:
    node = _section(tree, section)
    if node is None:
        return []
    if not isinstance(node, Map) or not node.entries:
        what = "an empty mapping" if isinstance(node, Map) else describe(node)
        diagnostics.append(_malformed(node, section, f"expected lists of values by dotted key, found {what}"))
        return []
    return [axis for key, entry in node.entries.items() if (axis := _axis(section, key, entry, diagnostics))]


def _axis(section: str, key: str, entry: Entry, diagnostics: list[Diagnostic]) -> Axis:
    if not isinstance(entry.node, Sequence):
        message = f"expected a list of values, found {describe(entry.node)}"
        diagnostics.append(
            diagnose(
                entry.node.place,
                message,
                f"{section}.{key}",
                short_example(f"write `[{as_written(entry.node)}]`"),
            )
        )
        return (Setting(key, entry, 1),)
    if not entry.node.items:
        diagnostics.append(diagnose(entry.node.place, "an empty list makes no case", f"{section}.{key}"))
        return ()
    return tuple(
        Setting(key, Entry(entry.key, item), number) for number, item in enumerate(entry.node.items, start=1)
    )


def _listed(tree: Map, section: str, diagnostics: list[Diagnostic]) -> list[Map]:
    node = _section(tree, section)
    if node is None:
        return []
    if not isinstance(node, Sequence):
        diagnostics.append(_malformed(node, section, f"expected a list of mappings, found {describe(node)}"))
        return []
    diagnostics.extend(
        _malformed(item, section, f"expected a mapping of dotted keys to values, found {describe(item)}")
        for item in node.items
        if not isinstance(item, Map) or not item.entries
    )
    return [item for item in node.items if isinstance(item, Map) and item.entries]


def _keys_under(tree: Map, section: str) -> set[str]:
    node = tree.get(section)
    return set(node.entries) if isinstance(node, Map) else set()


def _section(tree: Map, section: str) -> Node | None:
    node = tree.get(section)
    return None if isinstance(node, Scalar) and node.value is None else node


_EXAMPLES: Final = {
    "matrix": "matrix: {rail.friction: [0.09, 0.10]}",
    "zip": "zip: {rail.friction: [0.09, 0.10], seed: [1, 2]}",
    "include": "include: [{rail.friction: 0.09}]",
    "exclude": "exclude: [{rail.friction: 0.09}]",
}


def _malformed(node: Node, section: str, message: str) -> Diagnostic:
    return diagnose(node.place, message, section, f"write `{_EXAMPLES[section]}`")


def _unequal(zipped: list[Axis]) -> Iterator[Diagnostic]:
    for axis in zipped[1:]:
        if len(axis) != len(zipped[0]):
            count = "1 value" if len(axis) == 1 else f"{len(axis)} values"
            message = f"{count}, but {quoted(zipped[0][0].key)} has {len(zipped[0])}"
            hint = "lists under zip must be equally long; matrix combines lists of any length"
            yield diagnose(axis[0].value.key, message, f"zip.{axis[0].key}", hint)


def _too_many(tree: Map, matrix: list[Axis], zipped: list[Axis]) -> Iterator[Diagnostic]:
    count = prod(map(len, matrix)) * (len(zipped[0]) if zipped else 1)
    if count > MOST_CASES:
        entry = tree.entries["matrix" if matrix else "zip"]
        yield diagnose(
            entry.key, f"{count} cases; one scenario makes at most {MOST_CASES}", hint="split it, or sweep"
        )


def _combined(matrix: list[Axis], zipped: list[Axis], *, alone: bool) -> list[Variant]:
    if not matrix and not zipped:
        return [()] if alone else []
    # Unequal lengths are already reported; the rows that all lists have are checked nevertheless.
    rows: list[Variant] = list(zip(*zipped, strict=False)) if zipped else [()]
    return [(*combination, *row) for combination in product(*matrix) for row in rows]


def _one_at_a_time(axes: list[Axis]) -> Iterator[Variant]:
    """The first value of every axis, and each further value with the first ones of the others."""
    first = tuple(axis[0] for axis in axes)
    yield first
    for place, axis in enumerate(axes):
        for setting in axis[1:]:
            yield (*first[:place], setting, *first[place + 1 :])


def _included(include: list[Map]) -> Iterator[Variant]:
    for number, item in enumerate(include, start=1):
        yield tuple(Setting(key, entry, number) for key, entry in item.entries.items())


def _without_excluded(
    variants: list[Variant], exclude: list[Map], swept: set[str], diagnostics: list[Diagnostic]
) -> list[Variant]:
    sound = not diagnostics
    by_keys: dict[frozenset[str], _ByValues] = {}
    excluded: set[int] = set()
    for item in exclude:
        unknown = [key for key in item.entries if key not in swept]
        for key in unknown:
            message = f"{quoted(key)} is not swept, so no case has it"
            diagnostics.append(diagnose(item.entries[key].key, message, "exclude", suggestion(key, swept)))
        if unknown:
            continue
        keys = frozenset(item.entries)
        if keys not in by_keys:
            by_keys[keys] = _by_values(variants, keys)
        # Popped, so that a repeated exclusion matches no case.
        values = frozenset((key, _comparable(entry.node)) for key, entry in item.entries.items())
        matches = set(by_keys[keys].pop(values, ())) - excluded
        if not matches and sound:
            diagnostics.append(diagnose(item.place, "no case has these values", "exclude"))
        excluded |= matches
    return [variant for place, variant in enumerate(variants) if place not in excluded]


_ByValues = dict[frozenset[tuple[str, object]], list[int]]
"""Values of some keys, as far as they can be compared, and the places of the cases that have them."""


def _by_values(variants: list[Variant], keys: frozenset[str]) -> _ByValues:
    places: _ByValues = {}
    for place, variant in enumerate(variants):
        values = {setting.key: setting.value.node for setting in variant}
        if keys <= values.keys():
            places.setdefault(frozenset((key, _comparable(values[key])) for key in keys), []).append(place)
    return places


def _comparable(node: Node) -> object:
    if isinstance(node, Scalar) and not isinstance(node.value, str):
        return node.value
    return "".join(as_written(node).split())

"""The scenarios of the cars of a train, and errors of theirs under the keys that the file has for them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from uictest.plans.scenario.coupling import require_couplable
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.references import Parts
from uictest.plans.scenario.resolution import resolve
from uictest.plans.scenario.train import car_trees, is_train
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Map,
    Node,
    Place,
    ScenarioErrors,
    Sequence,
    collecting,
    diagnose,
    quoted,
    visible,
    whole_file,
)

ResolvedCar = tuple[tuple[Scenario, tuple[Document, ...]], Map]
"""The scenario of a car, the documents of its parts, and its tree."""


def resolved_cars(path: Path, tree: Map, parts: Parts) -> list[ResolvedCar]:
    """Return the cars of a train; the scenario of a car alone is its only one.

    Raises ScenarioErrors, which name `train.1.vehicle` where the scenario of a car has `vehicle`.

    Args:
        path: of the file.
        tree: of the scenario.
        parts: that it refers to.
    """
    cars, diagnostics = list[ResolvedCar](), list[Diagnostic]()
    with collecting(diagnostics, whole_file(path)):
        for car, count in car_trees(tree):
            with collecting(diagnostics, whole_file(path)):
                cars += [(resolve(car, parts), car)] * count
        if is_train(tree) and not diagnostics:
            require_couplable([scenario for (scenario, _), _ in cars], [car for _, car in cars])
    if diagnostics:
        entries = _entry_of_position(tree)
        raise ScenarioErrors(_named(each, entries) for each in diagnostics)
    return cars


def reaching_no_car(tree: Map, given: Mapping[str, Entry]) -> Iterator[Diagnostic]:
    """Yield what is given to a whole train by dotted key and no car has: each has something else of its own.

    Two cases that differ in such a key alone would be the same stop under two names.
    """
    train = tree.get("train")
    entries = [item for item in train.items if isinstance(item, Map)] if isinstance(train, Sequence) else []
    for key, value in given.items():
        head = key.partition(".")[0]
        if not entries or not all(head in item.entries for item in entries):
            continue
        reached = {place for car, _ in car_trees(tree) for place in _places(car)}
        if reached.isdisjoint(_places(value.node)):
            message = f"every car of the train has a {quoted(head)} of its own"
            yield diagnose(
                value.node.place, message, key, f"name the car: train.0.{key} is that of the first"
            )


def own_keys(tree: Map, keys: Iterable[str]) -> list[dict[str, str]]:
    """Return for each entry of `train` what its scenario calls those of some keys that reach it.

    A key of the train does not reach a car that has something else of its own in its place.
    """
    node = tree.entries["train"].node
    assert isinstance(node, Sequence)
    every = list(keys)
    named = ({key: _key_in_car(item, place, key) for key in every} for place, item in enumerate(node.items))
    return [{key: own for key, own in of_entry.items() if own} for of_entry in named]


def _key_in_car(item: Node | None, place: int, key: str) -> str:
    head, _, below = key.partition(".")
    if head == "train":
        number, _, own = below.partition(".")
        return own if number == str(place) else ""
    for element in key.split("."):
        if not isinstance(item, Map):
            return ""
        if element not in item.entries:
            return key
        item = item.entries[element].node
    return key if isinstance(item, Map) else ""


_Position = tuple[str, int, int]
"""File, line and column."""


def _named(diagnostic: Diagnostic, entries: dict[_Position, int]) -> Diagnostic:
    number = entries.get((diagnostic.file, diagnostic.line, diagnostic.column))
    if number is None or diagnostic.key.partition(".")[0] == "train":
        return diagnostic
    return diagnostic._replace(key=".".join(filter(None, ("train", str(number), diagnostic.key))))


def _entry_of_position(tree: Map) -> dict[_Position, int]:
    """Return the entry of `train`, from 0, in which each position of a file lies."""
    train = tree.get("train")
    entries: dict[_Position, int] = {}
    for number, item in enumerate(train.items if isinstance(train, Sequence) else ()):
        for place in _places(item):
            entries.setdefault((visible(place.document.display), place.line, place.column), number)
    return entries


def _places(node: Node) -> Iterator[Place]:
    yield node.place
    if isinstance(node, Map):
        for entry in node.entries.values():
            yield entry.key
            yield from _places(entry.node)
    elif isinstance(node, Sequence):
        for item in node.items:
            yield from _places(item)

"""From a scenario with `train` to one for each car."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Final

from uictest.plans.scenario.expectation import Expect
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.controller import Controller
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.parts.fault import Fault
from uictest.plans.scenario.parts.measures import MeasureDefinitions
from uictest.plans.scenario.parts.sand import Sander
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.resolution import PART_KEYS, with_default_parts
from uictest.plans.scenario.sections import Brake, Rig
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Map,
    Model,
    PartReference,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    describe,
    diagnose,
    merge,
    quoted,
    single_error,
    suggestion,
)
from uictest.plans.scenario.yaml.quantity_field import field, optional

MOST_CARS: Final = 32
"""Of one train; chosen: more than a long passenger train has."""
_ALONE: Final = ("coupler", "brake.transmission")
"""Keys that only a train has."""
_ONCE: Final = ("brake.transmission",)
"""Keys that a train has once, inside of what its cars have of their own."""
_WRITE: Final = "write `train: [{vehicle: intercity-180, count: 4}]`"


class TrainCar(Model):
    """Equal cars in a row; what is left out is that of the scenario."""

    vehicle: Annotated[Vehicle, PartReference(Vehicle, PART_KEYS["vehicle",].default)] | None = optional(
        "The vehicle: a library name, a relative path or an inline mapping."
    )
    count: int = field("How many there are in a row.", default=1, ge=1, le=MOST_CARS, strict=True)
    brake: Brake = optional("What their brakes have of their own.")
    rig: Rig = optional("What their rigs have of their own.")
    controller: Annotated[Controller, PartReference(Controller, PART_KEYS["controller",].default)] = optional(
        "Their WSP controller."
    )
    sanders: tuple[Sander, ...] = optional("Their sanders.")
    faults: tuple[Fault, ...] = optional("Faults of these cars.")
    criteria: Annotated[
        tuple[Criteria, ...], PartReference(Criteria, PART_KEYS["criteria",].default, several=True)
    ] = optional("What these cars are judged by.")
    measures: Annotated[
        MeasureDefinitions, PartReference(MeasureDefinitions, PART_KEYS["measures",].default)
    ] = optional("Definitions of the measures.")
    expect: Expect = optional("The expected outcome of these cars.")


def is_train(tree: Map) -> bool:
    """Whether the scenario of a tree is that of a train."""
    return _written(tree, "train") is not None


def _written(tree: Map, key: str) -> Entry | None:
    """Return what stands at a dotted key, None where that is nothing."""
    node: Map = tree
    *above, last = key.split(".")
    for element in above:
        inner = node.get(element)
        if not isinstance(inner, Map):
            return None
        node = inner
    entry = node.entries.get(last)
    return None if entry is None or (isinstance(entry.node, Scalar) and entry.node.value is None) else entry


def without_inherited_vehicle(tree: Map, documents: Sequence[Document]) -> Map:
    """Return a merged tree without a vehicle that an older file gives than the one that gives the train.

    Args:
        tree: of the scenario, its parents merged in.
        documents: that it came from, the child's first.
    """
    train, vehicle = _written(tree, "train"), _written(tree, "vehicle")
    if train is None or vehicle is None:
        return tree
    return tree.without("vehicle") if is_older(vehicle, train, documents) else tree


def is_older(one: Entry, other: Entry, documents: Sequence[Document]) -> bool:
    """Return whether an entry comes from a parent of the file that another one comes from."""
    age = {id(document): place for place, document in enumerate(documents)}
    return age[id(one.key.document)] > age[id(other.key.document)]


def with_default_vehicles(tree: Map) -> Map:
    """The tree of a train with the default in place of every missing reference, those of its cars too."""
    filled = with_default_parts(tree)
    filled = filled if "vehicle" in tree.entries else filled.without("vehicle")
    train = tree.entries["train"]
    if not isinstance(train.node, List):
        return filled
    default = PART_KEYS["vehicle",].default
    items = (
        item.with_entry("vehicle", Entry(item.place, Scalar(default, default, item.place)))
        if isinstance(item, Map) and _written(item, "vehicle") is None
        else item
        for item in train.node.items
    )
    return filled.with_entry("train", Entry(train.key, List(tuple(items), train.node.place)))


def car_trees(tree: Map) -> list[tuple[Map, int]]:
    """Return the tree of each entry of `train`, laid over what the train has in common, and its count.

    The scenario of a car alone is its own only entry. Raises ScenarioErrors.
    """
    if not is_train(tree):
        found = ((key, entry) for key in _ALONE if (entry := _written(tree, key)) is not None)
        diagnostics = [
            diagnose(entry.key, "only a train has it", key, f"leave it out, or {_WRITE}")
            for key, entry in found
        ]
        if diagnostics:
            raise ScenarioErrors(diagnostics)
        return [(tree, 1)]
    node = tree.entries["train"].node
    diagnostics = list(_problems_beside(tree))
    if not isinstance(node, List) or not node.items:
        what = "an empty list" if isinstance(node, List) else describe(node)
        raise ScenarioErrors(
            [*diagnostics, diagnose(node.place, f"expected a list of cars, found {what}", "train", _WRITE)]
        )
    common = tree.without("train")
    if _written(common, "coupler") is None:  # results state its numbers, defaults too
        common = common.with_entry("coupler", Entry(tree.entries["train"].key, Map({}, tree.place)))
    cars: list[tuple[Map, int]] = []
    for place, item in enumerate(node.items):
        try:
            cars.append(_car(common, item, f"train.{place}"))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if (count := sum(count for _, count in cars)) > MOST_CARS:
        diagnostics.append(diagnose(node.place, f"{count} cars; a train has at most {MOST_CARS}", "train"))
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return cars


def _problems_beside(tree: Map) -> Iterator[Diagnostic]:
    """Yield keys of a scenario that do not go with `train`."""
    if (vehicle := _written(tree, "vehicle")) is not None:
        hint = "leave it out, or write `train: null`; the vehicle of the first cars is train.0.vehicle"
        yield diagnose(vehicle.key, "the cars of a train have vehicles of their own", "vehicle", hint)


def _car(common: Map, item: Any, key: str) -> tuple[Map, int]:
    if not isinstance(item, Map):
        raise single_error(item.place, f"expected a mapping, found {describe(item)}", key, _WRITE)
    diagnostics = [
        _misplaced(name, item.entries[name], key)
        for name in item.entries
        if name not in TrainCar.model_fields
    ]
    nested = ((once, _written(item, once)) for once in _ONCE)
    diagnostics += [_once(once, entry, key) for once, entry in nested if entry is not None]
    count = item.entries.get("count")
    number = 1 if count is None else count.node.value if isinstance(count.node, Scalar) else None
    if count is not None and not (
        isinstance(number, int) and not isinstance(number, bool) and 1 <= number <= MOST_CARS
    ):
        message = f"expected a whole number from 1 to {MOST_CARS}"
        diagnostics.append(diagnose(count.node.place, message, f"{key}.count"))
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    car = merge(common, item.without("count"))
    assert isinstance(car, Map) and isinstance(number, int)
    return car, number


def _misplaced(name: str, entry: Entry, key: str) -> Diagnostic:
    """Return the error of a key that no car has of its own."""
    of_scenario = {each.alias or field_name for field_name, each in Scenario.model_fields.items()}
    if name in of_scenario:
        return _once(name, entry, key)
    return diagnose(
        entry.key, f"unknown key {quoted(name)}", f"{key}.{name}", suggestion(name, TrainCar.model_fields)
    )


def _once(name: str, entry: Entry, key: str) -> Diagnostic:
    hint = f"write {name} beside `train`; a car has {', '.join(TrainCar.model_fields)} of its own"
    return diagnose(entry.key, f"a train has one {name.rpartition('.')[2]}", f"{key}.{name}", hint)

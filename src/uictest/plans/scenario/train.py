"""From a scenario with `train` to one for each car, and which cars cannot run coupled."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Final

from uictest.controllers import ControllerProgram
from uictest.core.units import PERCENT
from uictest.plans.scenario.model import Rig, Scenario
from uictest.plans.scenario.parts.brake import Brake
from uictest.plans.scenario.parts.controller import Controller
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.parts.fault import Fault
from uictest.plans.scenario.parts.measures import MeasureDefinitions
from uictest.plans.scenario.parts.named_file import Expect
from uictest.plans.scenario.parts.rail import Sander
from uictest.plans.scenario.parts.vehicle import Coupler, Vehicle
from uictest.plans.scenario.resolution import PART_KEYS, Parts, resolve, with_default_parts
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Inconsistency,
    List,
    Location,
    Map,
    Model,
    Node,
    PartReference,
    Scalar,
    ScenarioErrors,
    collecting,
    describe,
    diagnose,
    dotted,
    entry_at,
    field,
    is_null,
    merge,
    optional,
    quoted,
    require_none,
    single_error,
    suggestion,
    visible,
    whole_file,
)

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
    return _entry_at(tree, "train") is not None


def _entry_at(tree: Map, key: str) -> Entry | None:
    """Return the entry at a dotted key; None if it is missing or null."""
    *above, last = key.split(".")
    node = tree.at(*above)
    entry = node.entries.get(last) if isinstance(node, Map) else None
    return None if entry is None or is_null(entry.node) else entry


def without_inherited_vehicle(tree: Map, documents: Sequence[Document]) -> Map:
    """Return a merged tree without a vehicle that an older file gives than the one that gives the train.

    Args:
        tree: of the scenario, its parents merged in.
        documents: that it came from, the child's first.
    """
    train, vehicle = _entry_at(tree, "train"), _entry_at(tree, "vehicle")
    if train is None or vehicle is None:
        return tree
    return tree.without("vehicle") if is_older(vehicle, train, documents) else tree


def is_older(one: Entry, other: Entry, documents: Sequence[Document]) -> bool:
    """Return whether an entry comes from a parent of the file that another one comes from."""
    age = {id(document): index for index, document in enumerate(documents)}
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
        item.with_entry("vehicle", Entry(item.location, Scalar(default, default, item.location)))
        if isinstance(item, Map) and _entry_at(item, "vehicle") is None
        else item
        for item in train.node.items
    )
    return filled.with_entry("train", Entry(train.key, List(tuple(items), train.node.location)))


def car_trees(tree: Map) -> list[tuple[Map, int]]:
    """Return the tree of each entry of `train`, laid over what the train has in common, and its count.

    The scenario of a car alone is its own only entry. Raises ScenarioErrors.
    """
    if not is_train(tree):
        found = ((key, entry) for key in _ALONE if (entry := _entry_at(tree, key)) is not None)
        diagnostics = [
            diagnose(entry.key, "only a train has it", key, f"leave it out, or {_WRITE}")
            for key, entry in found
        ]
        require_none(diagnostics)
        return [(tree, 1)]
    node = tree.entries["train"].node
    diagnostics = []
    if (vehicle := _entry_at(tree, "vehicle")) is not None:
        hint = "leave it out, or write `train: null`; the vehicle of the first cars is train.0.vehicle"
        message = "the cars of a train have vehicles of their own"
        diagnostics.append(diagnose(vehicle.key, message, "vehicle", hint))
    if not isinstance(node, List) or not node.items:
        what = "an empty list" if isinstance(node, List) else describe(node)
        raise ScenarioErrors(
            [*diagnostics, diagnose(node.location, f"expected a list of cars, found {what}", "train", _WRITE)]
        )
    common = tree.without("train")
    if _entry_at(common, "coupler") is None:  # results state its numbers, defaults too
        common = common.with_entry("coupler", Entry(tree.entries["train"].key, Map({}, tree.location)))
    cars: list[tuple[Map, int]] = []
    for index, item in enumerate(node.items):
        try:
            cars.append(_car(common, item, f"train.{index}"))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if (count := sum(count for _, count in cars)) > MOST_CARS:
        diagnostics.append(diagnose(node.location, f"{count} cars; a train has at most {MOST_CARS}", "train"))
    require_none(diagnostics)
    return cars


def _car(common: Map, item: Any, key: str) -> tuple[Map, int]:
    if not isinstance(item, Map):
        raise single_error(item.location, f"expected a mapping, found {describe(item)}", key, _WRITE)
    diagnostics = [
        _misplaced_key(name, item.entries[name], key)
        for name in item.entries
        if name not in TrainCar.model_fields
    ]
    nested = ((once, _entry_at(item, once)) for once in _ONCE)
    diagnostics += [_only_once_per_train(once, entry, key) for once, entry in nested if entry is not None]
    count = item.entries.get("count")
    number = 1 if count is None else count.node.value if isinstance(count.node, Scalar) else None
    if count is not None and not (
        isinstance(number, int) and not isinstance(number, bool) and 1 <= number <= MOST_CARS
    ):
        message = f"expected a whole number from 1 to {MOST_CARS}"
        diagnostics.append(diagnose(count.node.location, message, f"{key}.count"))
    require_none(diagnostics)
    car = merge(common, item.without("count"))
    assert isinstance(car, Map) and isinstance(number, int)
    return car, number


def _misplaced_key(name: str, entry: Entry, key: str) -> Diagnostic:
    of_scenario = {each.alias or field_name for field_name, each in Scenario.model_fields.items()}
    if name in of_scenario:
        return _only_once_per_train(name, entry, key)
    return diagnose(
        entry.key, f"unknown key {quoted(name)}", f"{key}.{name}", suggestion(name, TrainCar.model_fields)
    )


def _only_once_per_train(name: str, entry: Entry, key: str) -> Diagnostic:
    hint = f"write {name} beside `train`; a car has {', '.join(TrainCar.model_fields)} of its own"
    return diagnose(entry.key, f"a train has one {name.rpartition('.')[2]}", f"{key}.{name}", hint)


def require_couplable(cars: Sequence[Scenario], trees: Sequence[Map]) -> None:
    """Raise ScenarioErrors where cars cannot run as one train.

    Args:
        cars: of the train, in their order.
        trees: that they were resolved from.
    """
    diagnostics: dict[Diagnostic, None] = {}
    for index, (key, message, hint) in (*_foreign_to_trains(cars), *_impossible_couplers(cars)):
        entry, _ = entry_at(trees[index], key)
        diagnostics[diagnose(entry.node.location, message, dotted(key), hint)] = None
    require_none(diagnostics)


def coupling_problem(cars: Sequence[Scenario]) -> str:
    """Return the reason why cars cannot run as one train; empty if they can."""
    problems = (*_foreign_to_trains(cars), *_impossible_couplers(cars))
    return next((f"{dotted(problem.key)}: {problem.message}" for _, problem in problems), "")


_CarProblem = tuple[int, Inconsistency]
"""The index of a car, from 0, and what of its scenario cannot be in its train."""


def _foreign_to_trains(cars: Sequence[Scenario]) -> Iterator[_CarProblem]:
    cycle = cars[0].controller.cycle_time
    for index, car in enumerate(cars):
        own = car.controller.cycle_time
        if own != cycle:
            message = f"a controller cycle of {own.text}; that of the first car is {cycle.text}"
            hint = "a train has one length of the controller cycle"
            yield index, Inconsistency(("controller",), message, hint)
    yield from program_problems([car.controller.program for car in cars])


def program_problems(programs: Sequence[ControllerProgram | None]) -> Iterator[_CarProblem]:
    """Yield the cars whose controllers cannot run in one process with those of the cars before.

    One process runs all of them: modules in the folder of one program would replace those of another.
    """
    first: dict[str, int] = {}
    addresses: dict[str, int] = {}
    for index, program in enumerate(programs):
        if program is None:
            continue
        before, leader = next(iter(first.items()), (program.surroundings, index))
        first.setdefault(program.surroundings, index)
        if program.surroundings != before:
            others = f"that of car {leader + 1} from {before}"
            message = f"its controller is loaded from {program.surroundings}, {others}"
            at_sockets = "connect" in (program.kind, getattr(programs[leader], "kind", ""))
            hint = (
                "where a car has a program at a socket, so have all others, or a built-in controller"
                if at_sockets
                else "put the files of all controllers of a train into one folder"
            )
            yield index, Inconsistency(("controller",), message, hint)
        if program.kind == "connect" and addresses.setdefault(program.location, index) != index:
            message = f"{program.location} is the address of car {addresses[program.location] + 1}, too"
            hint = "a program serves one car: give each car an address of its own"
            yield index, Inconsistency(("controller",), message, hint)


def _impossible_couplers(cars: Sequence[Scenario]) -> Iterator[_CarProblem]:
    coupler, step = cars[0].coupler or Coupler(), cars[0].simulation.time_step
    steadiness = [_steadiness(car, coupler) for car in cars]
    if (worst := max(steadiness)) > coupler.largest_steadiness:
        mass = cars[steadiness.index(worst)].vehicle.loaded_body.mass / 1000.0
        message = f"too stiff or too much damped for a body of {mass:.4g} t with a step of {step.text}"
        share = coupler.largest_steadiness / worst / PERCENT
        hint = f"{share:.2g} % of stiffness and damping are accepted, or a shorter step"
        yield 0, Inconsistency(("coupler",), message, hint)
    reach = [_reach_of_wheels(car) for car in cars]
    least = max(map(sum, pairwise(reach)), default=0.0)
    if coupler.distance <= least:
        message = f"{coupler.distance.text} let the wheels of neighbouring cars overlap"
        yield 0, Inconsistency(("coupler", "distance"), message, f"more than {least:.4g} m are accepted")


def _reach_of_wheels(car: Scenario) -> float:
    """Return the largest distance of a wheel of a car from the car's centre, m."""
    vehicle = car.vehicle
    return float(vehicle.half_pivot_distance + vehicle.bogie.half_wheelbase + max(vehicle.wheel_radii))


def _steadiness(car: Scenario, coupler: Coupler) -> float:
    """Return dt^2 K + 2 dt C of a chain of such bodies; the lever to their centre makes them lighter."""
    body, step = car.vehicle.loaded_body, car.simulation.time_step
    lever = coupler.height - body.height
    mobility = 1.0 / body.mass + lever**2 / body.pitch_inertia
    return float(4.0 * mobility * (step**2 * coupler.stiffness + 2.0 * step * coupler.damping))


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
        raise ScenarioErrors(_with_entry_number(each, entries) for each in diagnostics)
    return cars


def reaching_no_car(tree: Map, given: Mapping[str, Entry]) -> Iterator[Diagnostic]:
    """Yield dotted keys set for a whole train that take effect in no car, as each car has a value of its own.

    Two cases that differ in such a key alone would be the same stop under two names.
    """
    train = tree.get("train")
    entries = [item for item in train.items if isinstance(item, Map)] if isinstance(train, List) else []
    for key, value in given.items():
        head = key.partition(".")[0]
        if not entries or not all(head in item.entries for item in entries):
            continue
        reached = {location for car, _ in car_trees(tree) for location in _locations_within(car)}
        if reached.isdisjoint(_locations_within(value.node)):
            message = f"every car of the train has a {quoted(head)} of its own"
            yield diagnose(
                value.node.location, message, key, f"name the car: train.0.{key} is that of the first"
            )


def own_keys(tree: Map, keys: Iterable[str]) -> list[dict[str, str]]:
    """Return for each entry of `train` what its scenario calls those of some keys that reach it.

    A key of the train does not reach a car that has something else of its own in its place.
    """
    node = tree.entries["train"].node
    assert isinstance(node, List)
    every = list(keys)
    named = ({key: _key_in_car(item, index, key) for key in every} for index, item in enumerate(node.items))
    return [{key: own for key, own in of_entry.items() if own} for of_entry in named]


def _key_in_car(item: Node | None, location: int, key: str) -> str:
    head, _, below = key.partition(".")
    if head == "train":
        number, _, own = below.partition(".")
        return own if number == str(location) else ""
    for element in key.split("."):
        if not isinstance(item, Map):
            return ""
        if element not in item.entries:
            return key
        item = item.entries[element].node
    return key if isinstance(item, Map) else ""


_Position = tuple[str, int, int]
"""File, line and column."""


def _with_entry_number(diagnostic: Diagnostic, entries: dict[_Position, int]) -> Diagnostic:
    number = entries.get((diagnostic.file, diagnostic.line, diagnostic.column))
    if number is None or diagnostic.key.partition(".")[0] == "train":
        return diagnostic
    return diagnostic._replace(key=".".join(filter(None, ("train", str(number), diagnostic.key))))


def _entry_of_position(tree: Map) -> dict[_Position, int]:
    train = tree.get("train")
    entries: dict[_Position, int] = {}
    for number, item in enumerate(train.items if isinstance(train, List) else ()):
        for location in _locations_within(item):
            entries.setdefault((visible(location.document.display), location.line, location.column), number)
    return entries


def _locations_within(node: Node) -> Iterator[Location]:
    yield node.location
    if isinstance(node, Map):
        for entry in node.entries.values():
            yield entry.key
            yield from _locations_within(entry.node)
    elif isinstance(node, List):
        for item in node.items:
            yield from _locations_within(item)

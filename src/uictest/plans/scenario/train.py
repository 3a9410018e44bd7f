"""From a scenario with `train` to one for each car, and what cars cannot be coupled."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, Any, Final, Literal, NamedTuple

from uictest.controllers import CONTROLLERS
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.controller import Controller
from uictest.plans.scenario.parts.coupler import Coupler
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
    Key,
    Map,
    Model,
    PartReference,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    describe,
    diagnose,
    dotted,
    entry_at,
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
_STEADY: Final = 1.0
"""Largest dt^2 K + 2 dt C with K = 4 k/m and C = 4 c/m. A chain of masses is stable up to 4; chosen, since
the springs of the cars come on top."""
_WRITE: Final = "write `train: [{vehicle: intercity-180, count: 4}]`"


class TrainCar(Model):
    """Equal cars in a row; what is left out is that of the scenario."""

    vehicle: Annotated[Vehicle, PartReference(Vehicle, PART_KEYS["vehicle",].default)] = field(
        "The vehicle: a library name, a relative path or an inline mapping."
    )
    count: int = field("How many there are in a row.", default=1, ge=1, le=MOST_CARS, strict=True)
    brake: Brake | None = optional("What their brakes have of their own.")
    rig: Rig | None = optional("What their rigs have of their own.")
    controller: Annotated[Controller, PartReference(Controller, PART_KEYS["controller",].default)] | None = (
        optional("Their WSP controller.")
    )
    sanders: tuple[Sander, ...] | None = optional("Their sanders.")
    faults: tuple[Fault, ...] | None = optional("Faults of these cars.")
    criteria: (
        Annotated[tuple[Criteria, ...], PartReference(Criteria, PART_KEYS["criteria",].default, several=True)]
        | None
    ) = optional("What these cars are judged by.")
    measures: (
        Annotated[MeasureDefinitions, PartReference(MeasureDefinitions, PART_KEYS["measures",].default)]
        | None
    ) = optional("Definitions of the measures.")
    expect: Literal["pass", "fail", "invalid", "skipped"] | None = optional(
        "The expected outcome of these cars."
    )


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
    age = {id(document): place for place, document in enumerate(documents)}
    older = age[id(vehicle.key.document)] > age[id(train.key.document)]
    return tree.without("vehicle") if older else tree


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


def require_couplable(cars: Sequence[Scenario], trees: Sequence[Map]) -> None:
    """Raise ScenarioErrors where cars cannot run as one train.

    Args:
        cars: of the train, in their order.
        trees: that they were resolved from.
    """
    diagnostics: dict[Diagnostic, None] = {}
    for place, key, problem in (*_foreign_to_trains(cars), *_impossible_couplers(cars)):
        entry, _ = entry_at(trees[place], key)
        diagnostics[diagnose(entry.node.place, problem.message, dotted(key), problem.hint)] = None
    if diagnostics:
        raise ScenarioErrors(diagnostics)


def coupling_problem(cars: Sequence[Scenario]) -> str:
    """Return why cars cannot run as one train, empty where they can."""
    problems = (*_foreign_to_trains(cars), *_impossible_couplers(cars))
    return next((f"{dotted(key)}: {problem.message}" for _, key, problem in problems), "")


class _Problem(NamedTuple):
    message: str
    hint: str


_CarProblem = tuple[int, Key, _Problem]
"""A problem at a key of the scenario of a car, which is counted from 0."""


def _foreign_to_trains(cars: Sequence[Scenario]) -> Iterator[_CarProblem]:
    """Yield controllers from outside, and such as do not keep the cycle of the leading car's."""
    cycle = cars[0].controller.cycle_time
    for place, car in enumerate(cars):
        own = car.controller
        if own.program is not None:
            hint = f"a train has built-in ones: {', '.join(sorted(CONTROLLERS))}"
            yield place, ("controller",), _Problem(f"{quoted(own.label)} is a controller from outside", hint)
        elif own.cycle_time != cycle:
            message = f"a controller cycle of {own.cycle_time.text}; that of the first car is {cycle.text}"
            yield place, ("controller",), _Problem(message, "a train has one length of the controller cycle")


def _impossible_couplers(cars: Sequence[Scenario]) -> Iterator[_CarProblem]:
    """Yield couplers too stiff for the step with the lightest car, and too short for two neighbours."""
    coupler, step = cars[0].coupler or Coupler(), cars[0].simulation.time_step
    steadiness = [_steadiness(car, coupler) for car in cars]
    if (worst := max(steadiness)) > _STEADY:
        mass = cars[steadiness.index(worst)].vehicle.loaded_body.mass / 1000.0
        yield (
            *(0, ("coupler",)),
            _Problem(
                f"too stiff or too much damped for a body of {mass:.4g} t with a step of {step.text}",
                f"{100.0 * _STEADY / worst:.2g} % of stiffness and damping are accepted, or a shorter step",
            ),
        )
    reach = [_reach(car) for car in cars]
    least = max(map(sum, pairwise(reach)), default=0.0)
    if coupler.distance <= least:
        message = f"{coupler.distance.text} let the wheels of neighbouring cars overlap"
        yield 0, ("coupler", "distance"), _Problem(message, f"more than {least:.4g} m are accepted")


def _reach(car: Scenario) -> float:
    """Return how far the wheels of a car reach from its centre, m."""
    vehicle = car.vehicle
    return float(vehicle.half_pivot_distance + vehicle.bogie.half_wheelbase + max(vehicle.wheel_radii))


def _steadiness(car: Scenario, coupler: Coupler) -> float:
    """Return dt^2 K + 2 dt C of a chain of such bodies; the lever to their centre makes them lighter."""
    body, step = car.vehicle.loaded_body, car.simulation.time_step
    lever = coupler.height - body.height
    mobility = 1.0 / body.mass + lever**2 / body.pitch_inertia
    return float(4.0 * mobility * (step**2 * coupler.stiffness + 2.0 * step * coupler.damping))

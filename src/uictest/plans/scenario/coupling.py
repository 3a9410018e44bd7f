"""Which cars cannot run coupled in one train, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

from uictest.controllers import ControllerProgram
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.coupler import Coupler
from uictest.plans.scenario.yaml import Diagnostic, Key, Map, ScenarioErrors, diagnose, dotted, entry_at

_STEADY: Final = 1.0
"""Largest dt^2 K + 2 dt C with K = 4 k/m and C = 4 c/m. A chain of masses is stable up to 4; chosen, since
the springs of the cars come on top."""


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


class TrainProblem(NamedTuple):
    """Why a car cannot run in its train, and what to do."""

    message: str
    hint: str


_CarProblem = tuple[int, Key, TrainProblem]
"""A problem at a key of the scenario of a car, which is counted from 0."""


def _foreign_to_trains(cars: Sequence[Scenario]) -> Iterator[_CarProblem]:
    """Yield controllers that do not keep the leading car's cycle, and programs that cannot run together."""
    cycle = cars[0].controller.cycle_time
    for place, car in enumerate(cars):
        own = car.controller
        if own.cycle_time != cycle:
            message = f"a controller cycle of {own.cycle_time.text}; that of the first car is {cycle.text}"
            hint = "a train has one length of the controller cycle"
            yield place, ("controller",), TrainProblem(message, hint)
    for place, problem in program_problems([car.controller.program for car in cars]):
        yield place, ("controller",), problem


def program_problems(programs: Sequence[ControllerProgram | None]) -> Iterator[tuple[int, TrainProblem]]:
    """Yield the places, from 0, of cars whose controllers cannot run beside those of the cars before.

    One process runs all of them: what lies beside one file would take the place of what lies beside another.
    """
    first: dict[str, int] = {}
    addresses: dict[str, int] = {}
    for place, program in enumerate(programs):
        if program is None:
            continue
        before, leader = next(iter(first.items()), (program.surroundings, place))
        first.setdefault(program.surroundings, place)
        if program.surroundings != before:
            others = f"that of car {leader + 1} from {before}"
            message = f"its controller is loaded from {program.surroundings}, {others}"
            at_sockets = "connect" in (program.kind, getattr(programs[leader], "kind", ""))
            hint = (
                "where a car has a program at a socket, so have all others, or a built-in controller"
                if at_sockets
                else "put the files of all controllers of a train into one folder"
            )
            yield place, TrainProblem(message, hint)
        if program.kind == "connect" and addresses.setdefault(program.location, place) != place:
            message = f"{program.location} is the address of car {addresses[program.location] + 1}, too"
            hint = "a program serves one car: give each car an address of its own"
            yield place, TrainProblem(message, hint)


def _impossible_couplers(cars: Sequence[Scenario]) -> Iterator[_CarProblem]:
    """Yield couplers too stiff for the step with the lightest car, and too short for two neighbours."""
    coupler, step = cars[0].coupler or Coupler(), cars[0].simulation.time_step
    steadiness = [_steadiness(car, coupler) for car in cars]
    if (worst := max(steadiness)) > _STEADY:
        mass = cars[steadiness.index(worst)].vehicle.loaded_body.mass / 1000.0
        yield (
            *(0, ("coupler",)),
            TrainProblem(
                f"too stiff or too much damped for a body of {mass:.4g} t with a step of {step.text}",
                f"{100.0 * _STEADY / worst:.2g} % of stiffness and damping are accepted, or a shorter step",
            ),
        )
    reach = [_reach(car) for car in cars]
    least = max(map(sum, pairwise(reach)), default=0.0)
    if coupler.distance <= least:
        message = f"{coupler.distance.text} let the wheels of neighbouring cars overlap"
        yield 0, ("coupler", "distance"), TrainProblem(message, f"more than {least:.4g} m are accepted")


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

"""What the rig is given for a train: the inputs of its cars, and what they have because they are coupled."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ControllerProgram
from uictest.plans.scenario import Case, Coupler, Scenario, program_problems
from uictest.rig.assembly import assemble
from uictest.rig.model.rail import MARGIN, POINTS
from uictest.rig.model.state import COUPLER
from uictest.rig.rail_assembly import sand_grid
from uictest.rig.train_stop import StopInputs, TrainInputs

_SHARED: Final = ("step", "steps_per_cycle", "initial_speed", "seed", "cycles")
"""Fields that all cars of a train have in common."""
_KEY_STEP: Final = 0x9E3779B1
"""Between the noise keys of neighbours, so that equal cars differ in noise; the first keeps its own."""


class Coupling(NamedTuple):
    """Couplers and brake pipe between the cars of a train.

    Attributes:
        distance: between the centres of neighbouring cars, m.
        stiffness: of a coupler, N/m; 5 MN/m as in open data of an eight-car unit, second-hand.
        damping: of a coupler, N s/m; 0.8 MN s/m likewise.
        height: of a coupler above the rail, m; chosen, that of usual buffers.
        pipe_speed: at which the brake command travels from car to car, m/s; infinite along a wire.
    """

    distance: float
    stiffness: float = 5.0e6
    damping: float = 0.8e6
    height: float = 1.025
    pipe_speed: float = float("inf")


def coupling_of(scenario: Scenario) -> Coupling:
    """Return the coupling of a train from the scenario of any of its cars."""
    coupler, line = scenario.coupler or Coupler(), scenario.brake.transmission
    return Coupling(
        float(coupler.distance),
        float(coupler.stiffness),
        float(coupler.damping),
        float(coupler.height),
        float("inf") if line is None or isinstance(line, str) else float(line.pipe),
    )


def assemble_train(cases: Sequence[Case], coupling: Coupling) -> TrainInputs:
    """Return the inputs of a train.

    Args:
        cases: one for each car, from the leading one, all with the same rail.
        coupling: between them.

    Raises:
        ValueError: where cars differ in what a train has only once, or cannot have their controllers.
    """
    inputs = [assemble(case) for case in cases]
    _check(cases, inputs)
    parameters = np.array([car_inputs.parameters for car_inputs in inputs])
    distances = _distances(parameters, coupling)
    _set_train(parameters, distances, coupling)
    couplers = np.zeros(len(inputs) - 1, COUPLER)
    for name in ("stiffness", "damping", "height"):
        couplers[name] = getattr(coupling, name)
    of_wheelsets = np.array([car_inputs.wheelset_parameters for car_inputs in inputs])
    programs = tuple(car_inputs.program for car_inputs in inputs)
    train = TrainInputs(
        *(parameters, of_wheelsets, distances, couplers, np.ascontiguousarray(inputs[0].rail)),
        *(programs, tuple(car_inputs.config for car_inputs in inputs)),
    )
    return train if len(inputs) == 1 else train._replace(configs=_configs(train))


def _configs(train: TrainInputs) -> tuple[Config | None, ...]:
    """Return the configurations of controllers from outside; the digest in them covers the whole train.

    The SHA-256 is that of the bytes of all records, of the car's index, of the parameters of its program, and
    of the whole programs of the others: as for a car alone, another version of its own has the same stop.
    """
    records = b"".join(np.ascontiguousarray(record).tobytes() for record in train[:5])
    named: list[Any] = [None] * len(train.programs)
    for car, program in enumerate(train.programs):
        if program is not None:
            where = [] if program.sha256 else [program.location]  # where its file lies decides nothing
            named[car] = [program.kind, program.sha256, *where, program.options, program.parameters]

    def of_car(car: int, program: ControllerProgram) -> str:
        programs = [*named[:car], program.parameters, *named[car + 1 :]]
        return hashlib.sha256(records + json.dumps([car, programs]).encode()).hexdigest()

    return tuple(
        None if program is None or config is None else replace(config, case_sha256=of_car(car, program))
        for car, (program, config) in enumerate(zip(train.programs, train.configs, strict=True))
    )


def _check(cases: Sequence[Case], inputs: Sequence[StopInputs]) -> None:
    if not inputs:
        raise ValueError("a train has at least one car")
    for number, case in enumerate(cases, start=1):
        if case.scenario.rail != cases[0].scenario.rail:
            raise ValueError(f"car {number}: its rail is not that of the first car")
    for car, problem in program_problems([car_inputs.program for car_inputs in inputs]):
        raise ValueError(f"car {car + 1}: {problem.message}; {problem.hint}")
    for number, car_inputs in enumerate(inputs, start=1):
        for name in _SHARED:
            value, expected = car_inputs.parameters[name], inputs[0].parameters[name]
            if value != expected:
                raise ValueError(f"car {number}: {name} is {value:g}, that of the first car is {expected:g}")


def _distances(parameters: NDArray[Any], coupling: Coupling) -> NDArray[np.float64]:
    """Return the distance of each car's first wheelset behind that of the train, m, shape (n,)."""
    ahead = parameters["half_pivot_distance"] + parameters["half_wheelbase"]
    distances: NDArray[np.float64] = coupling.distance * np.arange(len(parameters)) + ahead[0] - ahead
    if np.any(np.diff(distances) <= 2.0 * ahead[:-1]):
        raise ValueError("the wheelsets of neighbouring cars overlap: their distance is too small")
    return distances


def _set_train(parameters: NDArray[Any], distances: NDArray[np.float64], coupling: Coupling) -> None:
    """Set what a car has because it runs in a train: grid of the rail, delay of the command, noise."""
    between = (
        np.diff(distances) - 2.0 * (parameters["half_pivot_distance"] + parameters["half_wheelbase"])[:-1]
    )
    finest = (POINTS - 2 * MARGIN) / between.max(initial=0.0) if between.size else np.inf
    parameters["rail_points_per_metre"] = min(parameters["rail_points_per_metre"].min(), finest)
    if parameters["has_sanders"].any():
        _set_sand(parameters, between.max(initial=0.0))
    delays = coupling.distance * np.arange(len(parameters)) / coupling.pipe_speed
    parameters["dead_time"] += delays
    parameters["track_brake_first"] += delays
    for name in ("command_times", "command_given"):
        parameters[name] += delays[:, None]
    keys = parameters["noise_key"] ^ (np.arange(len(parameters)) * _KEY_STEP & 0xFFFFFFFF)
    parameters["noise_key"] = keys


def _set_sand(parameters: NDArray[Any], largest_gap: float) -> None:
    """Let every car keep the sand that any of them lays, on one grid."""
    lays = parameters["has_sanders"] > 0.0
    for name in ("sand_points", "sand_densities", "sand_shares", "sand_friction", "sand_kept"):
        parameters[name] = parameters[name][lays][0]
    first = parameters[0]
    of_train = sand_grid(largest_gap, float(first["initial_speed"]), float(first["cycle_time"]))
    finest = parameters["sand_points_per_metre"][lays].min()
    parameters["sand_points_per_metre"] = min(finest, of_train)
    parameters["has_sanders"] = 1.0

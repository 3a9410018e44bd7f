"""The records of a stop: of one car, and of a train, car by car."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from uictest.core.measures import StopMeasures, WheelsetMeasures
from uictest.rig.model.parameters import Parameters, WheelsetParameters
from uictest.rig.model.rail import RailMemory
from uictest.rig.model.state import Bogie, Car, Coupler, Wheelset


class CarRecords(NamedTuple):
    """State, parameters and measures of one car with two bogies and four wheelsets."""

    car: Car
    bogies: Sequence[Bogie]
    wheelsets: Sequence[Wheelset]
    parameters: Parameters
    wheelset_parameters: Sequence[WheelsetParameters]
    memory: RailMemory
    measures: StopMeasures
    wheelset_measures: Sequence[WheelsetMeasures]


class TrainRecords(NamedTuple):
    """Records of a train of n cars, in its order; a car alone is a train of one.

    Attributes:
        cars: n records.
        bogies: 2 n records.
        wheelsets: 4 n records.
        parameters: n records with one step and one length of the controller cycle.
        wheelset_parameters: 4 n records.
        memories: n records.
        measures: n records.
        wheelset_measures: 4 n records.
        distances: of each car's first wheelset behind that of the train, m, n numbers.
        couplers: n - 1 records, with their numbers set.
        rail: friction laws, the rows of :mod:`uictest.rig.model.rail`; places count from the first wheelset.
    """

    cars: Sequence[Car]
    bogies: Sequence[Bogie]
    wheelsets: Sequence[Wheelset]
    parameters: Sequence[Parameters]
    wheelset_parameters: Sequence[WheelsetParameters]
    memories: Sequence[RailMemory]
    measures: Sequence[StopMeasures]
    wheelset_measures: Sequence[WheelsetMeasures]
    distances: Sequence[float]
    couplers: Sequence[Coupler]
    rail: Any


def car_of(train: TrainRecords, j: int) -> CarRecords:
    """Return the records of car ``j``, counted from 0."""
    return CarRecords(
        train.cars[j],
        train.bogies[2 * j : 2 * j + 2],
        train.wheelsets[4 * j : 4 * j + 4],
        train.parameters[j],
        train.wheelset_parameters[4 * j : 4 * j + 4],
        train.memories[j],
        train.measures[j],
        train.wheelset_measures[4 * j : 4 * j + 4],
    )


class Needs(NamedTuple):
    """Number of steps in a controller cycle, and the parts of the model that a rig needs."""

    steps: int
    pole_wheels: bool
    line_pressure: bool
    tanks: bool
    leaks: bool
    calipers: bool
    disc_temperature: bool
    dynamic_brake: bool
    track_brake: bool


def needs_of(p: Parameters) -> Needs:
    """Return the needs of a rig."""
    return Needs(
        p.steps_per_cycle,
        p.uses_pole_wheels > 0.0,
        p.uses_module_air > 0.0,
        p.uses_module_air > 0.0 and p.calipers < 4,
        p.has_leaks > 0.0,
        p.calipers > 1,
        p.models_disc_temperature > 0.0,
        p.has_dynamic_brake > 0.0,
        p.has_track_brake > 0.0,
    )


def needs_of_both(one: Needs, other: Needs) -> Needs:
    """Return the needs of two rigs that run side by side, with equal numbers of steps in a cycle."""
    return Needs(
        other.steps,
        one.pole_wheels or other.pole_wheels,
        one.line_pressure or other.line_pressure,
        one.tanks or other.tanks,
        one.leaks or other.leaks,
        one.calipers or other.calipers,
        one.disc_temperature or other.disc_temperature,
        one.dynamic_brake or other.dynamic_brake,
        one.track_brake or other.track_brake,
    )

"""One stop of a train, or of a car alone: what the rig is given for it, and what it leaves.

The stop runs in machine code: to standstill, or one controller cycle after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import EXCHANGE, Config, ControllerProgram, ResponseTimes
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.records import TrainRecords
from uictest.rig.model.state import BOGIE, CAR, COUPLER, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace

_CARS, _POINTS, _ROOM = Length("cars"), Length("points"), Length("room")
_TRAIN: Final = TrainRecords(
    *(at(CAR, _CARS), at(BOGIE, 2 * _CARS), at(WHEELSET, 4 * _CARS), at(PARAMETERS, _CARS)),
    *(at(WHEELSET_PARAMETERS, 4 * _CARS), at(RAIL_MEMORY, _CARS)),
    *(at(STOP_MEASURES, _CARS), at(WHEELSET_MEASURES, 4 * _CARS)),
    *(at("f8", _CARS), at(COUPLER, _CARS - 1), at("f8", ROWS, _POINTS)),
)
_TRACE: Final = Trace(at(TRAIN_SAMPLE, _CARS, _ROOM), at(WHEELSET_SAMPLE, _CARS, _ROOM, 4))
_PRESENT: Final = Trace(at(TRAIN_SAMPLE, _CARS, 1), at(WHEELSET_SAMPLE, _CARS, 1, 4))
RUN: Final = Entry("uictest.rig.model.train:run_train", (_TRAIN, _TRACE, int))
STEP: Final = Entry(
    "uictest.rig.model.train:step_train", (_TRAIN, at(EXCHANGE, _CARS), _PRESENT, _TRACE, int, int)
)
RunTrain = Callable[[Any, Any, int], int]
""":func:`uictest.rig.model.train.run_train`, plain or compiled."""


@cache
def compiled_rig() -> RunTrain:
    """Return :func:`uictest.rig.model.train.run_train` compiled.

    It releases the interpreter's lock while it runs, and raises TypeError where a record does not have the
    compiled layout.
    """
    return native_function(RUN)


class StopInputs(NamedTuple):
    """Inputs of the rig for one stop of a car alone.

    Attributes:
        parameters: record of :data:`~uictest.rig.model.parameters.PARAMETERS`.
        wheelset_parameters: four records of :data:`~uictest.rig.model.parameters.WHEELSET_PARAMETERS`.
        rail: friction of the rail, the rows of :mod:`~uictest.rig.model.rail`, shape (4, n).
        program: what is loaded where the controller comes from outside, else None.
        config: what that controller is given before the stop, else None.
    """

    parameters: Any
    wheelset_parameters: Any
    rail: NDArray[np.float64]
    program: ControllerProgram | None = None
    config: Config | None = None


def stacked(stops: Sequence[StopInputs]) -> tuple[NDArray[Any], NDArray[Any], NDArray[np.float64]]:
    """Return the parameters of stops, those of their wheelsets and their rails, as lanes are given them.

    Shapes are (n,), (n, 4) and (n, 4, points); shorter rails end in zeros: their length is in the parameters.
    """
    parameters = np.array([stop.parameters for stop in stops], stops[0].parameters.dtype)
    rail = np.zeros((len(stops), stops[0].rail.shape[0], max(stop.rail.shape[1] for stop in stops)))
    for k, stop in enumerate(stops):
        rail[k, :, : stop.rail.shape[1]] = stop.rail
    return parameters, np.array([stop.wheelset_parameters for stop in stops]), rail


class TrainInputs(NamedTuple):
    """Inputs of the rig for one stop of a train of n cars.

    Attributes:
        parameters: records of :data:`~uictest.rig.model.parameters.PARAMETERS`, shape (n,).
        wheelset_parameters: of :data:`~uictest.rig.model.parameters.WHEELSET_PARAMETERS`, (n, 4).
        distances: of each car's first wheelset behind that of the train, m, shape (n,).
        couplers: records of :data:`~uictest.rig.model.state.COUPLER` before the stop, shape (n - 1,).
        rail: friction of the rail, the rows of :mod:`~uictest.rig.model.rail`, shape (4, points).
        programs: for each car what is loaded where its controller comes from outside, else None.
        configs: what those controllers are given before the stop, else None.
    """

    parameters: NDArray[Any]
    wheelset_parameters: NDArray[Any]
    distances: NDArray[np.float64]
    couplers: NDArray[Any]
    rail: NDArray[np.float64]
    programs: tuple[ControllerProgram | None, ...]
    configs: tuple[Config | None, ...]

    @property
    def from_outside(self) -> dict[int, ControllerProgram]:
        """The programs of the cars whose controllers come from outside, by the index of the car."""
        return {car: program for car, program in enumerate(self.programs) if program is not None}


def alone(inputs: StopInputs) -> TrainInputs:
    """Return the inputs of a stop of a car alone as those of a train of one."""
    return TrainInputs(
        *(np.array([inputs.parameters]), inputs.wheelset_parameters[None], np.zeros(1), np.zeros(0, COUPLER)),
        *(np.ascontiguousarray(inputs.rail), (inputs.program,), (inputs.config,)),
    )


@dataclass(frozen=True)
class FinishedStop:
    """Results of a stop of one car: its measures, the final state and, if requested, the trace.

    Of a controller from outside also the version that it names, how it answered if cycles were paced by the
    clock, the version of the contract, and what it printed, where that is kept.
    """

    measures: Any
    wheelset_measures: Any
    car: Any
    wheelsets: Any
    trace: Trace
    controller_version: str = ""
    response_times: ResponseTimes | None = None
    contract: int = 1
    controller_output: str = ""


class TrainStop(NamedTuple):
    """A finished stop of a train.

    Attributes:
        cars: what each car leaves, in the order of the train.
        couplers: records of :data:`~uictest.rig.model.state.COUPLER`, one behind each car but the last.
        parameters: of every car.
    """

    cars: tuple[FinishedStop, ...]
    couplers: NDArray[Any]
    parameters: NDArray[Any]


def run_to_end(run_train: RunTrain, inputs: StopInputs, steps_per_sample: int = 0) -> FinishedStop:
    """Run a stop of a car alone on fresh records; arguments as for :func:`run_train_to_end`."""
    [finished] = run_train_to_end(run_train, alone(inputs), steps_per_sample).cars
    return finished


def run_train_to_end(run_train: RunTrain, inputs: TrainInputs, steps_per_sample: int = 0) -> TrainStop:
    """Run a stop of a train on fresh records.

    Args:
        run_train: :func:`uictest.rig.model.train.run_train`, plain or compiled.
        inputs: of its cars, and of what couples them; the ledgers of its couplers are filled.
        steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
    """
    given: Any = inputs
    zeros: Any = np.zeros
    n = len(inputs.parameters)
    train = TrainRecords(
        *(zeros(n, CAR), zeros(2 * n, BOGIE), zeros(4 * n, WHEELSET), given.parameters),
        *(given.wheelset_parameters.reshape(-1), zeros(n, RAIL_MEMORY)),
        *(zeros(n, STOP_MEASURES), zeros(4 * n, WHEELSET_MEASURES)),
        *(given.distances, given.couplers, given.rail),
    )
    trace = empty_trace(n, rows_of_trace(inputs.parameters[0], steps_per_sample))
    rows = run_train(train, trace, steps_per_sample)
    return TrainStop(finished_cars(train, trace, rows), inputs.couplers, inputs.parameters)


def rows_of_trace(parameters: Any, steps_per_sample: int) -> int:
    """Return the rows of the longest trace of a stop; 0 steps per sample: none."""
    if steps_per_sample == 0:
        return 0
    return int(parameters["cycles"] * parameters["steps_per_cycle"]) // steps_per_sample + 1


def empty_trace(cars: int, rows: int) -> Trace:
    """Return the trace of a train with so many rows, not yet filled."""
    return Trace(np.empty((cars, rows), TRAIN_SAMPLE), np.empty((cars, rows, 4), WHEELSET_SAMPLE))


def finished_cars(train: TrainRecords, trace: Trace, rows: int) -> tuple[FinishedStop, ...]:
    """Return the finished stop of each car of a train; changes its measures in place.

    Args:
        train: records of a stop that has ended.
        trace: samples of every car, shapes (n, room) and (n, room, 4).
        rows: of the trace that are filled.
    """
    measures: Any = train.measures
    wheelset_measures, wheelsets = (
        np.asarray(records).view(np.recarray) for records in (train.wheelset_measures, train.wheelsets)
    )
    note_track_brakes_beside(measures)
    return tuple(
        FinishedStop(
            measures[j],
            wheelset_measures[4 * j : 4 * j + 4],
            train.cars[j],
            wheelsets[4 * j : 4 * j + 4],
            Trace(trace.train[j, :rows], trace.wheelsets[j, :rows]),
        )
        for j in range(len(train.cars))
    )


def note_track_brakes_beside(measures: NDArray[Any]) -> None:
    """Note in the measures of every car for how long track brakes of the others acted: they slow it, too.

    Args:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (n, ...), of n cars; changed.
    """
    for car in range(len(measures)):
        others = np.delete(measures["track_brake_time"], car, axis=0)
        if others.size:
            measures["track_brake_time_beside"][car] = np.fmax.reduce(others, axis=0)

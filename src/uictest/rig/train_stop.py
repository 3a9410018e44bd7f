"""One stop of a train, or of a car alone: what the rig is given for it, and what it leaves."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ControllerProgram
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.stops import RunTrain
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.records import TrainRecords
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.single_stop import FinishedStop, StopInputs, rows_of_trace
from uictest.rig.train_measures import finished_cars


class TrainInputs(NamedTuple):
    """What the rig is given for one stop of a train of n cars.

    Attributes:
        parameters: records of :data:`~uictest.rig.model.parameters.PARAMETERS`, shape (n,).
        wheelset_parameters: of :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`, (n, 4).
        distances: of each car's first wheelset behind that of the train, m, shape (n,).
        couplers: records of :data:`~uictest.rig.model.couplers.COUPLER` before the stop, shape (n - 1,).
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
        """The programs of the cars whose controllers come from outside, by their places from 0."""
        return {place: each for place, each in enumerate(self.programs) if each is not None}


class TrainStop(NamedTuple):
    """A finished stop of a train.

    Attributes:
        cars: what each car leaves, in the order of the train.
        couplers: records of :data:`~uictest.rig.model.couplers.COUPLER`, one behind each car but the last.
        parameters: of every car.
    """

    cars: tuple[FinishedStop, ...]
    couplers: NDArray[Any]
    parameters: NDArray[Any]


def alone(inputs: StopInputs) -> TrainInputs:
    """Return the inputs of a stop of a car alone as those of a train of one."""
    return TrainInputs(
        *(np.array([inputs.parameters]), inputs.wheelset_parameters[None], np.zeros(1), np.zeros(0, COUPLER)),
        *(np.ascontiguousarray(inputs.rail), (inputs.program,), (inputs.config,)),
    )


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
    train = _fresh_records(inputs)
    trace = empty_trace(len(train.cars), rows_of_trace(inputs.parameters[0], steps_per_sample))
    rows = run_train(train, trace, steps_per_sample)
    return TrainStop(finished_cars(train, trace, rows), inputs.couplers, inputs.parameters)


def _fresh_records(inputs: TrainInputs) -> TrainRecords:
    """Return the records of a stop that has not begun."""
    given: Any = inputs

    def zeroed(layout: Any, each: int = 1) -> Any:
        return np.zeros(each * len(inputs.parameters), layout)

    return TrainRecords(
        *(zeroed(CAR), zeroed(BOGIE, 2), zeroed(WHEELSET, 4), given.parameters),
        *(given.wheelset_parameters.reshape(-1), zeroed(RAIL_MEMORY)),
        *(zeroed(STOP_MEASURES), zeroed(WHEELSET_MEASURES, 4)),
        *(given.distances, given.couplers, given.rail),
    )


def empty_trace(cars: int, rows: int) -> Trace:
    """Return the trace of a train with so many rows, not yet filled."""
    return Trace(np.empty((cars, rows), TRAIN_SAMPLE), np.empty((cars, rows, 4), WHEELSET_SAMPLE))

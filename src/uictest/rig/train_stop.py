"""One stop of a train of coupled cars: what the rig is given for it, and what it leaves."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ControllerProgram
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.single_stop import FinishedStop, rows_of_trace
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


def run_train_to_end(
    run_train: Callable[..., int], inputs: TrainInputs, steps_per_sample: int = 0
) -> TrainStop:
    """Run a stop of a train on fresh records.

    Args:
        run_train: :func:`uictest.rig.model.train.run_train`, plain or compiled.
        inputs: of its cars, and of what couples them; the ledgers of its couplers are filled.
        steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
    """
    parameters, of_wheelsets, distances, couplers, rail, *_ = inputs
    n = len(parameters)
    records = [np.zeros(n * each, layout) for layout, each in ((CAR, 1), (BOGIE, 2), (WHEELSET, 4))]
    measures, of_each = np.zeros(n, STOP_MEASURES), np.zeros(4 * n, WHEELSET_MEASURES)
    room = rows_of_trace(parameters[0], steps_per_sample)
    samples, wheelset_samples = np.empty((n, room), TRAIN_SAMPLE), np.empty((n, room, 4), WHEELSET_SAMPLE)
    rows = run_train(
        *(*records, parameters, of_wheelsets.reshape(-1), distances, couplers, rail),
        *(np.zeros(n, RAIL_MEMORY), measures, of_each, samples, wheelset_samples, steps_per_sample),
    )
    trace = Trace(samples[:, :rows], wheelset_samples[:, :rows])
    return TrainStop(finished_cars(measures, of_each, records[0], records[2], trace), couplers, parameters)

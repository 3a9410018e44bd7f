"""A stop of several coupled cars: each car a case of its own, all on one rail."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.plans.scenario import Case
from uictest.rig.backends.trains import compiled_train
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.single_stop import FinishedStop, rows_of_trace
from uictest.rig.train_inputs import Coupling, assemble_train
from uictest.rig.train_measures import finished_cars


class CouplerPeaks(NamedTuple):
    """The largest forces with which a coupler pulled and pushed, N."""

    pull: float
    push: float


def peaks_beside(couplers: NDArray[Any]) -> list[tuple[CouplerPeaks | None, CouplerPeaks | None]]:
    """Return those of the couplers ahead of and behind each car, None where there is none.

    Args:
        couplers: records of :data:`~uictest.rig.model.couplers.COUPLER`, from the leading one.
    """
    peaks = [CouplerPeaks(float(each["largest_pull"]), float(each["largest_push"])) for each in couplers]
    return list(pairwise([None, *peaks, None]))


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


def run_coupled(
    cases: Sequence[Case],
    coupling: Coupling,
    steps_per_sample: int = 0,
    run: Callable[..., int] | None = None,
) -> TrainStop:
    """Run one stop of a train. The first call on a machine compiles it, within half a minute.

    Args:
        cases: one for each car, from the leading one, all with the same rail.
        coupling: between them.
        steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
        run: what runs it [default: the compiled :func:`~uictest.rig.model.train.run_train`].

    Raises:
        ValueError: where cars differ in what a train has only once, or a controller comes from outside.
    """
    parameters, of_wheelsets, distances, couplers, rail = assemble_train(cases, coupling)
    n = len(parameters)
    records = [np.zeros(n * each, layout) for layout, each in ((CAR, 1), (BOGIE, 2), (WHEELSET, 4))]
    measures, of_each = np.zeros(n, STOP_MEASURES), np.zeros(4 * n, WHEELSET_MEASURES)
    room = rows_of_trace(parameters[0], steps_per_sample)
    samples, wheelset_samples = np.empty((n, room), TRAIN_SAMPLE), np.empty((n, room, 4), WHEELSET_SAMPLE)
    rows = (run or compiled_train())(
        *(*records, parameters, of_wheelsets.reshape(-1), distances, couplers, rail),
        *(np.zeros(n, RAIL_MEMORY), measures, of_each, samples, wheelset_samples, steps_per_sample),
    )
    trace = Trace(samples[:, :rows], wheelset_samples[:, :rows])
    finished = finished_cars(measures, of_each, records[0], records[2], trace)
    return TrainStop(finished, couplers, parameters)

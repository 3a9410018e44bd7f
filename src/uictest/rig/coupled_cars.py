"""A stop of several coupled cars: each car a case of its own, all on one rail."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from numpy.typing import NDArray

from uictest.plans.scenario import Case
from uictest.rig.external.workers import RunTrain, Workers
from uictest.rig.train_inputs import Coupling, assemble_train
from uictest.rig.train_stop import TrainStop


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


def run_coupled(
    cases: Sequence[Case],
    coupling: Coupling,
    steps_per_sample: int = 0,
    run: RunTrain | None = None,
) -> TrainStop:
    """Run one stop of a train.

    Args:
        cases: one for each car, from the leading one, all with the same rail.
        coupling: between them.
        steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
        run: what runs it [default: a child process if a controller comes from outside].

    Raises:
        ValueError: where cars differ in what a train has only once, or cannot have their controllers.
        ControllerError: when a controller from outside failed.
    """
    inputs = assemble_train(cases, coupling)
    if run is not None:
        return run(inputs, steps_per_sample)
    with Workers() as workers:
        return workers.run_train(inputs, steps_per_sample)

"""Many stops at once: their measures, and how batches are split where cases must not run together."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Controller


class BatchMeasures(NamedTuple):
    """Measures of many stops, in the order of the cases.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (cases,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (cases, 4).
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]


def cases_by_controller(controllers: Sequence[Controller]) -> Iterator[tuple[Controller, NDArray[np.int64]]]:
    """Yield each controller with the numbers of the cases that have it: a compiled stop is made for one."""
    names = np.array([controller.name for controller in controllers])
    for controller in {controller.name: controller for controller in controllers}.values():
        yield controller, np.flatnonzero(names == controller.name)

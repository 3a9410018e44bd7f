"""What a stop of a train leaves of each car, and what its measures say of the other cars."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.rig.model.trace import Trace
from uictest.rig.single_stop import FinishedStop


def finished_cars(
    measures: NDArray[Any],
    of_wheelsets: NDArray[Any],
    cars: NDArray[Any],
    wheelsets: NDArray[Any],
    trace: Trace,
) -> tuple[FinishedStop, ...]:
    """Return what the stop of n cars leaves of each.

    Args:
        measures: n records; changed.
        of_wheelsets: measures of the wheelsets, 4 n records.
        cars: n records.
        wheelsets: 4 n records.
        trace: samples of every car, shapes (n, rows) and (n, rows, 4).
    """
    note_track_brakes_beside(measures)
    return tuple(
        FinishedStop(
            measures[j],
            of_wheelsets[4 * j : 4 * j + 4].view(np.recarray),
            cars[j],
            wheelsets[4 * j : 4 * j + 4].view(np.recarray),
            Trace(trace.train[j], trace.wheelsets[j]),
        )
        for j in range(len(cars))
    )


def note_track_brakes_beside(measures: NDArray[Any]) -> None:
    """Note in the measures of every car for how long track brakes of the others acted: they slow it, too.

    Args:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (n, ...), of n cars; changed.
    """
    for place in range(len(measures)):
        others = np.delete(measures["track_brake_time"], place, axis=0)
        if others.size:
            measures["track_brake_time_beside"][place] = np.fmax.reduce(others, axis=0)

"""What a stop of a train leaves of each car, and what its measures say of the other cars."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.rig.model.records import TrainRecords
from uictest.rig.model.trace import Trace
from uictest.rig.single_stop import FinishedStop


def finished_cars(train: TrainRecords, trace: Trace, rows: int) -> tuple[FinishedStop, ...]:
    """Return what the stop of a train leaves of each car; its measures are changed.

    Args:
        train: records of a stop that has ended.
        trace: samples of every car, shapes (n, room) and (n, room, 4).
        rows: of the trace that are filled.
    """
    measures: Any = train.measures
    of_wheelsets, wheelsets = (
        np.asarray(each).view(np.recarray) for each in (train.wheelset_measures, train.wheelsets)
    )
    note_track_brakes_beside(measures)
    return tuple(
        FinishedStop(
            measures[j],
            of_wheelsets[4 * j : 4 * j + 4],
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
    for place in range(len(measures)):
        others = np.delete(measures["track_brake_time"], place, axis=0)
        if others.size:
            measures["track_brake_time_beside"][place] = np.fmax.reduce(others, axis=0)

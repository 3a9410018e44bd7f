"""What the measures of a car say of the other cars of its train."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def note_track_brakes_beside(measures: NDArray[Any]) -> None:
    """Note in the measures of every car for how long track brakes of the others acted: they slow it, too.

    Args:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (n, ...), of n cars; changed.
    """
    for place in range(len(measures)):
        others = np.delete(measures["track_brake_time"], place, axis=0)
        if others.size:
            measures["track_brake_time_beside"][place] = np.fmax.reduce(others, axis=0)

"""Run a stop on records: allocate, step, return."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.model.records import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import ROW


@dataclass(frozen=True)
class SteppedStop:
    """What a stop leaves: its measures, the final state and, when asked for, the trace."""

    measures: Any
    wheelset_measures: Any
    car: Any
    wheelsets: Any
    trace: NDArray[np.float64]


def run(stop: Any, parameters: Any, rail: NDArray[np.float64], steps_per_sample: int) -> SteppedStop:
    """Run ``stop``, plain or compiled, on fresh records."""
    car = np.zeros(1, CAR)
    bogies = np.zeros(2, BOGIE)
    wheelsets = np.zeros(4, WHEELSET)
    measures = np.zeros(1, STOP_MEASURES)
    wheelset_measures = np.zeros(4, WHEELSET_MEASURES)
    trace = np.empty((_rows(parameters, steps_per_sample), ROW))
    rows = stop(
        car[0], bogies, wheelsets, parameters, rail, measures[0], wheelset_measures, trace, steps_per_sample
    )
    return SteppedStop(
        measures[0], wheelset_measures.view(np.recarray), car[0], wheelsets.view(np.recarray), trace[:rows]
    )


def _rows(parameters: Any, steps_per_sample: int) -> int:
    if steps_per_sample == 0:
        return 0
    return int(parameters.cycles * parameters.steps_per_cycle) // steps_per_sample + 1

"""Run one stop on fresh records and keep what it leaves."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from uictest.controllers import ResponseTimes
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.model.rail_memory import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.noise_key import StopInputs

RunStop = Callable[..., int]
""":func:`uictest.rig.model.stop.run_stop` made for one controller, plain or compiled."""


@dataclass(frozen=True)
class FinishedStop:
    """What a stop leaves: its measures, the final state and, if requested, the trace.

    Of a controller from outside also the version that it names, and how it answered if cycles were paced by
    the clock.
    """

    measures: Any
    wheelset_measures: Any
    car: Any
    wheelsets: Any
    trace: Trace
    controller_version: str = ""
    response_times: ResponseTimes | None = None


def run_to_end(run_stop: RunStop, inputs: StopInputs, steps_per_sample: int = 0) -> FinishedStop:
    """Run a stop on fresh records.

    Args:
        run_stop: what runs the stop, made for the controller of ``inputs``.
        inputs: parameters, those of the wheelsets, rail and controller.
        steps_per_sample: base steps from one sample of the trace to the next; 0: no trace.
    """
    parameters = inputs.parameters
    car = np.zeros(1, CAR)
    bogies = np.zeros(2, BOGIE)
    wheelsets = np.zeros(4, WHEELSET)
    measures = np.zeros(1, STOP_MEASURES)
    wheelset_measures = np.zeros(4, WHEELSET_MEASURES)
    trace = empty_trace(rows_of_trace(parameters, steps_per_sample))
    rows = run_stop(
        *(car[0], bogies, wheelsets, parameters, inputs.wheelset_parameters),
        *(inputs.rail, np.zeros(1, RAIL_MEMORY)[0]),
        *(measures[0], wheelset_measures, trace, steps_per_sample),
    )
    return FinishedStop(
        measures[0],
        wheelset_measures.view(np.recarray),
        car[0],
        wheelsets.view(np.recarray),
        Trace(trace.train[:rows], trace.wheelsets[:rows]),
    )


def empty_trace(rows: int) -> Trace:
    """Return a trace with so many rows, not yet filled."""
    return Trace(np.empty(rows, TRAIN_SAMPLE), np.empty((rows, 4), WHEELSET_SAMPLE))


def rows_of_trace(parameters: Any, steps_per_sample: int) -> int:
    """Return the rows of the longest trace of a stop; 0 steps per sample: none."""
    if steps_per_sample == 0:
        return 0
    return int(parameters.cycles * parameters.steps_per_cycle) // steps_per_sample + 1

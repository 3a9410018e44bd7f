"""One stop, carried on one controller cycle at a time by somebody else's program."""

from collections.abc import Sequence
from typing import Any

from uictest.controllers import NO_FAILURE
from uictest.core.measures import StopMeasures, WheelsetMeasures
from uictest.rig.model.controller import FROM_OUTSIDE
from uictest.rig.model.external_controller import read_outputs, write_inputs
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail_memory import RailMemory
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.stop import begin_cycle, begin_stop, finish_cycle, is_running
from uictest.rig.model.stop_measures import close_stop_measures
from uictest.rig.model.trace import Trace, sample
from uictest.rig.model.wheelset_parameters import WheelsetParameters


def step_stop(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    exchange: Any,
    present: Trace,
    trace: Trace,
    steps_per_sample: int,
    rows: int,
) -> int:
    """Carry out the commands in the exchange for one cycle; on zeroed records, begin the stop instead.

    Afterwards the exchange holds what the sensors show then, and ``present``, a trace of one row, the true
    state. A command that no valve has is only reported in ``exchange.failure``. Returns the number of rows
    that ``trace`` has.
    """
    if exchange.cycles == 0:
        p.controller = FROM_OUTSIDE  # whatever the case names: whoever carries the stop on decides
        begin_stop(car, bogies, wheelsets, p, wheelset_parameters, memory, measures, wheelset_measures)
    else:
        exchange.failure = NO_FAILURE
        read_outputs(exchange, car, wheelsets)
        if exchange.failure != NO_FAILURE:
            return rows
        rows = finish_cycle(
            car, bogies, wheelsets, p, measures, wheelset_measures, trace, steps_per_sample, rows
        )
        if not is_running(car, p):
            close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p)
    # Also at the end: whoever drives the rig sees the sensors at standstill. No measure is taken from this.
    begin_cycle(car, wheelsets, p, wheelset_parameters, rail, memory)
    write_inputs(exchange, car, wheelsets, p)
    exchange.cycles += 1
    sample(present, 0, car, wheelsets, p)
    return rows

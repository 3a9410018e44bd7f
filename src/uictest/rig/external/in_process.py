"""Stops whose controller from outside runs in this process: fast, and nothing is isolated."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from uictest.controllers import shown_version
from uictest.rig.backends.finished_stop import FinishedStop, run_to_end
from uictest.rig.backends.native import compiled_stop
from uictest.rig.external.opened import empty_exchange, opened
from uictest.rig.stop_inputs import StopInputs

RunInputs = Callable[[StopInputs, int], FinishedStop]
"""Runs a stop, with so many base steps between two samples of its trace: here or in a child process."""


def run_in_process(inputs: StopInputs, steps_per_sample: int = 0, exchange: Any = None) -> FinishedStop:
    """Run a stop with its controller, built in or from outside, in this process.

    Args:
        inputs: parameters, rail and controller.
        steps_per_sample: base steps from one sample of the trace to the next; 0: no trace.
        exchange: zeroed record of :data:`~uictest.controllers.EXCHANGE` [default: memory of its own].

    Raises:
        ControllerError: when a controller from outside cannot be opened, or failed.
    """
    run_stop = compiled_stop()
    if inputs.program is None or inputs.config is None:
        return run_to_end(run_stop, inputs, steps_per_sample)
    exchange = empty_exchange() if exchange is None else exchange
    with opened(inputs.program, inputs.config, inputs.parameters, exchange) as controller:
        finished = run_to_end(run_stop, inputs, steps_per_sample)
    version = shown_version(controller.version)
    return replace(finished, controller_version=version, response_times=controller.response_times)


def in_real_time(run: RunInputs) -> RunInputs:
    """Return what runs a stop as `run` does, its cycles paced by the clock."""

    def run_in_real_time(inputs: StopInputs, steps_per_sample: int = 0) -> FinishedStop:
        if inputs.program is None:
            raise ValueError("a built-in controller is not paced by the clock")
        paced = replace(inputs.program, real_time=True)
        return run(inputs._replace(program=paced), steps_per_sample)

    return run_in_real_time

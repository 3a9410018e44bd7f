"""Stops as messages: what a child process needs to run them, and what they leave."""

from typing import Any, Final

import numpy as np

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.finished_stop import FinishedStop
from uictest.rig.external.block import BlockInputs, BlockRun
from uictest.rig.external.controller_messages import bytes_of, read_controller, written_controllers
from uictest.rig.external.messages import Message
from uictest.rig.model.friction_law import ROWS
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.state import CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.stop_inputs import StopInputs

_STOP: Final = (STOP_MEASURES, WHEELSET_MEASURES, CAR, WHEELSET, TRAIN_SAMPLE, WHEELSET_SAMPLE)


def stop_message(inputs: StopInputs, steps_per_sample: int) -> Message:
    """Return a stop with a controller from outside as a message."""
    records = inputs.parameters, inputs.wheelset_parameters, inputs.rail
    head = {
        "request": "stop",
        "steps_per_sample": steps_per_sample,
        "controllers": written_controllers([inputs.program], [inputs.config]),
    }
    return Message(head, bytes_of(records))


def stop_of(message: Message) -> tuple[StopInputs, int]:
    """Return the stop in a message, and the base steps from one sample of its trace to the next."""
    inputs = block_of(message)
    first = inputs.parameters[0], inputs.wheelset_parameters[0], inputs.rail[0]
    return StopInputs(*first, inputs.programs[0], inputs.configs[0]), message.head["steps_per_sample"]


def finished_message(finished: FinishedStop) -> Message:
    """Return what a stop leaves as a message."""
    own = finished.measures, finished.wheelset_measures, finished.car, finished.wheelsets
    head = {"controller_version": finished.controller_version}
    return Message(head, bytes_of((*own, *finished.trace)))


def finished_of(message: Message) -> FinishedStop:
    """Return what a stop has left."""
    arrays: list[Any] = [np.frombuffer(*each) for each in zip(message.blocks, _STOP, strict=True)]
    measures, wheelset_measures, car, wheelsets, train, samples = arrays
    return FinishedStop(
        measures[0],
        wheelset_measures.view(np.recarray),
        car[0],
        wheelsets.view(np.recarray),
        Trace(train, samples.reshape(-1, 4)),
        message.head["controller_version"],
    )


def block_message(inputs: BlockInputs) -> Message:
    """Return stops that all have controllers from outside as a message."""
    head = {"request": "block", "controllers": written_controllers(inputs.programs, inputs.configs)}
    return Message(head, bytes_of((inputs.parameters, inputs.wheelset_parameters, inputs.rail)))


def block_of(message: Message) -> BlockInputs:
    """Return the stops in a message."""
    parameters, wheelset_parameters, rail = message.blocks
    programs, configs = zip(*map(read_controller, message.head["controllers"]), strict=True)
    count = len(programs)
    return BlockInputs(
        programs,
        configs,
        np.frombuffer(bytearray(parameters), PARAMETERS),
        np.frombuffer(bytearray(wheelset_parameters), WHEELSET_PARAMETERS).reshape(count, 4),
        np.frombuffer(rail).reshape(count, ROWS, -1),
    )


def run_message(run: BlockRun) -> Message:
    """Return what stops leave as a message."""
    return Message({"failures": run.failures}, bytes_of((run.measures, run.wheelset_measures)))


def run_of(message: Message) -> BlockRun:
    """Return what stops have left."""
    measures, wheelset_measures = message.blocks
    return BlockRun(
        np.frombuffer(measures, STOP_MEASURES),
        np.frombuffer(wheelset_measures, WHEELSET_MEASURES).reshape(-1, 4),
        message.head["failures"],
    )

"""A block of stops, some or all with controllers from outside, in one process.

Controllers in machine code are called by address, lane by lane. Others run their stops one after the other:
they need the interpreter, or can have only one controller at a time.
"""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import EXCHANGE, Config, ControllerError, ControllerProgram
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.stops import compiled_rig
from uictest.rig.external.in_process import opened
from uictest.rig.single_stop import StopInputs
from uictest.rig.train_stop import run_to_end


class BlockRun(NamedTuple):
    """What a block of stops leaves.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (cases,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (cases, 4).
        failures: for each case why its controller failed, empty where it did not; the measures of a case
            that failed mean nothing.
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]
    failures: list[str]


class BlockInputs(NamedTuple):
    """What a block of stops is run with.

    Attributes:
        programs: the controller of each case that comes from outside, None where it is built in.
        configs: what those controllers are given before the stop.
        parameters: as for :func:`~uictest.rig.backends.lanes.run_in_lanes`; the addresses of controllers from
            outside are written into them.
        wheelset_parameters: likewise.
        rail: likewise.
    """

    programs: Sequence[ControllerProgram | None]
    configs: Sequence[Config | None]
    parameters: NDArray[Any]
    wheelset_parameters: NDArray[Any]
    rail: NDArray[np.float64]

    def at(self, places: Sequence[int]) -> "BlockInputs":
        """Return some of the cases."""
        return BlockInputs(
            [self.programs[place] for place in places],
            [self.configs[place] for place in places],
            *(self.parameters[places], self.wheelset_parameters[places], self.rail[places]),
        )


class _Block(NamedTuple):
    """The stops of a block: what they are run with, what they talk to, what they leave."""

    inputs: BlockInputs
    exchanges: NDArray[Any]
    run: BlockRun


def run_block(inputs: BlockInputs, exchanges: NDArray[Any] | None = None) -> BlockRun:
    """Run the stop of every case; a controller that fails ends its own stop, the others keep their bits.

    Args:
        inputs: the cases.
        exchanges: zeroed records of :data:`~uictest.controllers.EXCHANGE`, one per case, through which the
            controllers are called [default: memory of its own].
    """
    count = len(inputs.programs)
    run = empty_run(count)
    block = _Block(inputs, np.zeros(count, EXCHANGE) if exchanges is None else exchanges, run)
    with ExitStack() as controllers:
        ready = [place for place in range(count) if _is_ready(block, place, controllers)]
        if ready:
            from uictest.rig.backends.lanes import run_in_lanes  # single stops do without them

            own = inputs.at(ready)
            batch = run_in_lanes(own.parameters, own.wheelset_parameters, own.rail)
            run.measures[ready], run.wheelset_measures[ready] = batch
    return run


def empty_run(count: int) -> BlockRun:
    """Return what so many stops leave, not yet filled."""
    return BlockRun(np.zeros(count, STOP_MEASURES), np.zeros((count, 4), WHEELSET_MEASURES), [""] * count)


def _is_ready(block: _Block, place: int, controllers: ExitStack) -> bool:
    """Open the controller of a case, and return whether it waits for the lanes; else its stop is over."""
    program, config = block.inputs.programs[place], block.inputs.configs[place]
    if program is None or config is None:
        return True
    parameters, exchange = block.inputs.parameters[place], block.exchanges[place]
    with ExitStack() as opening:
        # The outer context gets the failure of a stop, which is known when its controller is closed.
        opening.enter_context(_noted(block.run.failures, place))
        controller = opening.enter_context(opened(program, config, parameters, exchange))
        if controller.runs_beside_others:
            controllers.enter_context(opening.pop_all())
            return True
        _run_alone(block, place)
    return False


def _run_alone(block: _Block, place: int) -> None:
    """Run one case whose controller is open and cannot run beside others."""
    own = block.inputs
    records = own.parameters[place], own.wheelset_parameters[place], own.rail[place]
    stop = StopInputs(*records, own.programs[place], own.configs[place])
    finished = run_to_end(compiled_rig(), stop)
    block.run.measures[place] = finished.measures
    block.run.wheelset_measures[place] = finished.wheelset_measures


@contextmanager
def _noted(failures: list[str], place: int) -> Iterator[None]:
    """Keep why the controller of a case failed, instead of raising it."""
    try:
        yield
    except ControllerError as error:
        failures[place] = f"controller: {error}"

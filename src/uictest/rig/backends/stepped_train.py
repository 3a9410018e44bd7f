"""A stop of a train that another program carries on, one controller cycle at a time.

As :mod:`uictest.rig.backends.stepped`, with an exchange for each car.
"""

from typing import Any

import numpy as np

from uictest.rig.backends.machine_code import address, native_function
from uictest.rig.backends.stepped import STOP_MEMORY, addresses_within, of_rail, within_exchanges
from uictest.rig.backends.trains import STEP, STEP_ARGUMENTS, TRAINS
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.single_stop import FinishedStop, rows_of_trace
from uictest.rig.train_measures import finished_cars
from uictest.rig.train_stop import TrainInputs


def train_memory(cars: int) -> Any:
    """Return the layout of everything that changes in a stop of a train: a copy of it is a copy of the stop.

    The parts of :data:`~uictest.rig.backends.stepped.STOP_MEMORY`, each for all cars, and the couplers.
    """
    parts: list[tuple[Any, ...]] = []
    for name in STOP_MEMORY.names:
        part = STOP_MEMORY.fields[name][0]
        first, *rest = part.shape or (1,)
        parts.append((name, part.base, (cars * first, *rest)))
    return np.dtype([*parts, ("couplers", COUPLER, (cars - 1,))])


class SteppedTrain:
    """One stop of a train that is carried on from outside, on memory of its own.

    Attributes:
        memory: record of :func:`train_memory`.
        inputs: of each car, what its sensors show for the coming cycle.
        outputs: of each car, the commands for that cycle.
    """

    def __init__(self, train: TrainInputs, steps_per_sample: int = 0) -> None:
        """Begin the stop; the controllers of the cars play no part.

        Args:
            train: what the rig is given.
            steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
        """
        n = len(train.parameters)
        memory = np.zeros(1, train_memory(n))
        memory["parameters"] = train.parameters
        memory["couplers"] = train.couplers
        self.memory: Any = memory[0]
        self.inputs, self.outputs = within_exchanges(memory, n)
        room = rows_of_trace(train.parameters[0], steps_per_sample)
        self._trace = Trace(np.empty((n, room), TRAIN_SAMPLE), np.empty((n, room, 4), WHEELSET_SAMPLE))
        self._arguments = (
            *(*addresses_within(self.memory), n),
            address(train.wheelset_parameters, WHEELSET_PARAMETERS, (n, 4)),
            *(address(train.distances, np.dtype("f8"), (n,)), *of_rail(train.rail)),
            address(self._trace.train, TRAIN_SAMPLE, (n, room)),
            address(self._trace.wheelsets, WHEELSET_SAMPLE, (n, room, 4)),
            *(room, steps_per_sample),
        )
        self._kept = train  # the machine code reads it by its addresses
        self._step = native_function(TRAINS, STEP, len(STEP_ARGUMENTS))
        self._rows = 0
        self.step()

    @property
    def time(self) -> float:
        """Of the coming cycle, s."""
        return float(self.inputs[0]["time"])

    @property
    def stands(self) -> bool:
        """Whether all cars stand."""
        over = self.memory["car"]["stopped"] > 0.0
        return bool(over.all() and not self.memory["parameters"]["end_speed"].any())

    @property
    def has_ended(self) -> bool:
        """Whether the stop of every car has ended."""
        return bool(self.memory["car"]["closed"].all())

    def step(self) -> None:
        """Carry out the commands in the exchanges until the next cycle; none, where one is refused."""
        self._rows = self._step(*self._arguments, self._rows)

    def finished(self) -> tuple[FinishedStop, ...]:
        """Return what the stop of each car leaves, which must have ended."""
        memory, (of_train, of_wheelsets) = self.memory, self._trace
        return finished_cars(
            *(memory["measures"].copy(), memory["wheelset_measures"], memory["car"], memory["wheelsets"]),
            Trace(of_train[:, : self._rows], of_wheelsets[:, : self._rows]),
        )

"""A stop of a train that another program carries on, one controller cycle at a time.

As :mod:`uictest.rig.backends.stepped`, with an exchange for each car.
"""

from typing import Any

import numpy as np

from uictest.core.lanes import passed
from uictest.rig.backends.machine_code import function_of_addresses
from uictest.rig.backends.stepped import STOP_MEMORY, within_exchanges
from uictest.rig.backends.trains import STEP, TRAINS
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
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
        own = self.memory
        present = Trace(own["train"].reshape(n, 1), own["modules"].reshape(n, 1, 4))
        # The machine code reads and writes them by their addresses as long as the stop lasts.
        self._kept = (
            *(own["car"], own["bogies"], own["wheelsets"], own["parameters"]),
            *(train.wheelset_parameters.reshape(4 * n), train.distances, own["couplers"], train.rail),
            *(own["rail_memory"], own["measures"], own["wheelset_measures"], own["exchange"]),
            *(present, *self._trace, steps_per_sample, 0),
        )
        *self._arguments, _ = passed(STEP.arguments, self._kept)
        self._step = function_of_addresses(TRAINS, STEP)
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

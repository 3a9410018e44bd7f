"""A stop in machine code that another program carries on, one controller cycle at a time.

No controller is called: commands and sensor readings pass through the exchange.
"""

from typing import Any, Final, cast

import numpy as np

from uictest.controllers import EXCHANGE, INPUTS, OUTPUTS, OUTPUTS_AT
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.kernel.arguments import passed
from uictest.rig.kernel.library import function_of_addresses
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.records import TrainRecords
from uictest.rig.model.state import BOGIE, CAR, COUPLER, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.train_stop import STEP, FinishedStop, TrainInputs, empty_trace, finished_cars, rows_of_trace

STOP_MEMORY: Final[Any] = np.dtype(
    [
        ("car", CAR),
        ("bogies", BOGIE, 2),
        ("wheelsets", WHEELSET, 4),
        ("parameters", PARAMETERS),
        ("rail_memory", RAIL_MEMORY),
        ("measures", STOP_MEASURES),
        ("wheelset_measures", WHEELSET_MEASURES, 4),
        ("exchange", EXCHANGE),
        ("train", TRAIN_SAMPLE, 1),
        ("modules", WHEELSET_SAMPLE, (1, 4)),
    ]
)
"""Everything that changes in a stop, in one piece without addresses: a copy of it is a copy of the stop.

`train` and `modules` are the present true state, as a row of a trace. Zeroed, with `parameters` filled in, it
is a stop that has not begun.
"""


def train_memory(cars: int) -> Any:
    """Return the layout of everything that changes in a stop of a train: a copy of it is a copy of the stop.

    The parts of :data:`STOP_MEMORY`, each for all cars, and the couplers.
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
        inputs: of each car, what its sensors show for the coming cycle: the record of
            :data:`~uictest.controllers.INPUTS` within its exchange.
        outputs: of each car, the commands for that cycle, :data:`~uictest.controllers.OUTPUTS` within it.
    """

    def __init__(self, inputs: TrainInputs, steps_per_sample: int = 0) -> None:
        """Begin the stop; the controllers of the cars play no part.

        Args:
            inputs: what the rig is given; :func:`~uictest.rig.train_stop.alone` gives those of a car alone.
            steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
        """
        n = len(inputs.parameters)
        memory = np.zeros(1, train_memory(n))
        memory["parameters"] = inputs.parameters
        memory["couplers"] = inputs.couplers
        self.memory: Any = memory[0]
        first = memory.dtype.fields["exchange"][1]
        offsets = [first + EXCHANGE.itemsize * car for car in range(n)]
        self.inputs = [np.frombuffer(memory, INPUTS, 1, offset)[0] for offset in offsets]
        self.outputs = [
            np.frombuffer(memory, OUTPUTS, 1, offset + OUTPUTS_AT).reshape(()) for offset in offsets
        ]
        self._trace = empty_trace(n, rows_of_trace(inputs.parameters[0], steps_per_sample))
        stop, given = self.memory, cast(Any, inputs)
        self._train = TrainRecords(
            *(stop["car"], stop["bogies"], stop["wheelsets"], stop["parameters"]),
            *(given.wheelset_parameters.reshape(4 * n), stop["rail_memory"]),
            *(stop["measures"], stop["wheelset_measures"]),
            *(given.distances, stop["couplers"], given.rail),
        )
        present = Trace(stop["train"].reshape(n, 1), stop["modules"].reshape(n, 1, 4))
        # The machine code reads and writes them by their addresses as long as the stop lasts.
        self._kept = self._train, stop["exchange"], present, self._trace, steps_per_sample, 0
        *self._arguments, _ = passed(STEP.arguments, self._kept)
        self._step = function_of_addresses(STEP)
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
        """Whether each car stands, has come down to where the stop ends, or its longest duration is over."""
        return bool(self.memory["car"]["closed"].all())

    def step(self) -> None:
        """Carry out the commands in the exchanges until the next cycle; none, where one is refused."""
        self._rows = self._step(*self._arguments, self._rows)

    def finished(self) -> tuple[FinishedStop, ...]:
        """Return the finished stop of each car; all must have ended."""
        measures: Any = self.memory["measures"].copy()
        return finished_cars(self._train._replace(measures=measures), self._trace, self._rows)

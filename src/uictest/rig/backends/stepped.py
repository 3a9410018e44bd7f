"""A stop in machine code that another program carries on, one controller cycle at a time.

No controller is called: commands and sensor readings pass through the exchange.
"""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import EXCHANGE, INPUTS, OUTPUTS, OUTPUTS_AT
from uictest.core.lanes import passed
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.machine_code import Target, function_of_addresses, object_code
from uictest.rig.backends.scalar import SCALAR, STEP
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.single_stop import FinishedStop, StopInputs, empty_trace, rows_of_trace

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


def stepping_code(target: Target) -> bytes:
    """Return the stepped stop as an object file for a target; :data:`STEP` says what it is called with."""
    return object_code(SCALAR, STEP, target)


class SteppedStop:
    """One stop that is carried on from outside, on memory of its own.

    Attributes:
        memory: record of :data:`STOP_MEMORY`.
        exchange: its part of that name.
        inputs: what the sensors show for the coming cycle, the record of :data:`~uictest.controllers.INPUTS`
            within the exchange.
        outputs: the commands for that cycle, :data:`~uictest.controllers.OUTPUTS` within it, shape ().
    """

    def __init__(self, inputs: StopInputs, steps_per_sample: int = 0) -> None:
        """Begin the stop.

        Args:
            inputs: parameters, those of the wheelsets and rail; the controller plays no part.
            steps_per_sample: base steps from one sample of the trace to the next; 0: no trace.
        """
        memory = np.zeros(1, STOP_MEMORY)
        memory["parameters"] = inputs.parameters
        self.memory: Any = memory[0]
        self.exchange: Any = self.memory["exchange"]
        (self.inputs,), (self.outputs,) = within_exchanges(memory, 1)
        self._trace = empty_trace(rows_of_trace(inputs.parameters, steps_per_sample))
        own = self.memory
        # The machine code reads and writes them by their addresses as long as the stop lasts.
        self._kept = (
            *(own["car"], own["bogies"], own["wheelsets"], own["parameters"]),
            *(inputs.wheelset_parameters, inputs.rail),
            *(own["rail_memory"], own["measures"], own["wheelset_measures"], own["exchange"]),
            *(Trace(own["train"], own["modules"]), self._trace, steps_per_sample, 0),
        )
        *self._arguments, _ = passed(STEP.arguments, self._kept)
        self._step = function_of_addresses(SCALAR, STEP)
        self._rows = 0
        self.step()

    @property
    def time(self) -> float:
        """Of the coming cycle, s."""
        return float(self.inputs["time"])

    @property
    def stands(self) -> bool:
        """Whether the train stands."""
        return self._is_over and not self.memory["parameters"]["end_speed"]

    @property
    def _is_over(self) -> bool:
        return bool(self.memory["car"]["stopped"])

    @property
    def has_ended(self) -> bool:
        """Whether the train stands, has come down to where the stop ends, or its longest duration is over."""
        return self._is_over or bool(self.memory["car"]["cycle"] >= self.memory["parameters"]["cycles"])

    def step(self) -> None:
        """Carry out the commands in the exchange until the next cycle."""
        self._rows = self._step(*self._arguments, self._rows)

    def finished(self) -> FinishedStop:
        """Return what the stop leaves, which must have ended."""
        memory, rows = self.memory, self._rows
        return FinishedStop(
            memory["measures"],
            memory["wheelset_measures"].view(np.recarray),
            memory["car"],
            memory["wheelsets"].view(np.recarray),
            Trace(self._trace.train[:rows], self._trace.wheelsets[:rows]),
        )


def within_exchanges(memory: NDArray[Any], cars: int) -> tuple[list[Any], list[Any]]:
    """Return the records of inputs, and those of outputs, within the part `exchange` of a record."""
    first = memory.dtype.fields["exchange"][1]  # type: ignore[index]
    places = [first + EXCHANGE.itemsize * car for car in range(cars)]
    return (
        [np.frombuffer(memory, INPUTS, 1, place)[0] for place in places],
        [np.frombuffer(memory, OUTPUTS, 1, place + OUTPUTS_AT).reshape(()) for place in places],
    )

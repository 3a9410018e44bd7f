"""A stop in machine code that another program carries on, one controller cycle at a time.

No controller is called: commands and sensor readings pass through the exchange.
"""

from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import EXCHANGE, INPUTS, OUTPUTS, OUTPUTS_AT
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.machine_code import Target, address, native_function, object_code, start_of
from uictest.rig.backends.scalar import SCALAR, STEP, STEP_ARGUMENTS
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
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
    """Return the stepped stop as an object file for a target."""
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
        self._arguments = (
            *addresses_within(self.memory),
            *(address(inputs.wheelset_parameters, WHEELSET_PARAMETERS, (4,)), *of_rail(inputs.rail)),
            *(*_of_trace(self._trace), steps_per_sample),
        )
        self._kept = inputs  # the machine code reads them by their addresses
        self._step = _native_step()
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


@cache
def _native_step() -> Any:
    return native_function(SCALAR, STEP, len(STEP_ARGUMENTS))


def within_exchanges(memory: NDArray[Any], cars: int) -> tuple[list[Any], list[Any]]:
    """Return the records of inputs, and those of outputs, within the part `exchange` of a record."""
    first = memory.dtype.fields["exchange"][1]  # type: ignore[index]
    places = [first + EXCHANGE.itemsize * car for car in range(cars)]
    return (
        [np.frombuffer(memory, INPUTS, 1, place)[0] for place in places],
        [np.frombuffer(memory, OUTPUTS, 1, place + OUTPUTS_AT).reshape(()) for place in places],
    )


def addresses_within(memory: Any) -> tuple[int, ...]:
    """Return the addresses of the parts of a record, in their order."""
    start = start_of(memory)
    return tuple(start + memory.dtype.fields[name][1] for name in memory.dtype.names)


def of_rail(rail: NDArray[np.float64]) -> tuple[int, int]:
    """Return the address of a rail and its number of points."""
    return address(rail, np.dtype("f8"), (ROWS, rail.shape[1])), rail.shape[1]


def _of_trace(trace: Trace) -> tuple[int, int, int]:
    rows = len(trace.train)
    return (
        address(trace.train, TRAIN_SAMPLE, (rows,)),
        address(trace.wheelsets, WHEELSET_SAMPLE, (rows, 4)),
        rows,
    )

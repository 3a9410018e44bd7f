"""The stop in machine code: compiled once by numba, kept in the cache, called by address."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.machine_code import address, is_kept, native_function
from uictest.rig.backends.scalar import RUN, RUN_ARGUMENTS, SCALAR
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS


def stop_is_compiled() -> bool:
    """Return whether the cache holds the stop."""
    return is_kept(RUN)


def load_stop() -> None:
    """Load the stop, compiled first where the cache does not hold it."""
    compiled_stop()


@cache
def compiled_stop() -> "NativeStop":
    """Return :func:`uictest.rig.model.stop.run_stop` compiled.

    The first call on a machine takes some fifteen seconds.
    """
    return NativeStop()


class NativeStop:
    """The stop in machine code. It releases the interpreter's lock while it runs."""

    def __init__(self) -> None:
        self._stop = native_function(SCALAR, RUN, len(RUN_ARGUMENTS))

    def __call__(
        self,
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        wheelset_parameters: Any,
        rail: NDArray[np.float64],
        memory: Any,
        measures: Any,
        wheelset_measures: Any,
        trace: Trace,
        steps_per_sample: int,
    ) -> int:
        """Run one stop on zeroed records. Raises TypeError where one does not have the compiled layout."""
        rows = len(trace.train)
        return self._stop(
            address(car, CAR),
            address(bogies, BOGIE, (2,)),
            address(wheelsets, WHEELSET, (4,)),
            address(p, PARAMETERS),
            address(wheelset_parameters, WHEELSET_PARAMETERS, (4,)),
            address(rail, np.dtype("f8"), (ROWS, rail.shape[1])),
            rail.shape[1],
            address(memory, RAIL_MEMORY),
            address(measures, STOP_MEASURES),
            address(wheelset_measures, WHEELSET_MEASURES, (4,)),
            address(trace.train, TRAIN_SAMPLE, (rows,)),
            address(trace.wheelsets, WHEELSET_SAMPLE, (rows, 4)),
            rows,
            steps_per_sample,
        )

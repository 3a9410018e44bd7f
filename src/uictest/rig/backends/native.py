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
from uictest.rig.single_stop import RunStop


def stop_is_compiled() -> bool:
    """Return whether the cache holds the stop."""
    return is_kept(RUN)


@cache
def compiled_stop() -> RunStop:
    """Return :func:`uictest.rig.model.stop.run_stop` compiled.

    It releases the interpreter's lock while it runs, and raises TypeError where a record does not have the
    compiled layout. The first call on a machine takes some fifteen seconds.
    """
    native = native_function(SCALAR, RUN, len(RUN_ARGUMENTS))

    def run_stop(
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
        rows = len(trace.train)
        return native(
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

    return run_stop

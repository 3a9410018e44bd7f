"""The code of the rig for one stop at a time: to standstill, or one controller cycle after the other."""

from functools import cache
from typing import Any, Final

from uictest.controllers import EXCHANGE
from uictest.core.lanes import Length, at, translate
from uictest.core.measures import FAULT_COLUMNS, STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import compile_inner, scalar_model
from uictest.rig.backends.machine_code import Entry, Unit, native_function
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.single_stop import RunStop

_POINTS, _ROOM, _ROWS = Length("points"), Length("room"), Length("rows")
_FAULTS, _NUMBERS, _NOTED = Length("faults"), Length("numbers"), Length("noted")
_STOP = (
    *(at(CAR), at(BOGIE, 2), at(WHEELSET, 4), at(PARAMETERS), at(WHEELSET_PARAMETERS, 4)),
    *(at("f8", ROWS, _POINTS), at(RAIL_MEMORY), at(STOP_MEASURES), at(WHEELSET_MEASURES, 4)),
)
_TRACE = Trace(at(TRAIN_SAMPLE, _ROOM), at(WHEELSET_SAMPLE, _ROOM, 4))
_PRESENT = Trace(at(TRAIN_SAMPLE, 1), at(WHEELSET_SAMPLE, 1, 4))
NOTE: Final = Entry(
    "uictest_note_samples",
    "a recording fed to the measures",
    (
        *(at(STOP_MEASURES), at(WHEELSET_MEASURES, 4), at(PARAMETERS)),
        *(at("f8", _ROWS, 8), at("f8", _ROWS, 4, 10), at("f8", _FAULTS, FAULT_COLUMNS)),
        *(at("f8", _NUMBERS), at("i8", _NOTED), at("f8", _ROWS - 1, _NOTED)),
    ),
)
""":func:`uictest.core.measures.note_samples`; it is in one object file with :data:`RUN`."""
RUN: Final = Entry("uictest_run_stop", "the rig for single stops", (*_STOP, _TRACE, int), beside=(NOTE.name,))
""":func:`uictest.rig.model.stop.run_stop`."""
STEP: Final = Entry(
    "uictest_step_stop",
    "the rig for stops in steps",
    (*_STOP, at(EXCHANGE), _PRESENT, _TRACE, int, int),
)
""":func:`uictest.rig.model.stop.step_stop`."""


def _functions() -> list[Any]:
    from uictest.core.measures import note_samples
    from uictest.rig.model.stop import run_stop, step_stop  # a warm start does not load what it would compile

    model = scalar_model()
    return [translate(function, compile_inner, model) for function in (run_stop, step_stop, note_samples)]


SCALAR: Final = Unit("uictest_scalar", (RUN, STEP, NOTE), _functions)


@cache
def compiled_stop() -> RunStop:
    """Return :func:`uictest.rig.model.stop.run_stop` compiled.

    It releases the interpreter's lock while it runs, and raises TypeError where a record does not have the
    compiled layout. The first call on a machine takes some ten seconds.
    """
    return native_function(SCALAR, RUN)

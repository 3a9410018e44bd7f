"""The stop of a train in machine code: to standstill, or one controller cycle after the other."""

from collections.abc import Callable
from functools import cache
from typing import Any, Final

from uictest.controllers import EXCHANGE
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.records import TrainRecords
from uictest.rig.model.state import BOGIE, CAR, COUPLER, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace

_CARS, _POINTS, _ROOM = Length("cars"), Length("points"), Length("room")
_TRAIN: Final = TrainRecords(
    *(at(CAR, _CARS), at(BOGIE, 2 * _CARS), at(WHEELSET, 4 * _CARS), at(PARAMETERS, _CARS)),
    *(at(WHEELSET_PARAMETERS, 4 * _CARS), at(RAIL_MEMORY, _CARS)),
    *(at(STOP_MEASURES, _CARS), at(WHEELSET_MEASURES, 4 * _CARS)),
    *(at("f8", _CARS), at(COUPLER, _CARS - 1), at("f8", ROWS, _POINTS)),
)
_TRACE: Final = Trace(at(TRAIN_SAMPLE, _CARS, _ROOM), at(WHEELSET_SAMPLE, _CARS, _ROOM, 4))
_PRESENT: Final = Trace(at(TRAIN_SAMPLE, _CARS, 1), at(WHEELSET_SAMPLE, _CARS, 1, 4))
RUN: Final = Entry("uictest.rig.model.train:run_train", (_TRAIN, _TRACE, int))
STEP: Final = Entry(
    "uictest.rig.model.train:step_train", (_TRAIN, at(EXCHANGE, _CARS), _PRESENT, _TRACE, int, int)
)
RunTrain = Callable[[Any, Any, int], int]
""":func:`uictest.rig.model.train.run_train`, plain or compiled."""


@cache
def compiled_rig() -> RunTrain:
    """Return :func:`uictest.rig.model.train.run_train` compiled.

    It releases the interpreter's lock while it runs, and raises TypeError where a record does not have the
    compiled layout.
    """
    return native_function(RUN)

"""The code of the rig for a stop of several cars, compiled when a train is first run."""

from collections.abc import Callable
from functools import cache
from typing import Any, Final

from uictest.controllers import EXCHANGE
from uictest.core.lanes import Length, at, translate
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import compile_inner, scalar_model
from uictest.rig.backends.machine_code import Entry, Unit, native_function
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

_CARS, _POINTS, _ROOM = Length("cars"), Length("points"), Length("room")
_TRAIN = (
    *(at(CAR, _CARS), at(BOGIE, 2 * _CARS), at(WHEELSET, 4 * _CARS), at(PARAMETERS, _CARS)),
    *(at(WHEELSET_PARAMETERS, 4 * _CARS), at("f8", _CARS), at(COUPLER, _CARS - 1), at("f8", ROWS, _POINTS)),
    *(at(RAIL_MEMORY, _CARS), at(STOP_MEASURES, _CARS), at(WHEELSET_MEASURES, 4 * _CARS)),
)
_SAMPLES = at(TRAIN_SAMPLE, _CARS, _ROOM), at(WHEELSET_SAMPLE, _CARS, _ROOM, 4)
_PRESENT = Trace(at(TRAIN_SAMPLE, _CARS, 1), at(WHEELSET_SAMPLE, _CARS, 1, 4))
RUN: Final = Entry("uictest_run_train", "the rig for trains", (*_TRAIN, *_SAMPLES, int))
""":func:`uictest.rig.model.train.run_train`."""
STEP: Final = Entry(
    "uictest_step_train",
    "the rig for trains in steps",
    (*_TRAIN, at(EXCHANGE, _CARS), _PRESENT, *_SAMPLES, int, int),
)
""":func:`uictest.rig.model.train.step_train`."""


def _functions() -> list[Any]:
    from uictest.rig.model.train import run_train, step_train

    return [translate(function, compile_inner, scalar_model()) for function in (run_train, step_train)]


TRAINS: Final = Unit("uictest_trains", (RUN, STEP), _functions)


@cache
def compiled_train() -> Callable[..., int]:
    """Return :func:`uictest.rig.model.train.run_train` compiled, for arrays of numpy."""
    return native_function(TRAINS, RUN)

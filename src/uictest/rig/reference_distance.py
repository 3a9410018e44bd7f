"""The reference distance of a stop: the shortest at any slide that all wheelsets keep to the end."""

from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import STOP_MEASURES
from uictest.core.record import fields_of
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS, Parameters
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.train_stop import StopInputs

if TYPE_CHECKING:
    from uictest.rig.lanes import BatchMeasures

_SLIDES: Final = np.array([0.4 / 1.28**k for k in reversed(range(16))])
"""Chosen: 1 .. 24, 31, 40 %; the distance at the best of them is within 0.2 % of the shortest."""
_STOPS: Final = len(_SLIDES) + 1
_LACKING: Final = ("end_speed", "drag_duration", "has_track_brake", "has_sanders", "fault_count")
"""Parameters that are above zero where a stop of a car alone has no reference; a train is not asked."""
_OF_CONTROLLERS: Final = {*PARAMETERS.names} - {*fields_of(Parameters)}
_UNREAD: Final = ("controller", "controller_contract", "noise_key", "wsp_active", *_OF_CONTROLLERS)
"""Parameters that no reference depends on and in which stops on one rail often differ."""
ENTRY: Final = Entry(
    "uictest.rig.model.reference_stop:find_reference",
    (
        *(at(CAR, _STOPS), at(BOGIE, 2 * _STOPS), at(WHEELSET, 4 * _STOPS)),
        *(at(PARAMETERS), at(WHEELSET_PARAMETERS, 4), at("f8", ROWS, Length("points"))),
        *(at(RAIL_MEMORY), at(STOP_MEASURES), at("f8", len(_SLIDES))),
    ),
)


def reference_distances(
    parameters: NDArray[Any], wheelset_parameters: NDArray[Any], rail: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the reference distances of n stops of a car alone, m, infinite where no slide stops it.

    NaN where there is none: with sand, a track brake or a fault, and in a stop that ends above standstill.
    Arguments as for :func:`uictest.rig.run_in_lanes`.
    """
    return np.array(list(map(_reference, np.array(parameters), wheelset_parameters, rail)))


def run_in_lanes(
    parameters: NDArray[Any], wheelset_parameters: NDArray[Any], rail: NDArray[np.float64]
) -> "BatchMeasures":
    """Return the results of :func:`uictest.rig.lanes.run_in_lanes` with the reference distances."""
    from uictest.rig import lanes  # a single stop does not load them

    batch = lanes.run_in_lanes(parameters, wheelset_parameters, rail)
    batch.measures["reference_distance"] = reference_distances(parameters, wheelset_parameters, rail)
    return batch


def measures_with_reference(measures: Any, inputs: StopInputs) -> Any:
    """Return the measures of a stop of a car alone with its reference distance."""
    measures = measures.copy()  # those of a child process are read-only
    given = inputs.parameters, inputs.wheelset_parameters, inputs.rail
    [measures["reference_distance"]] = reference_distances(*(np.array([each]) for each in given))
    return measures


def _reference(parameters: Any, wheelset_parameters: Any, rail: Any) -> float:
    if any(parameters[name] > 0.0 for name in _LACKING):
        return np.nan
    for name in _UNREAD if parameters["varies_friction"] > 0.0 else (*_UNREAD, "seed"):
        parameters[name] = 0
    return _shortest(parameters.tobytes(), wheelset_parameters.tobytes(), rail.tobytes())


@lru_cache(10_000)
def _shortest(parameters: bytes, wheelset_parameters: bytes, rail: bytes) -> float:
    """Return the distance at the best slide, once for equal records: repeats and sweeps have many."""
    given = (
        np.frombuffer(parameters, PARAMETERS)[0],
        np.frombuffer(wheelset_parameters, WHEELSET_PARAMETERS),
        np.frombuffer(rail).reshape(ROWS, -1),
    )
    cars, bogies = np.zeros(_STOPS, CAR), np.zeros(2 * _STOPS, BOGIE)
    wheelsets = np.zeros(4 * _STOPS, WHEELSET)
    memory, measures = np.zeros(1, RAIL_MEMORY)[0], np.zeros(1, STOP_MEASURES)[0]
    native_function(ENTRY)(cars, bogies, wheelsets, *given, memory, measures, _SLIDES)
    return float(measures["reference_distance"])

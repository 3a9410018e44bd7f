"""The reference distance of a stop: the shortest at any slide that all wheelsets keep to the end."""

from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import STOP_MEASURES
from uictest.core.record import fields_of
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.single_stop import StopInputs

if TYPE_CHECKING:
    from uictest.rig.backends.lanes import BatchMeasures

_SLIDES: Final = tuple(0.4 / 1.28**k for k in range(16))
"""Chosen: 40, 31, 24 .. 1 %; the distance at the best of them is within 0.2 % of the shortest."""
_COARSE, _FINE = 0.05, 0.005
"""s, of the steps that find the best slide, and of those that give its distance: within 0.3 %; chosen."""
_LACKING: Final = ("end_speed", "drag_duration", "has_track_brake", "has_sanders", "fault_count")
"""Parameters that are above zero where a stop of a car alone has no reference; a train is not asked."""
_OF_CONTROLLERS: Final = {*PARAMETERS.names} - {*fields_of(Parameters)}
_UNREAD: Final = ("controller", "controller_contract", "noise_key", "wsp_active", *_OF_CONTROLLERS)
"""Parameters that no reference depends on and in which stops on one rail often differ."""
ENTRY: Final = Entry(
    "uictest.rig.model.reference_stop:keep_slide_to_end",
    (
        *(at(CAR), at(BOGIE, 2), at(WHEELSET, 4), at(PARAMETERS), at(WHEELSET_PARAMETERS, 4)),
        *(at("f8", ROWS, Length("points")), at(RAIL_MEMORY), at(STOP_MEASURES), at("f8", 2)),
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
    """Return what :func:`uictest.rig.backends.lanes.run_in_lanes` does, with the reference distances."""
    from uictest.rig.backends import lanes  # a single stop does not load them

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

    def distance_at(slide: float, step: float) -> float:
        measures, car, memory = (np.zeros(1, layout)[0] for layout in (STOP_MEASURES, CAR, RAIL_MEMORY))
        records = car, np.zeros(2, BOGIE), np.zeros(4, WHEELSET), *given, memory, measures
        native_function(ENTRY)(*records, np.array([slide, step]))
        return float(measures["reference_distance"])

    return distance_at(min(_SLIDES, key=lambda slide: distance_at(slide, _COARSE)), _FINE)

"""A recorded stop by the code of the rig: its samples pass the measures, its wheelsets meet a rail."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import (
    FAULT_COLUMNS,
    STOP_MEASURES,
    WHEELSET_MEASURES,
    Cell,
    MeasureDefinition,
    Replay,
    index_of,
)
from uictest.core.record import fields_of
from uictest.plans.scenario import Scenario
from uictest.rig.assembly import parameter_record
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import MET_RAIL, RAIL_MEMORY, RECORDED_MOTION
from uictest.rig.model.state import CAR, WHEELSET

_ROWS, _NOTED = Length("rows"), Length("noted")
NOTE = Entry(
    "uictest.core.measures.samples:note_samples",
    (
        *(at(STOP_MEASURES), at(WHEELSET_MEASURES, 4), at(PARAMETERS)),
        *(at("f8", _ROWS, 8), at("f8", _ROWS, 4, 10), at("f8", Length("faults"), FAULT_COLUMNS)),
        *(at("f8", Length("numbers")), at("i8", _NOTED), at("f8", _ROWS - 1, _NOTED)),
    ),
)


def noted_numbers(replay: Replay, cells: Sequence[Cell]) -> NDArray[np.float64]:
    """Let the samples pass, and return numbers of the records after each but the first, a row each."""
    parameters = np.zeros(1, PARAMETERS)
    for name in fields_of(MeasureDefinition):
        parameters[name] = getattr(replay.definition, name)
    cells_at = np.array([index_of(cell) for cell in cells], np.int64)
    noted = np.empty((len(replay.samples.train) - 1, len(cells)))
    native_function(NOTE)(
        *(replay.train, replay.wheelsets, parameters[0], *replay.samples, replay.numbers, cells_at, noted)
    )
    return noted


def pass_samples(replay: Replay) -> None:
    """Let all samples pass."""
    noted_numbers(replay, ())


Array = NDArray[np.float64]
_WHEELSETS = 4
FOLLOW = Entry(
    "uictest.rig.model.rail:follow_record",
    (
        *(at(CAR), at(WHEELSET, _WHEELSETS), at(PARAMETERS), at(RAIL_MEMORY)),
        *(at(RECORDED_MOTION, _ROWS, _WHEELSETS), at(MET_RAIL, _ROWS, _WHEELSETS)),
    ),
)


class RecordedRail:
    """The rail under the wheelsets of a recorded stop, for any friction as found.

    Args:
        scenario: creep law, contact and cleaning. It must clean the rail.
        time: of the samples, s, shape (n,).
        speed: of the train, m/s, > 0, shape (n,).
        place: of the wheelsets on the track, m from where the first was at the brake command, shape (4, n).
        load: of one wheel, N, shape (4, n).
        slip: slip speeds, m/s, shape (4, n).

    """

    def __init__(
        self, scenario: Scenario, time: Array, speed: Array, place: Array, load: Array, slip: Array
    ) -> None:
        self._parameters = parameter_record(scenario)
        self._behind = place[0, 0] - place[:, 0]
        self._motion = np.zeros((len(time), _WHEELSETS), RECORDED_MOTION)
        self._motion["duration"] = np.diff(time, prepend=time[0])[:, None]
        self._motion["speed"] = speed[:, None]
        self._motion["position"] = place[0][:, None]
        self._motion["load"] = load.T
        self._motion["slip"] = 0.5 * (slip + np.concatenate((slip[:, :1], slip[:, :-1]), axis=1)).T

    def met(self, friction: Array) -> tuple[Array, Array]:
        """Return the friction under each wheelset and the cleaned share of the rail, both of shape (4, n).

        `friction` is the initial friction coefficient of the rail that nothing has cleaned, shape (4, n).
        """
        self._motion["found"] = friction.T
        met = np.zeros(self._motion.shape, MET_RAIL)
        wheelsets = np.zeros(_WHEELSETS, WHEELSET)
        wheelsets["behind"] = self._behind
        wheelsets["friction"] = friction[:, 0]
        for name in ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip"):
            wheelsets[name] = self._parameters[name]
        car, memory = np.zeros(1, CAR), np.zeros(1, RAIL_MEMORY)
        memory["points"] = self._parameters["spent_share"]
        follow = native_function(FOLLOW)
        follow(car[0], wheelsets, self._parameters[0], memory[0], self._motion, met)
        return met["friction"].T, met["cleaned_share"].T

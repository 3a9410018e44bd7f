"""The rail that the wheelsets of a recorded stop met, by the formulae and the code of the rig."""

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Scenario
from uictest.rig.assembly import ASSIGNMENTS, assigned
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import MET_RAIL, RAIL_MEMORY, RECORDED_MOTION
from uictest.rig.model.state import CAR, WHEELSET

Array = NDArray[np.float64]
_WHEELSETS = 4
_ROWS = Length("rows")
ENTRY = Entry(
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
        self._parameters = np.zeros(1, PARAMETERS)
        for name, value in assigned(ASSIGNMENTS, scenario).items():
            self._parameters[name] = value
        self._behind = place[0, 0] - place[:, 0]
        self._motion = np.zeros((len(time), _WHEELSETS), RECORDED_MOTION)
        self._motion["duration"] = np.diff(time, prepend=time[0])[:, None]
        self._motion["speed"] = speed[:, None]
        self._motion["position"] = place[0][:, None]
        self._motion["load"] = load.T
        self._motion["slip"] = 0.5 * (slip + np.concatenate((slip[:, :1], slip[:, :-1]), axis=1)).T

    def met(self, found: Array) -> tuple[Array, Array]:
        """Return the friction under each wheelset and the cleaned share of the rail, both of shape (4, n).

        `found` is the initial friction coefficient of the rail that nothing has cleaned, shape (4, n).
        """
        self._motion["found"] = found.T
        met = np.zeros(self._motion.shape, MET_RAIL)
        wheelsets = np.zeros(_WHEELSETS, WHEELSET)
        wheelsets["behind"] = self._behind
        wheelsets["friction"] = found[:, 0]
        for name in ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip"):
            wheelsets[name] = self._parameters[name]
        car, memory = np.zeros(1, CAR), np.zeros(1, RAIL_MEMORY)
        memory["points"] = self._parameters["spent_share"]
        follow = native_function(ENTRY)
        follow(car[0], wheelsets, self._parameters[0], memory[0], self._motion, met)
        return met["friction"].T, met["cleaned_share"].T

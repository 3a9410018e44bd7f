"""What the rig is given for one stop: numbers, and where a controller comes from outside, its program."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ControllerProgram


class StopInputs(NamedTuple):
    """What the rig is given for one stop.

    Attributes:
        parameters: record of :data:`~uictest.rig.model.parameters.PARAMETERS`.
        wheelset_parameters: four records of
            :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`.
        rail: friction of the rail, the rows of :mod:`~uictest.rig.model.friction_law`, shape (4, n).
        program: what is loaded where the controller comes from outside, else None.
        config: what that controller is given before the stop, else None.
    """

    parameters: Any
    wheelset_parameters: Any
    rail: NDArray[np.float64]
    program: ControllerProgram | None = None
    config: Config | None = None

"""The place of the controller in the model.

:mod:`uictest.rig.backends.compiled` puts the functions of controllers where the model calls these.
"""

from collections.abc import Sequence
from typing import Final

from uictest.controllers import CONTROLLERS, ControlledWheelset, Controller, TrainMemory
from uictest.rig.model.external_controller import EXTERNAL
from uictest.rig.model.parameters import Parameters

CHOICES: tuple[Controller, ...] = (EXTERNAL, *CONTROLLERS.values())
"""What may stand in that place; a case names one by its number here, ``Parameters.controller``."""
FROM_OUTSIDE: Final = CHOICES.index(EXTERNAL)
"""Number of what stands for every controller from outside."""


def begin(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], p: Parameters) -> None:
    """Set the memory of the case's controller at the start of a stop."""
    raise NotImplementedError("the stop was made without a controller")


def decide(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], p: Parameters) -> None:
    """Let the case's controller set the valve commands of the coming cycle."""
    raise NotImplementedError("the stop was made without a controller")

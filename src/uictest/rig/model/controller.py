"""The place of the controller in the model.

A stop is made for one controller: :func:`uictest.rig.backends.compiled.with_controller` puts its functions
where the model calls these.
"""

from collections.abc import Sequence

from uictest.controllers import ControlledWheelset, TrainMemory
from uictest.rig.model.parameters import Parameters


def begin(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], speed: float) -> None:
    """Set the memory of the case's controller at the start of a stop from ``speed`` m/s."""
    raise NotImplementedError("the stop was made without a controller")


def decide(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], p: Parameters) -> None:
    """Let the case's controller set the valve commands of the coming cycle."""
    raise NotImplementedError("the stop was made without a controller")

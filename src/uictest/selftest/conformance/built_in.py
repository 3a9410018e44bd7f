"""Controllers in the built-in form, called in plain Python: no compiler is needed to check them."""

from types import SimpleNamespace
from typing import Any, Final

from uictest.controllers import CalledInstance, Config, Controller, Inputs, Outputs
from uictest.core.physics import FILL, VENT
from uictest.core.record import fields_of

WHEELSETS: Final = 4


class PlainInstance(CalledInstance):
    """A controller's `begin` and `decide` on objects that have its fields and no others."""

    def __init__(self, controller: Controller, parameters: Any, config: Config) -> None:
        super().__init__()
        self._controller = controller
        self._parameters = parameters
        self._initial_speed = config.initial_speed

    def reset(self) -> None:
        """Begin a stop."""
        self._train: Any = _blank(self._controller.train_memory)
        self._wheelsets: list[Any] = [_blank(self._controller.wheelset_memory) for _ in range(WHEELSETS)]
        self._controller.begin(self._train, self._wheelsets, self._initial_speed)

    def step(self, inputs: Inputs) -> Outputs:
        """Decide as in a stop."""
        readings = zip(self._wheelsets, inputs.wheel_speed, inputs.speed_valid, strict=True)
        for wheelset, speed, valid in readings:
            wheelset.measured_speed, wheelset.speed_valid = speed, int(valid)
        self._controller.decide(self._train, self._wheelsets, self._parameters)
        commands = [wheelset.valve_command for wheelset in self._wheelsets]
        return Outputs(
            hold=[command != FILL for command in commands],
            vent=[command == VENT for command in commands],
            reference_speed=self._train.reference_speed,
        )


def _blank(record: Any) -> Any:
    return SimpleNamespace(**dict.fromkeys(fields_of(record), 0))

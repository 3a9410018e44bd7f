"""The built-in threshold controller as a class: the same Python functions, run by the interpreter."""

from types import SimpleNamespace

from uictest.controllers import CONTROLLERS, Config, Inputs, Outputs
from uictest.core.physics import HOLD, VENT
from uictest.core.record import fields_of

_THRESHOLD = CONTROLLERS["threshold"]


class Threshold:
    """Four wheelsets and the train, as the built-in controller remembers them."""

    def __init__(self, config: Config) -> None:
        self._parameters = SimpleNamespace(cycle_time=config.cycle_time, **config.parameters)
        self._initial_speed = config.initial_speed

    def reset(self) -> None:
        """Return to the state after creation."""
        self._train = _zeroed(_THRESHOLD.train_memory)
        self._wheelsets = [_zeroed(_THRESHOLD.wheelset_memory) for _ in range(4)]
        _THRESHOLD.begin(self._train, self._wheelsets, self._initial_speed)

    def step(self, inputs: Inputs) -> Outputs:
        """Decide on the coming cycle."""
        readings = zip(self._wheelsets, inputs.wheel_speed, inputs.speed_valid, strict=True)
        for wheelset, speed, valid in readings:
            wheelset.measured_speed, wheelset.speed_valid = speed, int(valid)
        _THRESHOLD.decide(self._train, self._wheelsets, self._parameters)
        commands = [wheelset.valve_command for wheelset in self._wheelsets]
        vent = [command == VENT for command in commands]
        return Outputs([command in (HOLD, VENT) for command in commands], vent, self._train.reference_speed)


def _zeroed(record: type) -> SimpleNamespace:
    return SimpleNamespace(**dict.fromkeys(fields_of(record), 0))

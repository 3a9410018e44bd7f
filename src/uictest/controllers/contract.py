"""What every controller is given, what it declares, and the controllers that there are."""

import pkgutil
from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any, NamedTuple

from uictest.controllers import built_in
from uictest.core.record import Record, fields_of


class DeclaredParameter(NamedTuple):
    """One parameter of a controller.

    Attributes:
        kind: kind of quantity, a name of :data:`uictest.core.units.KINDS`.
        description: one sentence for people.
        at_least: smallest value, as a user would write it, such as ``"1 ms"``.
        at_most: largest value, likewise.
    """

    kind: str
    description: str
    at_least: str
    at_most: str


def parameter(kind: str, description: str, *, at_least: str, at_most: str) -> Any:
    """Declare that a field of :class:`ControllerParameters` is a :class:`DeclaredParameter`."""
    return DeclaredParameter(kind, description, at_least, at_most)


def duration(description: str, *, at_least: str = "1 ms") -> Any:
    """Declare a time of up to a minute."""
    return parameter("time", description, at_least=at_least, at_most="60 s")


def acceleration(description: str) -> Any:
    """Declare the size of an acceleration or deceleration."""
    return parameter("acceleration", description, at_least="0.001 m/s2", at_most="100 m/s2")


def share(description: str) -> Any:
    """Declare a share of up to one."""
    return parameter("share", description, at_least="0 %", at_most="100 %")


def low_speed(description: str) -> Any:
    """Declare a speed or difference of speeds that is not zero."""
    return parameter("speed", description, at_least="0.001 km/h", at_most="100 km/h")


class ControllerCycle(Record):
    """The parameter that a controller shares with the rig."""

    cycle_time: float = parameter("time", "Time between two decisions.", at_least="1 ms", at_most="1 s")


class ControllerParameters(ControllerCycle):
    """Parameters that every controller has, SI units. Its docstring describes the controller to users."""

    reference_deceleration: float = acceleration(
        "Fastest fall of the estimate of the train's speed (positive number)."
    )
    minimum_speed: float = low_speed(
        "Estimated train speed below which the controller leaves the brake alone."
    )


class TrainMemory(Record):
    """What every controller remembers about the train from one cycle to the next."""

    reference_speed: float  # its estimate of the train's speed, m/s


class ControlledWheelset(Record):
    """What every controller reads and sets of a wheelset; a controller adds what it remembers."""

    measured_speed: float  # circumferential, as the sensor gives it, m/s
    speed_valid: int  # 0 where the speed sensor reports a fault, else 1
    valve_command: int  # newest command: FILL, HOLD or VENT


class BrakedTrain(TrainMemory):
    """What version 2 of the contract adds for the train."""

    axle_load: float  # of one axle at rest, N
    brake_command: float  # of the train, share of full service, before the delays of the brake
    train_speed: float  # from outside the wheelsets, m/s; 0 where it is not valid
    train_speed_valid: int  # 0 without such a source, and while it reports a fault, else 1
    acceleration: float  # as an accelerometer on the car shows it, m/s2; 0 where it is not valid
    acceleration_valid: int  # 0 without an accelerometer, else 1
    track_brake_request: int  # set by the controller: 1 asks for the track brake


class BrakedWheelset(ControlledWheelset):
    """What version 2 of the contract adds for a wheelset."""

    dynamic_brake: float  # what its motor gives of what it could at its speed; 0 without a motor
    dynamic_reduction: float  # set by the controller: share that is taken off it
    sand_request: int  # set by the controller: 1 asks for sand


class Conflict(NamedTuple):
    """Parameters that are acceptable one by one but not together.

    Attributes:
        parameter: the one to change.
        message: why; ``{name}`` stands for the value of a parameter as the user wrote it.
    """

    parameter: str
    message: str


def no_conflicts(parameters: Any) -> Iterator[Conflict]:
    """Accept every combination of parameters."""
    yield from ()


class Controller(NamedTuple):
    """A controller, as its module declares it.

    Attributes:
        name: what a scenario calls it.
        parameters: its parameters.
        train_memory: what it remembers about the train.
        wheelset_memory: what it reads, sets and remembers of each wheelset.
        begin: sets that memory at the start of a stop from a speed in m/s.
        decide: sets ``valve_command`` of each of the four wheelsets, once per controller cycle.
        conflicts: finds parameters that are impossible together.
        contract: version of the contract; the memories of one of version 2 are a :class:`BrakedTrain` and a
            :class:`BrakedWheelset`.
    """

    name: str
    parameters: type[ControllerCycle]
    train_memory: type[TrainMemory]
    wheelset_memory: type[ControlledWheelset]
    begin: Callable[[Any, Any, float], None]
    decide: Callable[[Any, Any, Any], None]
    conflicts: Callable[[Any], Iterator[Conflict]] = no_conflicts
    contract: int = 1

    def declared_parameters(self) -> dict[str, DeclaredParameter]:
        """Return the declarations of the parameters by name, those that every controller has first."""
        return {name: getattr(self.parameters, name) for name in fields_of(self.parameters)}


def _built_in() -> dict[str, Controller]:
    modules = [
        import_module(f"{built_in.__name__}.{module.name}")
        for module in pkgutil.iter_modules(built_in.__path__)
    ]
    return {module.CONTROLLER.name: module.CONTROLLER for module in modules}


CONTROLLERS = _built_in()
"""Every built-in controller by its name."""
DEFAULT = "threshold"
"""Name of the controller of a scenario that names none."""

"""What a controller is given and answers: as objects, and in memory as ``uictest_controller.h`` lays it out.

See docs/controllers.md. In Python:

    from uictest.controllers import Config, Inputs, Outputs

    class MyWsp:
        def __init__(self, config: Config) -> None: ...
        def reset(self) -> None: ...
        def step(self, inputs: Inputs) -> Outputs: ...

SI units. Wheelset 0 is the leading one.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np


@dataclass(frozen=True, slots=True)
class Config:
    """What a controller is given once, before a stop.

    Attributes:
        wheelsets: number of wheelsets.
        cycle_time: time from one call of ``step`` to the next, s.
        initial_speed: of the train at the brake command, m/s.
        wheel_radius: radius that ``wheel_speed`` is computed with, m, one per wheelset.
        parameters: those that are declared, as the scenario gives them or with their defaults.
        case_sha256: of everything that decides the stop but the controller, see
            :func:`uictest.rig.assembly.case_sha256`; empty where there is no case.
    """

    wheelsets: int
    cycle_time: float
    initial_speed: float
    wheel_radius: tuple[float, ...]
    parameters: Mapping[str, Any]
    case_sha256: str = ""


@dataclass(frozen=True, slots=True)
class Inputs:
    """What the sensors show at the start of a controller cycle.

    Attributes:
        cycle: number of the cycle, 0 at the brake command.
        time: ``cycle`` x ``cycle_time``, s.
        wheel_speed: circumferential, as the sensor gives it, m/s, one per wheelset.
        speed_valid: False where a speed sensor reports a fault.
        cylinder_pressure: as the sensor gives it, gauge, Pa, one per wheelset.
        brake_demand: share of full service; a brake is demanded above 0.
        dynamic_brake: what the motor gives of what it could at its speed, 0 to 1, one per wheelset; 0 without
            a motor. This and all that follow belong to version 2 of the contract.
        axle_load: of one axle at rest, N.
        brake_command: of the train, share of full service, before the delays of the brake.
        train_speed: from outside the wheelsets (radar, satellites, the train's computer), m/s; 0 where it is
            not valid.
        train_speed_valid: False without such a source, and while it reports a fault.
        acceleration: of the car along the track, as an accelerometer on it shows it, m/s2: on a gradient with
            the share of gravity, braking is negative; 0 where it is not valid.
        acceleration_valid: False without an accelerometer.
    """

    cycle: int
    time: float
    wheel_speed: tuple[float, ...]
    speed_valid: tuple[bool, ...]
    cylinder_pressure: tuple[float, ...]
    brake_demand: float
    dynamic_brake: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    axle_load: float = 0.0
    brake_command: float = 0.0
    train_speed: float = 0.0
    train_speed_valid: bool = False
    acceleration: float = 0.0
    acceleration_valid: bool = False


@dataclass(slots=True)
class Outputs:
    """The answer of a controller for the coming cycle.

    Attributes:
        hold: whether the holding magnet is energised, one per wheelset.
        vent: whether the venting magnet is energised, one per wheelset. Neither fills the cylinder, hold
            alone holds its pressure, both vent it; vent without hold is forbidden and ends the stop.
        reference_speed: estimated speed of the train, m/s; NaN: none.
        diagnosis: 32 bits, recorded with the stop. Each of the bits i, 8 + i, 16 + i and 24 + i reports
            wheelset i (0 to 3), all others what the controller likes.
        dynamic_reduction: share that is taken off the dynamic brake, 0 to 1, one per wheelset. This and the
            next two belong to version 2 of the contract; None: nothing.
        sand_request: whether sand is asked for, one per wheelset; obeyed by sanders with `when: requested`.
        track_brake_request: whether the track brake is asked for; it acts where the scenario's `brake.track`
            says `when: requested`, and is only recorded elsewhere.
    """

    hold: Sequence[bool | int]
    vent: Sequence[bool | int]
    reference_speed: float = math.nan
    diagnosis: int = 0
    dynamic_reduction: Sequence[float] | None = None
    sand_request: Sequence[bool | int] | None = None
    track_brake_request: bool | int | None = None


class PythonController(Protocol):
    """A controller written in Python. It is created with a :class:`Config` for every stop, then reset.

    A class of contract version 2 says so by the attribute ``contract = 2``.
    """

    def reset(self) -> None:
        """Return to the state after creation."""

    def step(self, inputs: Inputs) -> Outputs:
        """Decide on the coming cycle."""


WHEELSETS: Final = 4

INPUTS: Final = np.dtype(
    [
        ("cycle", "i8"),
        ("time", "f8"),
        ("wheel_speed", "f8", WHEELSETS),
        ("cylinder_pressure", "f8", WHEELSETS),
        ("brake_demand", "f8"),
        ("speed_valid", "i4", WHEELSETS),
        ("dynamic_brake", "f8", WHEELSETS),
        ("axle_load", "f8"),
        ("brake_command", "f8"),
        ("train_speed", "f8"),
        ("acceleration", "f8"),
        ("train_speed_valid", "i4"),
        ("acceleration_valid", "i4"),
    ]
)
"""`uictest_inputs` of version 2."""
OUTPUTS: Final = np.dtype(
    [
        ("reference_speed", "f8"),
        ("hold", "i4", WHEELSETS),
        ("vent", "i4", WHEELSETS),
        ("diagnosis", "u4"),
        ("padding", "u4"),
        ("dynamic_reduction", "f8", WHEELSETS),
        ("sand_request", "i4", WHEELSETS),
        ("track_brake_request", "i4"),
        ("padding_2", "i4"),
    ]
)
"""`uictest_outputs` of version 2."""
_PLACES: Final[Any] = {**(INPUTS.fields or {}), **(OUTPUTS.fields or {})}
INPUT_BYTES: Final = {1: _PLACES["dynamic_brake"][1], 2: INPUTS.itemsize}
"""Size of `uictest_inputs` in each version."""
OUTPUT_BYTES: Final = {1: _PLACES["dynamic_reduction"][1], 2: OUTPUTS.itemsize}
"""Size of `uictest_outputs` in each version."""
UNTOUCHED: Final = -1.0 / 3.0
"""In each `dynamic_reduction` before a controller of version 1 is called, whose outputs end there: no byte
is zero."""
GUARD: Final = 0x5AFE_C0DE_5AFE_C0DE
"""Written after the outputs: a controller that writes beyond them destroys it."""

NOT_CALLED: Final = 0
STEPPING: Final = 1
OPENING: Final = 2
CLOSING: Final = 3
EXPLAINING: Final = 4

DAMAGED: Final = -1
"""A failure that was not this controller's: what is noted on it was written over."""
NO_FAILURE: Final = 0
STEP_FAILED: Final = 1
FORBIDDEN_COMMAND: Final = 2
NO_MAGNET_STATE: Final = 3
WROTE_BEYOND: Final = 4
NO_REDUCTION: Final = 5
NO_REQUEST: Final = 6
NO_REFERENCE: Final = 7

_OWN: Final = [(name, "i8") for name in ("guard", "calling", "failure", "failed_wheelset", "cycles")]
EXCHANGE: Final = np.dtype([*INPUTS.descr, *OUTPUTS.descr, *_OWN])
"""Inputs, outputs, then: `guard`; `calling`, what the controller is asked to do at present (STEPPING, ...);
`failure`, what was wrong with its answer (STEP_FAILED, ...); `failed_wheelset`, 0 to 3; `cycles`, how many
steps were begun."""
OUTPUTS_AT: Final = INPUTS.itemsize
"""Offset of the outputs in :data:`EXCHANGE`."""

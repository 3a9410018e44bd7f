"""The true state of the rig, which no controller sees: for plots and rewards."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

FourValues = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class RigState:
    """The rig at one instant; wheelset 0 is the leading one, pressures are gauge.

    Attributes:
        time: since the brake command, s.
        distance: since the brake command, m.
        train_speed: m/s.
        wheel_speed: circumferential, m/s.
        slide: 1 - wheel speed / train speed; 0 below 1 m/s.
        friction: friction coefficient of the rail under the wheelset.
        tank_pressure: of the module of each wheelset, Pa.
        clamping_force: of one caliper, N.
        brake_torque: on the wheelset, N m.
        reservoir_pressure: Pa.
    """

    time: float
    distance: float
    train_speed: float
    wheel_speed: FourValues
    slide: FourValues
    friction: FourValues
    tank_pressure: FourValues
    clamping_force: FourValues
    brake_torque: FourValues
    reservoir_pressure: float


def state_of(memory: Any) -> RigState:
    """Return the present state from a record of :data:`uictest.rig.STOP_MEMORY`."""
    train, modules = memory["train"][0], memory["modules"][0]
    return RigState(
        time=float(train["time"]),
        distance=float(train["distance"]),
        train_speed=float(train["speed"]),
        wheel_speed=_four(modules, "wheel_speed"),
        slide=_four(modules, "slide"),
        friction=_four(modules, "friction"),
        tank_pressure=_four(modules, "tank_pressure"),
        clamping_force=_four(modules, "clamping_force"),
        brake_torque=_four(modules, "brake_torque"),
        reservoir_pressure=float(train["reservoir_pressure"]),
    )


def _four(modules: Any, name: str) -> FourValues:
    leading, second, third, trailing = modules[name].tolist()
    return leading, second, third, trailing

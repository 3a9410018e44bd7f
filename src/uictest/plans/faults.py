"""Faults of the brake and its controller that a scenario can inject, and what each of them changes.

A row declares the part that is faulty, the value that the fault takes and its effects: a scenario reads it to
check what a user writes, the rig to compute what a fault changes. Each effect is a table of the rig, and no
code asks what kind of fault it is. The kinds are those of the fault tables of brake controllers; the ranges
of their values are chosen: wide enough for what happens, narrow enough for the equations of the rig.
"""

import math
from collections.abc import Callable
from types import MappingProxyType
from typing import Final, Literal, NamedTuple


class Effects(NamedTuple):
    """Changes by a fault while it is active, SI units; by default none."""

    speed_valid: float = 1.0  # 0 where the speed sensor reports a fault
    speed_held: float = 0.0  # 1 where it goes on reading what it read last
    speed_factor: float = 1.0  # on its reading
    speed_offset: float = 0.0  # added to its reading, m/s
    speed_jump: float = 0.0  # largest random error of its reading, new in every controller cycle, m/s
    drop_out: float = 0.0  # share of its readings that are zero
    lost_teeth: float = 0.0  # that its pole wheel lacks besides those that it lacked before
    fill_at_least: float = 0.0  # bounds of the opening from the brake line to the tank, 0 to 1
    fill_at_most: float = 1.0
    vent_at_least: float = 0.0  # bounds of the opening from the tank to the atmosphere, 0 to 1
    vent_at_most: float = 1.0
    travel_time: float = 0.0  # of the valve between closed and open, if longer than its own, s
    tank_leak: float = 0.0  # sonic conductance from the tank, m3/(s Pa)
    line_leak: float = 0.0  # sonic conductance from the brake line, m3/(s Pa)
    pressure_held: float = 0.0  # 1 where the pressure that the controller is given stays what it was
    pressure_factor: float = 1.0  # on that pressure
    pressure_offset: float = 0.0  # added to it, gauge, Pa
    silent: float = 0.0  # 1 where the valves keep the last command of the controller
    release_time: float = math.inf  # silence after which they fill, s
    dynamic_failed: float = 0.0  # 1 where the dynamic brake of the car gives nothing
    track_failed: float = 0.0  # 1 where the rail does not attract the magnets of the track brake
    sander_blocked: float = 0.0  # 1 where the sander of the wheelset lays nothing
    train_speed_valid: float = 1.0  # 0 where the train's second source of speed reports a fault
    train_speed_held: float = 0.0  # 1 where it goes on giving what it gave last
    train_speed_factor: float = 1.0  # on what it gives
    train_speed_offset: float = 0.0  # added to it, m/s


Report = Literal["required", "by rotation", "none"]
"""What a controller is to report of a fault: that it is there; the wheelset, if its speed deviates from the
train's; nothing, as the fault takes brake force and lets the wheelset turn, or shows in no input.

Only the second is in a rule (TB/T 3009-2019, 4.2.5, second-hand); which kind is which is chosen. A report of
a wheelset that has a fault is never false.
"""


class FaultValue(NamedTuple):
    """The value that a kind of fault takes.

    Attributes:
        kind: of quantity, a name of :data:`uictest.core.units.KINDS`.
        at_least, at_most: its range, as a user would write it.
        without: what the fault does without one; empty where it must have one.
    """

    kind: str
    at_least: str
    at_most: str
    without: str = ""


class FaultKind(NamedTuple):
    """One kind of fault of one part.

    Attributes:
        part: what is faulty.
        name: how.
        description: one sentence for people; `value` stands for the value of the fault.
        changes: what it changes, or a function that returns that from its value in SI units.
        value: the value that it takes; None where it takes none.
        without_value: what it changes where it can do without one.
        report: what the controller is to report of it.
    """

    part: str
    name: str
    description: str
    changes: Effects | Callable[[float], Effects]
    value: FaultValue | None = None
    without_value: Effects = Effects()
    report: Report = "none"

    @property
    def of_wheelset(self) -> bool:
        """Whether each wheelset has such a part."""
        return self.part not in _OF_TRAIN

    def effects(self, value: float | None) -> Effects:
        """Return its changes for a value in SI units, or without one."""
        if isinstance(self.changes, Effects):
            return self.changes
        return self.without_value if value is None else self.changes(value)


MOST_FAULTS: Final = 8
"""Faults that a stop can have."""
SPEED_SENSOR: Final = "speed-sensor"
"""The part without which the controller cannot protect a wheelset by its own speed."""
DYNAMIC_BRAKE: Final = "dynamic-brake"
TRACK_BRAKE: Final = "track-brake"
"""The parts that a car need not have."""
TRAIN_SPEED: Final = "train-speed"
"""The part that a rig need not have."""
SANDER: Final = "sander"
"""A part that a wheelset need not have."""
_OF_TRAIN: Final = ("brake-line", "controller", DYNAMIC_BRAKE, TRACK_BRAKE, TRAIN_SPEED)
"""The parts of which there is one, and not one for each wheelset."""
_ANY_SPEED: Final = "600 km/h"
_SPEED_OFFSET: Final = FaultValue("speed", "-200 km/h", "200 km/h")
_SHARE: Final = FaultValue("share", "0 %", "100 %")
_FACTOR: Final = FaultValue("share", "0 %", "500 %")
_LEAK: Final = FaultValue("conductance", "0 m3/(s Pa)", "3e-8 m3/(s Pa)")

_ROWS: Final = (
    FaultKind(
        SPEED_SENSOR,
        "lost",
        "It reports its fault (`speed_valid` is 0) and reads `value`.",
        lambda value: Effects(speed_valid=0.0, speed_factor=0.0, speed_offset=value),
        FaultValue("speed", "0 km/h", _ANY_SPEED, without="it reads 0"),
        Effects(speed_valid=0.0, speed_factor=0.0),
        report="required",
    ),
    FaultKind(
        SPEED_SENSOR,
        "stuck",
        "It goes on reading `value` and reports no fault.",
        lambda value: Effects(speed_factor=0.0, speed_offset=value),
        FaultValue("speed", "0 km/h", _ANY_SPEED, without="what it read when the fault began"),
        Effects(speed_held=1.0),
        report="by rotation",
    ),
    FaultKind(
        SPEED_SENSOR,
        "factor",
        "It reads `value` of the speed.",
        lambda value: Effects(speed_factor=value),
        _FACTOR,
        report="by rotation",
    ),
    FaultKind(
        SPEED_SENSOR,
        "offset",
        "It reads the speed and `value`, no less than 0.",
        lambda value: Effects(speed_offset=value),
        _SPEED_OFFSET,
        report="by rotation",
    ),
    FaultKind(
        SPEED_SENSOR,
        "jumps",
        "Each reading has a random error between minus and plus `value`.",
        lambda value: Effects(speed_jump=value),
        FaultValue("speed", "0 km/h", "200 km/h"),
        report="by rotation",
    ),
    FaultKind(
        SPEED_SENSOR,
        "drop-out",
        "A share of `value` of the readings, at random, is 0; it reports no fault.",
        lambda value: Effects(drop_out=value),
        _SHARE,
        report="by rotation",
    ),
    FaultKind(
        SPEED_SENSOR,
        "missing-teeth",
        "Its pole wheel loses `value` teeth in its gap; needs `sensors.speed.method: whole-teeth`.",
        lambda value: Effects(lost_teeth=value),
        FaultValue("count", "1", "100"),
        report="by rotation",
    ),
    FaultKind(
        "hold-magnet",
        "open-circuit",
        "It never acts: the tank stays connected to the brake line, also while it is vented.",
        Effects(fill_at_least=1.0),
        report="by rotation",
    ),
    FaultKind(
        "hold-magnet", "shorted", "It always acts: the tank is never filled.", Effects(fill_at_most=0.0)
    ),
    FaultKind(
        "vent-magnet",
        "open-circuit",
        "It never acts: the tank is never vented.",
        Effects(vent_at_most=0.0),
        report="by rotation",
    ),
    FaultKind(
        "vent-magnet",
        "shorted",
        "It always acts: the tank is vented, also while it is filled.",
        Effects(vent_at_least=1.0),
    ),
    FaultKind(
        "fill-valve",
        "stuck-open",
        "The way from the brake line to the tank never closes.",
        Effects(fill_at_least=1.0),
        report="by rotation",
    ),
    FaultKind(
        "fill-valve",
        "stuck-closed",
        "The way from the brake line to the tank never opens.",
        Effects(fill_at_most=0.0),
    ),
    FaultKind(
        "fill-valve",
        "blocked",
        "A share of `value` of the way from the brake line to the tank is blocked.",
        lambda value: Effects(fill_at_most=1.0 - value),
        _SHARE,
    ),
    FaultKind("vent-valve", "stuck-open", "The exhaust never closes.", Effects(vent_at_least=1.0)),
    FaultKind(
        "vent-valve",
        "stuck-closed",
        "The exhaust never opens.",
        Effects(vent_at_most=0.0),
        report="by rotation",
    ),
    FaultKind(
        "vent-valve",
        "blocked",
        "A share of `value` of the exhaust is blocked.",
        lambda value: Effects(vent_at_most=1.0 - value),
        _SHARE,
        report="by rotation",
    ),
    FaultKind(
        "wsp-valve",
        "slow",
        "Both of its ways take `value` from closed to open.",
        lambda value: Effects(travel_time=value),
        FaultValue("time", "1 ms", "10 s"),
        report="by rotation",
    ),
    FaultKind(
        "tank",
        "leak",
        "Air leaks from the tank through an orifice of the sonic conductance `value`.",
        lambda value: Effects(tank_leak=value),
        _LEAK,
    ),
    FaultKind(
        "brake-line",
        "leak",
        "Air leaks from the brake line through an orifice of the sonic conductance `value`.",
        lambda value: Effects(line_leak=value),
        _LEAK,
    ),
    FaultKind(
        "pressure-sensor",
        "offset",
        "The controller is given the cylinder pressure and `value`, no less than 0.",
        lambda value: Effects(pressure_offset=value),
        FaultValue("pressure", "-10 bar", "10 bar"),
    ),
    FaultKind(
        "pressure-sensor",
        "factor",
        "The controller is given `value` of the cylinder pressure.",
        lambda value: Effects(pressure_factor=value),
        _FACTOR,
    ),
    FaultKind(
        "pressure-sensor",
        "stuck",
        "The controller goes on being given `value`.",
        lambda value: Effects(pressure_factor=0.0, pressure_offset=value),
        FaultValue("pressure", "0 bar", "10 bar", without="the pressure when the fault began"),
        Effects(pressure_held=1.0),
    ),
    FaultKind(
        "brake",
        "cut-out",
        "Its tank is shut off from the brake line and vented.",
        Effects(fill_at_most=0.0, vent_at_least=1.0),
    ),
    FaultKind(
        "controller",
        "silent",
        "No command reaches the valves: they keep the last one for `value`, then they fill.",
        lambda value: Effects(silent=1.0, release_time=value),
        FaultValue("time", "0 s", "3600 s", without="they keep it as long as the fault lasts"),
        Effects(silent=1.0),
        report="by rotation",
    ),
    FaultKind(
        DYNAMIC_BRAKE,
        "failed",
        "The motors of the car stop braking at once; the friction brake takes over.",
        Effects(dynamic_failed=1.0),
    ),
    FaultKind(
        TRACK_BRAKE,
        "failed",
        "The rail does not attract the magnets of the car: they do not come, or let go at once.",
        Effects(track_failed=1.0),
    ),
    FaultKind(SANDER, "blocked", "No sand leaves it.", Effects(sander_blocked=1.0)),
    FaultKind(
        TRAIN_SPEED,
        "lost",
        "The second source of speed reports its fault (`train_speed_valid` is 0) and gives 0.",
        Effects(train_speed_valid=0.0, train_speed_factor=0.0),
    ),
    FaultKind(
        TRAIN_SPEED,
        "stuck",
        "It goes on giving `value` and reports no fault.",
        lambda value: Effects(train_speed_factor=0.0, train_speed_offset=value),
        FaultValue("speed", "0 km/h", _ANY_SPEED, without="what it gave when the fault began"),
        Effects(train_speed_held=1.0),
    ),
    FaultKind(
        TRAIN_SPEED,
        "offset",
        "It gives the speed and `value`, no less than 0.",
        lambda value: Effects(train_speed_offset=value),
        _SPEED_OFFSET,
    ),
)
FAULT_KINDS: Final = MappingProxyType({(row.part, row.name): row for row in _ROWS})
"""Every kind of fault by its part and its name."""
PARTS: Final = tuple(dict.fromkeys(row.part for row in _ROWS))
"""Every part that can be faulty."""

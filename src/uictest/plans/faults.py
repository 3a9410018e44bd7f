"""Faults of the brake and its controller that a scenario can inject: every kind in one row.

A row declares the part that is faulty, the value that the fault takes and its effects: a scenario reads it to
check what a user writes, the rig to compute what a fault changes. The kinds are those of the fault tables of
brake controllers; the ranges of their values are chosen: wide enough for what happens, narrow enough for the
equations of the rig.
"""

from collections.abc import Callable
from types import MappingProxyType
from typing import Final

from uictest.plans.fault_effects import Effects, FaultKind, FaultValue

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

_ANY_SPEED = "600 km/h"
_SHARE_OF_AREA = FaultValue("share", "0 %", "100 %")
_LEAK = FaultValue("conductance", "0 m3/(s Pa)", "3e-8 m3/(s Pa)")
_NOTHING = Effects()
_FACTOR = FaultValue("share", "0 %", "500 %")


def _valued(
    effects: Callable[[float], Effects], otherwise: Effects = _NOTHING
) -> Callable[[float | None], Effects]:
    """Return the effects of a value, `otherwise` without one."""
    return lambda value: otherwise if value is None else effects(value)


def _always(effects: Effects) -> Callable[[float | None], Effects]:
    return lambda value: effects


_ROWS: Final = (
    FaultKind(
        SPEED_SENSOR,
        "lost",
        "It reports its fault (`speed_valid` is 0) and reads `value`.",
        _valued(
            lambda value: Effects(speed_valid=0.0, speed_factor=0.0, speed_offset=value),
            Effects(speed_valid=0.0, speed_factor=0.0),
        ),
        FaultValue("speed", "0 km/h", _ANY_SPEED, without="it reads 0"),
        report="required",
    ),
    FaultKind(
        SPEED_SENSOR,
        "stuck",
        "It goes on reading `value` and reports no fault.",
        _valued(lambda value: Effects(speed_factor=0.0, speed_offset=value), Effects(speed_held=1.0)),
        FaultValue("speed", "0 km/h", _ANY_SPEED, without="what it read when the fault began"),
    ),
    FaultKind(
        SPEED_SENSOR,
        "factor",
        "It reads `value` of the speed.",
        _valued(lambda value: Effects(speed_factor=value)),
        _FACTOR,
    ),
    FaultKind(
        SPEED_SENSOR,
        "offset",
        "It reads the speed and `value`, no less than 0.",
        _valued(lambda value: Effects(speed_offset=value)),
        FaultValue("speed", "-200 km/h", "200 km/h"),
    ),
    FaultKind(
        SPEED_SENSOR,
        "jumps",
        "Each reading has a random error between minus and plus `value`.",
        _valued(lambda value: Effects(speed_jump=value)),
        FaultValue("speed", "0 km/h", "200 km/h"),
    ),
    FaultKind(
        SPEED_SENSOR,
        "drop-out",
        "A share of `value` of the readings, at random, is 0; it reports no fault.",
        _valued(lambda value: Effects(drop_out=value)),
        FaultValue("share", "0 %", "100 %"),
    ),
    FaultKind(
        SPEED_SENSOR,
        "missing-teeth",
        "Its pole wheel loses `value` teeth in its gap; needs `sensors.speed.method: whole-teeth`.",
        _valued(lambda value: Effects(lost_teeth=value)),
        FaultValue("count", "1", "100"),
    ),
    FaultKind(
        "hold-magnet",
        "open-circuit",
        "It never acts: the tank stays connected to the brake line, also while it is vented.",
        _always(Effects(fill_at_least=1.0)),
    ),
    FaultKind(
        "hold-magnet",
        "shorted",
        "It always acts: the tank is never filled.",
        _always(Effects(fill_at_most=0.0)),
        report="none",
    ),
    FaultKind(
        "vent-magnet",
        "open-circuit",
        "It never acts: the tank is never vented.",
        _always(Effects(vent_at_most=0.0)),
    ),
    FaultKind(
        "vent-magnet",
        "shorted",
        "It always acts: the tank is vented, also while it is filled.",
        _always(Effects(vent_at_least=1.0)),
        report="none",
    ),
    FaultKind(
        "fill-valve",
        "stuck-open",
        "The way from the brake line to the tank never closes.",
        _always(Effects(fill_at_least=1.0)),
    ),
    FaultKind(
        "fill-valve",
        "stuck-closed",
        "The way from the brake line to the tank never opens.",
        _always(Effects(fill_at_most=0.0)),
        report="none",
    ),
    FaultKind(
        "fill-valve",
        "blocked",
        "A share of `value` of the way from the brake line to the tank is blocked.",
        _valued(lambda value: Effects(fill_at_most=1.0 - value)),
        _SHARE_OF_AREA,
        report="none",
    ),
    FaultKind(
        "vent-valve",
        "stuck-open",
        "The exhaust never closes.",
        _always(Effects(vent_at_least=1.0)),
        report="none",
    ),
    FaultKind("vent-valve", "stuck-closed", "The exhaust never opens.", _always(Effects(vent_at_most=0.0))),
    FaultKind(
        "vent-valve",
        "blocked",
        "A share of `value` of the exhaust is blocked.",
        _valued(lambda value: Effects(vent_at_most=1.0 - value)),
        _SHARE_OF_AREA,
    ),
    FaultKind(
        "wsp-valve",
        "slow",
        "Both of its ways take `value` from closed to open.",
        _valued(lambda value: Effects(travel_time=value)),
        FaultValue("time", "1 ms", "10 s"),
    ),
    FaultKind(
        "tank",
        "leak",
        "Air leaks from the tank through an orifice of the sonic conductance `value`.",
        _valued(lambda value: Effects(tank_leak=value)),
        _LEAK,
        report="none",
    ),
    FaultKind(
        "brake-line",
        "leak",
        "Air leaks from the brake line through an orifice of the sonic conductance `value`.",
        _valued(lambda value: Effects(line_leak=value)),
        _LEAK,
        of_wheelset=False,
        report="none",
    ),
    FaultKind(
        "pressure-sensor",
        "offset",
        "The controller is given the cylinder pressure and `value`, no less than 0.",
        _valued(lambda value: Effects(pressure_offset=value)),
        FaultValue("pressure", "-10 bar", "10 bar"),
        report="none",
    ),
    FaultKind(
        "pressure-sensor",
        "factor",
        "The controller is given `value` of the cylinder pressure.",
        _valued(lambda value: Effects(pressure_factor=value)),
        _FACTOR,
        report="none",
    ),
    FaultKind(
        "pressure-sensor",
        "stuck",
        "The controller goes on being given `value`.",
        _valued(
            lambda value: Effects(pressure_factor=0.0, pressure_offset=value), Effects(pressure_held=1.0)
        ),
        FaultValue("pressure", "0 bar", "10 bar", without="the pressure when the fault began"),
        report="none",
    ),
    FaultKind(
        "brake",
        "cut-out",
        "Its tank is shut off from the brake line and vented.",
        _always(Effects(fill_at_most=0.0, vent_at_least=1.0)),
        report="none",
    ),
    FaultKind(
        "controller",
        "silent",
        "No command reaches the valves: they keep the last one for `value`, then they fill.",
        _valued(lambda value: Effects(silent=1.0, release_time=value), Effects(silent=1.0)),
        FaultValue("time", "0 s", "3600 s", without="they keep it as long as the fault lasts"),
        of_wheelset=False,
    ),
    FaultKind(
        DYNAMIC_BRAKE,
        "failed",
        "The motors of the car stop braking at once; the friction brake takes over.",
        _always(Effects(dynamic_failed=1.0)),
        of_wheelset=False,
        report="none",
    ),
    FaultKind(
        TRACK_BRAKE,
        "failed",
        "The rail does not attract the magnets of the car: they do not come, or let go at once.",
        _always(Effects(track_failed=1.0)),
        of_wheelset=False,
        report="none",
    ),
    FaultKind(SANDER, "blocked", "No sand leaves it.", _always(Effects(sander_blocked=1.0)), report="none"),
    FaultKind(
        TRAIN_SPEED,
        "lost",
        "The second source of speed reports its fault (`train_speed_valid` is 0) and gives 0.",
        _always(Effects(train_speed_valid=0.0, train_speed_factor=0.0)),
        of_wheelset=False,
        report="none",
    ),
    FaultKind(
        TRAIN_SPEED,
        "stuck",
        "It goes on giving `value` and reports no fault.",
        _valued(
            lambda value: Effects(train_speed_factor=0.0, train_speed_offset=value),
            Effects(train_speed_held=1.0),
        ),
        FaultValue("speed", "0 km/h", _ANY_SPEED, without="what it gave when the fault began"),
        of_wheelset=False,
        report="none",
    ),
    FaultKind(
        TRAIN_SPEED,
        "offset",
        "It gives the speed and `value`, no less than 0.",
        _valued(lambda value: Effects(train_speed_offset=value)),
        FaultValue("speed", "-200 km/h", "200 km/h"),
        of_wheelset=False,
        report="none",
    ),
)

FAULT_KINDS: Final = MappingProxyType({(row.part, row.name): row for row in _ROWS})
"""Every kind of fault by its part and its name."""
PARTS: Final = tuple(dict.fromkeys(row.part for row in _ROWS))
"""Every part that can be faulty."""

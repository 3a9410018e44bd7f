"""What a fault can change, and what a kind of fault declares.

Each effect is a table of the rig, and no code asks what kind of fault it is.
"""

import math
from collections.abc import Callable
from typing import Literal, NamedTuple


class Effects(NamedTuple):
    """What a fault changes while it is active, SI units; by default nothing.

    Attributes:
        speed_valid: 0 where the speed sensor reports a fault.
        speed_held: 1 where it goes on reading what it read last.
        speed_factor: factor on its reading.
        speed_offset: added to its reading, m/s.
        speed_jump: largest random error of its reading, new in every controller cycle, m/s.
        drop_out: share of its readings that are zero.
        lost_teeth: teeth that its pole wheel lacks besides those that it lacked before.
        fill_at_least, fill_at_most: bounds of the opening from the brake line to the tank, 0 to 1.
        vent_at_least, vent_at_most: bounds of the opening from the tank to the atmosphere, 0 to 1.
        travel_time: of the valve between closed and open, if longer than its own, s.
        tank_leak, line_leak: sonic conductance from the tank, from the brake line, m3/(s Pa).
        pressure_held: 1 where the pressure that the controller is given stays what it was.
        pressure_factor: factor on that pressure.
        pressure_offset: added to it, gauge, Pa.
        silent: 1 where the valves keep the last command of the controller.
        release_time: silence after which they fill, s.
        dynamic_failed: 1 where the dynamic brake of the car gives nothing.
        track_failed: 1 where the rail does not attract the magnets of the track brake.
        sander_blocked: 1 where the sander of the wheelset lays nothing.
        train_speed_valid: 0 where the train's second source of speed reports a fault.
        train_speed_held: 1 where it goes on giving what it gave last.
        train_speed_factor: factor on what it gives.
        train_speed_offset: added to it, m/s.
    """

    speed_valid: float = 1.0
    speed_held: float = 0.0
    speed_factor: float = 1.0
    speed_offset: float = 0.0
    speed_jump: float = 0.0
    drop_out: float = 0.0
    lost_teeth: float = 0.0
    fill_at_least: float = 0.0
    fill_at_most: float = 1.0
    vent_at_least: float = 0.0
    vent_at_most: float = 1.0
    travel_time: float = 0.0
    tank_leak: float = 0.0
    line_leak: float = 0.0
    pressure_held: float = 0.0
    pressure_factor: float = 1.0
    pressure_offset: float = 0.0
    silent: float = 0.0
    release_time: float = math.inf
    dynamic_failed: float = 0.0
    track_failed: float = 0.0
    sander_blocked: float = 0.0
    train_speed_valid: float = 1.0
    train_speed_held: float = 0.0
    train_speed_factor: float = 1.0
    train_speed_offset: float = 0.0


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
        effects: returns what it changes, from its value in SI units or None without one.
        value: the value that it takes; None where it takes none.
        of_wheelset: whether each wheelset has such a part.
        report: what the controller is to report of it.
    """

    part: str
    name: str
    description: str
    effects: Callable[[float | None], Effects]
    value: FaultValue | None = None
    of_wheelset: bool = True
    report: Report = "by rotation"

"""Faults in numbers: when each is active and what it changes, in tables that only scalar code reads.

Entries beyond the last fault change nothing. What a fault leaves alone has its neutral value there, so that
no code asks what kind of fault it is.
"""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.core.record import Record, derived
from uictest.plans.faults import MOST_FAULTS

FaultTable = Annotated[MutableSequence[float], MOST_FAULTS]


class FaultTables(Record):
    """The faults of a stop, in the order of the scenario; effects as in :class:`.Effects`."""

    fault_count: int = derived()
    has_leaks: float = derived()  # 0 or 1: a fault is a leak
    # it begins once all of these hold, and ends once the second three do
    fault_begin_time: FaultTable = derived()  # time since the command of at least, s
    fault_begin_speed: FaultTable = derived()  # train speed of at most, m/s
    fault_begin_distance: FaultTable = derived()  # distance since the command of at least, m
    fault_end_time: FaultTable = derived()
    fault_end_speed: FaultTable = derived()
    fault_end_distance: FaultTable = derived()
    # whose it is
    fault_wheelset: FaultTable = derived()  # 0 to 3
    fault_of_wheelset: FaultTable = derived()  # 0 where it is one of the train
    fault_of_speed_sensor: FaultTable = derived()  # 0 or 1
    fault_report_required: FaultTable = derived()  # 0 or 1
    # what it changes
    fault_speed_valid: FaultTable = derived()
    fault_speed_held: FaultTable = derived()
    fault_speed_factor: FaultTable = derived()
    fault_speed_offset: FaultTable = derived()  # m/s
    fault_speed_jump: FaultTable = derived()  # m/s
    fault_drop_out: FaultTable = derived()
    fault_lost_teeth: FaultTable = derived()
    fault_fill_at_least: FaultTable = derived()
    fault_fill_at_most: FaultTable = derived()
    fault_vent_at_least: FaultTable = derived()
    fault_vent_at_most: FaultTable = derived()
    fault_travel_per_step: FaultTable = derived()  # largest change of an opening in a step
    fault_tank_leak: FaultTable = derived()  # m3/(s Pa)
    fault_line_leak: FaultTable = derived()  # m3/(s Pa)
    fault_pressure_held: FaultTable = derived()
    fault_pressure_factor: FaultTable = derived()
    fault_pressure_offset: FaultTable = derived()  # Pa
    fault_silent: FaultTable = derived()
    fault_dynamic_failed: FaultTable = derived()  # 0 or 1
    fault_track_failed: FaultTable = derived()  # 0 or 1
    fault_sander_blocked: FaultTable = derived()  # 0 or 1
    fault_train_speed_valid: FaultTable = derived()
    fault_train_speed_held: FaultTable = derived()
    fault_train_speed_factor: FaultTable = derived()
    fault_train_speed_offset: FaultTable = derived()  # m/s
    fault_release_cycles: FaultTable = derived()  # controller cycles of silence after which the valves fill

"""Channels of a recording and how a sample of them is taken."""

from collections.abc import Sequence
from typing import Any

from uictest.controllers import reference_speed

Record = Any

CAR_CHANNELS = (
    ("time", "s"),
    ("distance", "m"),
    ("speed", "m/s"),
    ("reference_speed", "m/s"),
    ("demanded_pressure", "Pa"),
    ("brake_line_pressure", "Pa"),
    ("reservoir_pressure", "Pa"),
)
"""Channels of the train; pressures are gauge."""

WHEELSET_CHANNELS = (
    ("wheel_speed", "m/s"),  # circumferential
    ("measured_speed", "m/s"),
    ("slide", "1"),  # 0 while the train runs no faster than SLIDE_SPEED
    ("adhesion", "1"),
    ("friction", "1"),  # initial friction coefficient under the wheelset
    ("wheel_load", "N"),  # of one wheel
    ("valve_command", "1"),  # 0 fill, 1 hold, 2 vent
    ("tank_pressure", "Pa"),
    ("cylinder_pressure", "Pa"),  # measured, or computed by the cylinder dynamics
    ("stroke", "m"),
    ("caliper_force", "N"),  # that a caliper gives at the tank's pressure
    ("computed_force", "N"),
    ("clamping_force", "N"),  # as the vehicle received it
    ("brake_torque", "N m"),
)
"""Channels of each wheelset; pressures are gauge."""

SLIDE_SPEED = 1.0
"""m/s; chosen: a slide is relative to the train speed, and below this it magnifies what no brake acts on."""

ROW = len(CAR_CHANNELS) + 4 * len(WHEELSET_CHANNELS)


def sample(row: Any, car: Record, wheelsets: Sequence[Record], p: Record) -> None:
    """Write the present state into ``row``, an array of :data:`ROW` numbers."""
    row[0] = car.time
    row[1] = car.position
    row[2] = car.speed
    row[3] = reference_speed(car, p)
    row[4] = car.demand
    row[5] = car.line_pressure - p.atmospheric_pressure
    row[6] = car.reservoir_pressure - p.atmospheric_pressure
    for i in range(4):
        _sample_wheelset(row, 7 + 14 * i, wheelsets[i], car, p)


def _sample_wheelset(row: Any, first: int, wheelset: Record, car: Record, p: Record) -> None:
    wheel_speed = wheelset.rotation * p.wheel_radius
    row[first] = wheel_speed
    row[first + 1] = wheelset.measured_speed
    row[first + 2] = (car.speed - wheel_speed) / car.speed if car.speed > SLIDE_SPEED else 0.0
    row[first + 3] = 0.5 * wheelset.creep_force / wheelset.wheel_load
    row[first + 4] = wheelset.friction
    row[first + 5] = wheelset.wheel_load
    row[first + 6] = wheelset.command
    row[first + 7] = wheelset.pressure - p.atmospheric_pressure
    row[first + 8] = wheelset.compensated_pressure
    row[first + 9] = wheelset.stroke
    row[first + 10] = wheelset.caliper_force
    row[first + 11] = wheelset.computed_force
    row[first + 12] = wheelset.clamping_force
    row[first + 13] = wheelset.torque

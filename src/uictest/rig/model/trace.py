"""Channels of a recording and how a sample of them is taken."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from uictest.core.physics import FILL, VENT
from uictest.core.record import Record, channel, layout_of, units_of
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset


class TrainSample(Record):
    """Channels of the train; pressures are gauge."""

    time: float = channel("s")
    distance: float = channel("m")
    speed: float = channel("m/s")
    reference_speed: float = channel("m/s")
    diagnosis: float = channel("1")  # 32 bits of a controller from outside, as a number
    track_brake_force: float = channel("N")  # of the magnets against the motion
    track_brake_request: float = channel("1")  # 1 while the controller asks for the track brake
    measured_train_speed: float = channel("m/s")  # of the second source, as the controller is given it
    train_speed_valid: float = channel("1")  # 0 while that reports a fault
    measured_acceleration: float = channel("m/s2")  # of the accelerometer
    active_faults: float = channel("1")  # one bit for each fault of the list, as a number
    demanded_pressure: float = channel("Pa")
    brake_line_pressure: float = channel("Pa")
    reservoir_pressure: float = channel("Pa")


class WheelsetSample(Record):
    """Channels of one wheelset; pressures are gauge."""

    wheel_speed: float = channel("m/s")  # circumferential
    measured_speed: float = channel("m/s")
    speed_valid: float = channel("1")  # 0 while the speed sensor reports a fault
    slide: float = channel("1")  # 0 while the train runs no faster than SLIDE_SPEED
    adhesion: float = channel("1")
    friction: float = channel("1")  # initial friction coefficient under the wheelset
    cleaned_share: float = channel("1")  # of the rail under the wheelset and behind it
    sand_density: float = channel("kg/m")  # on the rail before the wheelset
    sanding: float = channel("1")  # 1 while its sander lays sand
    wheel_load: float = channel("N")  # of one wheel
    valve_command: float = channel("1")  # 0 fill, 1 hold, 2 vent
    hold_magnet: float = channel("1")  # 1 while the valve is commanded to hold or to vent
    vent_magnet: float = channel("1")  # 1 while it is commanded to vent
    dynamic_reduction: float = channel("1")  # share that the controller takes off the dynamic brake
    sand_request: float = channel("1")  # 1 while the controller asks for sand
    tank_pressure: float = channel("Pa")
    cylinder_pressure: float = channel("Pa")  # measured, or computed by the cylinder dynamics
    stroke: float = channel("m")
    caliper_force: float = channel("N")  # that a caliper gives at the tank's pressure
    computed_force: float = channel("N")
    clamping_force: float = channel("N")  # as the vehicle received it
    brake_torque: float = channel("N m")  # of all brakes
    dynamic_torque: float = channel("N m")  # part of it
    pad_friction: float = channel("1")
    disc_temperature: float = channel("K")  # of the bulk
    disc_surface_temperature: float = channel("K")


CAR_CHANNELS = units_of(TrainSample)
"""Channels of the train and their units."""
WHEELSET_CHANNELS = units_of(WheelsetSample)
"""Channels of each wheelset and their units."""
CHANNELS_OF = {
    "disc temperature": ("disc_temperature", "disc_surface_temperature"),
    "dynamic brake": ("dynamic_torque", "dynamic_reduction"),
    "track brake": ("track_brake_force",),
    "train speed": ("measured_train_speed", "train_speed_valid"),
    "accelerometer": ("measured_acceleration",),
    "controller from outside": ("diagnosis",),
    "contract version 2": ("track_brake_request", "sand_request"),
    "sanders": ("sand_density", "sanding"),
    "faults": ("active_faults", "speed_valid"),
}
"""What a stop must have -> channels of the train and of each wheelset that mean something only then."""
TRAIN_SAMPLE = layout_of(TrainSample)
"""Layout of :class:`TrainSample`."""
WHEELSET_SAMPLE = layout_of(WheelsetSample)
"""Layout of :class:`WheelsetSample`."""

SLIDE_SPEED = 1.0
"""m/s; chosen: a slide is relative to the train speed, and below this it magnifies what no brake acts on."""


class Trace(NamedTuple):
    """Samples of a stop: records of :data:`TRAIN_SAMPLE`, shape (n,), and :data:`WHEELSET_SAMPLE`, (n, 4)."""

    train: Any
    wheelsets: Any


def sample(trace: Trace, row: int, car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Write the present state into one row of a trace."""
    _sample_train(trace.train[row], car, p)
    for i in range(4):
        _sample_wheelset(trace.wheelsets[row, i], wheelsets[i], car, p)


def _sample_train(row: TrainSample, car: Car, p: Parameters) -> None:
    row.time = car.time
    row.distance = car.position
    row.speed = car.speed
    row.reference_speed = car.reference_speed
    row.diagnosis = car.diagnosis
    row.track_brake_force = car.track_brake_force
    row.track_brake_request = car.track_brake_request
    row.measured_train_speed = car.train_speed
    row.train_speed_valid = car.train_speed_valid
    row.measured_acceleration = car.acceleration
    row.active_faults = car.active_faults
    row.demanded_pressure = car.demanded_pressure
    row.brake_line_pressure = car.line_pressure - p.atmospheric_pressure
    row.reservoir_pressure = car.reservoir_pressure - p.atmospheric_pressure


def _sample_wheelset(row: WheelsetSample, wheelset: Wheelset, car: Car, p: Parameters) -> None:
    wheel_speed = wheelset.rotation * wheelset.wheel_radius
    row.wheel_speed = wheel_speed
    row.measured_speed = wheelset.measured_speed
    row.speed_valid = wheelset.speed_valid
    row.slide = (car.speed - wheel_speed) / car.speed if car.speed > SLIDE_SPEED else 0.0
    row.adhesion = 0.5 * wheelset.creep_force / wheelset.wheel_load
    row.friction = wheelset.friction
    row.cleaned_share = wheelset.cleaned_share
    row.sand_density = wheelset.sand_density
    row.sanding = wheelset.sander_open * (1.0 - wheelset.sander_blocked)
    row.wheel_load = wheelset.wheel_load
    row.valve_command = wheelset.valve_command
    row.hold_magnet = 0.0 if wheelset.valve_command == FILL else 1.0
    row.vent_magnet = 1.0 if wheelset.valve_command == VENT else 0.0
    row.dynamic_reduction = wheelset.dynamic_reduction
    row.sand_request = wheelset.sand_request
    row.tank_pressure = wheelset.pressure - p.atmospheric_pressure
    row.cylinder_pressure = wheelset.compensated_pressure
    row.stroke = wheelset.stroke
    row.caliper_force = wheelset.caliper_force
    row.computed_force = wheelset.computed_force
    row.clamping_force = wheelset.clamping_force
    row.brake_torque = wheelset.torque
    row.dynamic_torque = wheelset.dynamic_torque
    row.pad_friction = wheelset.pad_friction
    row.disc_temperature = wheelset.disc_temperature
    row.disc_surface_temperature = wheelset.disc_surface_temperature

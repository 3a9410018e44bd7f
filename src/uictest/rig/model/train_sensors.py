"""What tells a controller of the train besides its wheelsets: a second source of speed, an accelerometer.

Scalar code once per controller cycle, only in stops that have one of them. Noise has channels of its own, so
that all other sensors read what they read without them.
"""

from uictest.core.physics import fma, maximum
from uictest.rig.model.cycle import TRAIN_ACCELERATION, TRAIN_SPEED, sensor_noise
from uictest.rig.model.faults import is_active
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car


def read_train_sensors(car: Car, p: Parameters) -> None:
    """Give the controller what both show in cycle ``car.cycle``; after the faults are decided."""
    if p.has_train_speed > 0.0:
        _read_train_speed(car, p)
    if p.has_accelerometer > 0.0:
        before = p.initial_speed if car.cycle == 0 else car.speed_before
        change = (car.speed - before) / p.cycle_time + p.gravity * p.gradient
        noise = p.accelerometer_noise * sensor_noise(p, car.cycle, TRAIN_ACCELERATION)
        car.acceleration = change + (noise + p.accelerometer_offset)
        car.acceleration_valid = 1
        car.speed_before = car.speed


def _read_train_speed(car: Car, p: Parameters) -> None:
    """Take a value where one is due, show the one that has arrived, and falsify it.

    In cycle c the newest value is of cycle floor(c / period) period; that which has arrived is of cycle
    floor((c - delay) / period) period. Before the brake command the source gave the initial speed.
    """
    if car.cycle == 0:
        car.train_speed_1 = car.train_speed_2 = car.train_speed_3 = p.initial_speed
        car.held_train_speed = p.initial_speed
    if car.cycle % p.train_speed_period == 0:
        car.train_speed_4 = car.train_speed_3
        car.train_speed_3 = car.train_speed_2
        car.train_speed_2 = car.train_speed_1
        noise = p.train_speed_noise * sensor_noise(p, car.cycle, TRAIN_SPEED)
        car.train_speed_1 = maximum(fma(car.speed, p.train_speed_gain_error, car.speed) + noise, 0.0)
    on_their_way = (
        car.cycle // p.train_speed_period - (car.cycle - p.train_speed_delay) // p.train_speed_period
    )
    if on_their_way == 0:
        speed = car.train_speed_1
    elif on_their_way == 1:
        speed = car.train_speed_2
    elif on_their_way == 2:
        speed = car.train_speed_3
    else:
        speed = car.train_speed_4
    _show(car, speed, p)


def _show(car: Car, speed: float, p: Parameters) -> None:
    """Set what the controller is given of a speed, with the faults that are active."""
    car.train_speed_valid = 1
    for k in range(p.fault_count):
        if is_active(car, k) and p.fault_train_speed_held[k] > 0.0:
            speed = car.held_train_speed
    car.held_train_speed = speed
    for k in range(p.fault_count):
        if is_active(car, k):
            offset_speed = fma(speed, p.fault_train_speed_factor[k], p.fault_train_speed_offset[k])
            speed = maximum(offset_speed, 0.0)
            if p.fault_train_speed_valid[k] == 0.0:
                car.train_speed_valid = 0
    car.train_speed = speed if car.train_speed_valid > 0 else 0.0

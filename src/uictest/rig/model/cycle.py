"""Work of each controller cycle: read the sensors, let the controller decide, set the valves.

Reading sensors and setting valves has no branches, so that SIMD lanes can run it; the controller between them
is scalar code that may branch and use tables. Speed sensors that count whole teeth, or whose pole wheel is
eccentric or has lost teeth, are read only in stops where a wheelset has one. So is what tells a controller of
the train besides its wheelsets, a second source of speed and an accelerometer: their noise has channels of
its own, so that all other sensors read what they read without them.
"""

import math
from collections.abc import Sequence
from typing import Any

from uictest.core.physics import (
    FILL,
    VENT,
    bell,
    command_before,
    fma,
    interpolated,
    last_tooth,
    maximum,
    passed_turns,
    passing_rate,
    quotient_factor,
    remember,
    select,
    speed_of_teeth,
    speed_reading,
    threefry,
    time_since,
    uniform,
)
from uictest.rig.model.friction_brake import set_pad_friction
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import FACTORS, FRICTIONS, PLACES, TIMES, vary_friction
from uictest.rig.model.records import Needs
from uictest.rig.model.state import Car, Wheelset

CHANNELS = 16
"""Noise channels set aside for each wheelset."""
SPEED, _PRESSURE, _LOADCELL = 0, 1, 2
"""Noise channels of a wheelset's sensors."""
_LINE = 4 * CHANNELS
"""Noise channel of the brake line's pressure sensor, after those of the wheelsets."""
TRAIN_SPEED, TRAIN_ACCELERATION = _LINE + 1, _LINE + 2
"""Noise channels of the second source of speed and of the accelerometer."""
_PHASE = 3
"""Noise channel of a wheelset that gives the angle of its pole wheel at the brake command."""
_PER_RADIAN = 0.5 / math.pi
"""Turns."""


def read_sensors(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, needs: Needs) -> None:
    """Read the sensors for cycle ``car.cycle``: of speeds and pressures, and what else the rig has."""
    for i in range(4):
        read_module_sensors(wheelsets[i], p, car.cycle, i)
    _read_loadcells(wheelsets[0], p, car.cycle, 0)
    if needs.calipers:
        for i in range(1, 4):
            _read_loadcells(wheelsets[i], p, car.cycle, i)
    if needs.line_pressure:
        read_line_sensor(car, p, car.cycle)
    if needs.pole_wheels:
        for i in range(4):
            read_pole_wheel(wheelsets[i], car, p, i)


def start_cycle(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, rail: Any) -> None:
    """Look up the friction under each wheelset and of its pads.

    Args:
        car: car record.
        wheelsets: four wheelset records.
        p: parameter record.
        rail: array of shape (4, n), see :mod:`uictest.rig.model.rail`.
    """
    factor = interpolated(car.time, rail[TIMES], rail[FACTORS], p.friction_times)
    factor *= quotient_factor(
        maximum(car.speed, 0.0),
        p.friction_speed_numerator,
        p.friction_speed_denominator,
        p.friction_speed_scale,
    )
    for i in range(4):
        wheelset = wheelsets[i]
        along = interpolated(car.position - wheelset.behind, rail[PLACES], rail[FRICTIONS], p.friction_points)
        wheelset.friction = along * factor
    if p.varies_friction > 0.0:
        vary_friction(car, wheelsets, p)
    set_pad_friction(wheelsets, p)


def command_valves(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set the valve targets of all wheelsets for the steps of this cycle."""
    for i in range(4):
        command_valve(wheelsets[i], p)
    car.substep = 0.0
    car.cycle += 1


def read_module_sensors(wheelset: Wheelset, p: Parameters, cycle: int, number: int) -> None:
    """Read the speed sensor and draw the momentary error of the pressure sensor."""
    channel = number * CHANNELS
    wheelset.pressure_error = wheelset.pressure_noise * sensor_noise(p, cycle, channel + _PRESSURE)
    wheelset.measured_speed = speed_reading(
        wheelset.rotation * wheelset.configured_radius,
        wheelset.tooth_pitch,
        wheelset.timer_resolution,
        p.cycle_time,
        wheelset.slowest_measured_speed,
        wheelset.speed_noise * sensor_noise(p, cycle, channel + SPEED) + wheelset.speed_gain_error,
    )


def _read_loadcells(wheelset: Wheelset, p: Parameters, cycle: int, number: int) -> None:
    channel = number * CHANNELS + _LOADCELL
    wheelset.loadcell_error = wheelset.loadcell_noise * sensor_noise(p, cycle, channel)


def read_line_sensor(car: Car, p: Parameters, cycle: int) -> None:
    """Draw the momentary error of the brake line's pressure sensor."""
    car.line_pressure_error = p.line_sensor_noise * sensor_noise(p, cycle, _LINE)


def sensor_noise(p: Parameters, cycle: int, channel: int) -> float:
    """Number of mean 0 and variance 1 for one cycle and one noise channel."""
    word_0, word_1 = noise_words(p, cycle, channel)
    return bell(word_0, word_1)


def noise_words(p: Parameters, cycle: int, channel: int) -> tuple[int, int]:
    """Two words of random bits for one cycle and one noise channel."""
    return threefry(p.seed, p.noise_key, cycle, channel)


def command_valve(wheelset: Wheelset, p: Parameters) -> None:
    """Register the newest command and set the targets that take effect in this cycle, after the delay."""
    command = select(p.wsp_active == 0, FILL, wheelset.valve_command)
    register = remember(wheelset.command_register, command)
    wheelset.valve_command = command
    wheelset.dynamic_reduction *= select(p.wsp_active == 0, 0.0, p.has_dynamic_brake)
    wheelset.command_register = register
    before = command_before(register, wheelset.valve_delay_cycles + 1)
    after = command_before(register, wheelset.valve_delay_cycles)
    filling_cycles = select(command == FILL, wheelset.filling_cycles + 1, 0)
    wheelset.fill_before = select(before == FILL, 1.0, 0.0)
    wheelset.fill_after = select(after == FILL, 1.0, 0.0)
    wheelset.vent_before = select(before == VENT, 1.0, 0.0)
    wheelset.vent_after = select(after == VENT, 1.0, 0.0)
    wheelset.venting = select(command == VENT, 1.0, 0.0)
    wheelset.filling_cycles = filling_cycles
    wheelset.wsp_acting = select(filling_cycles < p.wsp_acting_cycles, 1.0, 0.0)


def read_pole_wheel(wheelset: Wheelset, car: Car, p: Parameters, number: int) -> None:
    """Read the pole wheel of one wheelset after its momentary speed has been read."""
    turns = wheelset.angle * _PER_RADIAN + uniform(noise_words(p, 0, number * CHANNELS + _PHASE))
    rate = passing_rate(turns, wheelset.eccentricity)
    momentary = wheelset.measured_speed * rate
    _count(wheelset, car, p, turns, rate)
    held = wheelset.tooth_speed
    age = car.time - wheelset.tooth_time
    slowest = wheelset.slowest_measured_speed
    silent = select(held < slowest, 1.0, select(age * slowest > wheelset.tooth_pitch, 1.0, 0.0))
    noise = wheelset.speed_noise * sensor_noise(p, car.cycle, number * CHANNELS + SPEED)
    averaged = select(silent > 0.0, 0.0, held * (1.0 + (noise + wheelset.speed_gain_error)))
    wheelset.measured_speed = select(wheelset.counts_teeth > 0.0, averaged, momentary)


def _count(wheelset: Wheelset, car: Car, p: Parameters, turns: float, rate: float) -> None:
    """Take the speed of the whole teeth that have passed since the last one before; none: keep the speed.

    Args:
        turns: of the pole wheel.
        rate: at which it passes the sensor at present, over that of its rotation.
    """
    begins = car.cycle == 0
    tooth_rate = wheelset.rotation * _PER_RADIAN * wheelset.teeth * rate
    configured_speed = wheelset.rotation * wheelset.configured_radius * rate
    position = passed_turns(turns, wheelset.eccentricity) * wheelset.teeth
    counted, tooth = last_tooth(position, wheelset.teeth, wheelset.missing_teeth)
    rate_before = select(begins, tooth_rate, wheelset.tooth_rate)
    time = car.time - time_since(position - tooth, tooth_rate, rate_before, p.cycle_time)
    # By the teeth that the wheel has now: it may have lost some since.
    before, _ = last_tooth(wheelset.last_tooth, wheelset.teeth, wheelset.missing_teeth)
    passed = counted - select(begins, counted, before)
    speed = speed_of_teeth(
        passed, wheelset.tooth_pitch, time - wheelset.tooth_time, wheelset.timer_resolution
    )
    moved = select(begins, 1.0, passed) > 0.0
    wheelset.tooth_speed = select(begins, configured_speed, select(moved, speed, wheelset.tooth_speed))
    wheelset.last_tooth = tooth
    wheelset.tooth_time = select(moved, time, wheelset.tooth_time)
    wheelset.tooth_rate = tooth_rate


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


def is_active(car: Car, k: int) -> bool:
    """Return whether fault ``k`` is active in this cycle."""
    return ((car.active_faults >> k) & 1) == 1

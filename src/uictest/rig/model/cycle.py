"""What happens once per controller cycle: read the sensors, let the controller decide, set the valves.

Reading sensors and setting valves has no branches and runs in lanes, too; the controller between them is
scalar code that may branch and look up tables. Between two cycles :func:`uictest.rig.model.step.step` runs
alone.
"""

from collections.abc import Sequence
from typing import Any

from uictest.core.physics import (
    FILL,
    VENT,
    bell,
    command_before,
    interpolated,
    remember,
    select,
    speed_reading,
    threefry,
)
from uictest.rig.model.disc_brake import set_pad_friction
from uictest.rig.model.friction_law import FACTORS, FRICTIONS, PLACES, TIMES
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset

CHANNELS = 16
"""Noise channels set aside for each wheelset."""
SPEED, _PRESSURE, _LOADCELL = 0, 1, 2
"""Noise channels of a wheelset's sensors."""
_LINE = 4 * CHANNELS
"""Noise channel of the brake line's pressure sensor, behind those of the wheelsets."""


def read_sensors(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Read the sensors of all wheelsets for cycle ``car.cycle``."""
    read_module_sensors(wheelsets[0], p, car.cycle, 0)
    read_module_sensors(wheelsets[1], p, car.cycle, 1)
    read_module_sensors(wheelsets[2], p, car.cycle, 2)
    read_module_sensors(wheelsets[3], p, car.cycle, 3)
    read_line_sensor(car, p, car.cycle)


def start_cycle(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, rail: Any) -> None:
    """Look up the friction under each wheelset and of its pads.

    Args:
        car: car record.
        wheelsets: four wheelset records.
        p: parameter record.
        rail: array of shape (4, n), see :mod:`uictest.rig.model.friction_law`.
    """
    factor = interpolated(car.time, rail[TIMES], rail[FACTORS], p.friction_times)
    for i in range(4):
        wheelset = wheelsets[i]
        along = interpolated(car.position - wheelset.behind, rail[PLACES], rail[FRICTIONS], p.friction_points)
        wheelset.friction = along * factor
    set_pad_friction(wheelsets, p)


def command_valves(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set the valve targets of all wheelsets for the steps of this cycle."""
    command_valve(wheelsets[0], p)
    command_valve(wheelsets[1], p)
    command_valve(wheelsets[2], p)
    command_valve(wheelsets[3], p)
    car.substep = 0.0
    car.cycle += 1


def read_module_sensors(wheelset: Wheelset, p: Parameters, cycle: int, number: int) -> None:
    """Read the speed sensor and draw the momentary errors of the pressure sensor and the loadcells."""
    channel = number * CHANNELS
    wheelset.pressure_error = wheelset.pressure_noise * sensor_noise(p, cycle, channel + _PRESSURE)
    wheelset.loadcell_error = wheelset.loadcell_noise * sensor_noise(p, cycle, channel + _LOADCELL)
    wheelset.measured_speed = speed_reading(
        wheelset.rotation * wheelset.configured_radius,
        wheelset.tooth_pitch,
        wheelset.timer_resolution,
        p.cycle_time,
        wheelset.slowest_measured_speed,
        wheelset.speed_noise * sensor_noise(p, cycle, channel + SPEED) + wheelset.speed_gain_error,
    )


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

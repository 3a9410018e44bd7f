"""The state at the instant of the brake command, when the train rolls with its brakes released."""

from collections.abc import Sequence

from uictest.core.physics import select
from uictest.rig.model.balance import stored_air, stored_air_energy, stored_energy
from uictest.rig.model.brake_command import start_command
from uictest.rig.model.controller import begin
from uictest.rig.model.disc_brake import start_disc
from uictest.rig.model.dynamic_brake import start_dynamic_brake
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import set_creep_curve
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.wheelset_parameters import WheelsetParameters, copy_wheelset_parameters

LONG_AGO = 1_000_000
"""Cycles of uninterrupted filling that stand for "the WSP has not acted yet"."""


def start(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
) -> None:
    """Set the state of zeroed records for a stop from ``p.initial_speed``."""
    car.speed = p.initial_speed
    start_supply(car, p)
    start_command(car, p)
    for j in range(2):
        bogies[j].speed = p.initial_speed
        bogies[j].ahead = p.half_pivot_distance * (1.0 - 2.0 * j)
    for i in range(4):
        side = 1.0 - 2.0 * (i % 2)
        bogie = bogies[i // 2]
        copy_wheelset_parameters(wheelsets[i], wheelset_parameters[i])
        _start_wheelset(wheelsets[i], p)
        start_disc(wheelsets[i], p)
        start_dynamic_brake(wheelsets[i], i, p)
        set_creep_curve(wheelsets[i], p)
        start_module(wheelsets[i], select(i < p.calipers, 1.0, 0.0), p)
        wheelsets[i].ahead = side * p.half_wheelbase
        wheelsets[i].behind = p.half_pivot_distance - bogie.ahead + p.half_wheelbase * (1.0 - side)
    car.axle_load = 2.0 * p.static_wheel_load
    begin(car, wheelsets, p)
    car.initial_energy = stored_energy(car, bogies, wheelsets, p)
    car.initial_air = stored_air(car, wheelsets)
    car.initial_air_energy = stored_air_energy(car, wheelsets, p)


def start_supply(car: Car, p: Parameters) -> None:
    """Fill the reservoir; the brake line is empty."""
    car.reservoir_pressure = p.reservoir_pressure
    car.line_pressure = p.atmospheric_pressure
    car.line_temperature = p.air_temperature
    car.line_coldness = p.air_coldness
    car.reservoir_mass = p.reservoir_pressure * p.reservoir_volume / (p.gas_constant * p.air_temperature)
    car.line_mass = p.atmospheric_pressure * p.line_volume / (p.gas_constant * p.air_temperature)


def _start_wheelset(wheelset: Wheelset, p: Parameters) -> None:
    wheelset.speed = p.initial_speed
    wheelset.rotation = p.initial_speed / wheelset.wheel_radius
    wheelset.wheel_load = p.static_wheel_load
    wheelset.speed_valid = 1
    wheelset.held_speed = p.initial_speed


def start_module(wheelset: Wheelset, has_caliper: float, p: Parameters) -> None:
    """Let the valve of a module fill from the empty brake line into its empty tank."""
    volume = select(has_caliper > 0.0, p.caliper_tank_volume, p.tank_volume)
    wheelset.has_caliper = has_caliper
    wheelset.filling_cycles = LONG_AGO
    wheelset.fill_opening = 1.0
    wheelset.pressure = p.atmospheric_pressure
    wheelset.air_temperature = p.air_temperature
    wheelset.air_coldness = p.air_coldness
    wheelset.air_mass = p.atmospheric_pressure * volume / (p.gas_constant * p.air_temperature)
    wheelset.modelled_tank_pressure = p.atmospheric_pressure
    wheelset.modelled_tank_air = p.atmospheric_pressure
    wheelset.modelled_pressure = p.atmospheric_pressure
    wheelset.modelled_volume = 1.0 - p.modelled_swept_share
    wheelset.modelled_air = p.atmospheric_pressure * wheelset.modelled_volume
    wheelset.pressure_ratio = 1.0

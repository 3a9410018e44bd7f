"""Faults once per controller cycle: which are active, and what they make of sensors, commands and valves.

Scalar code, only in stops that have faults. Where two faults act on one number, the later one of the list
acts on what the earlier one has left. Air leaks from tanks and from the brake line in every step, in code
for SIMD lanes, only in stops with such a fault.
"""

from collections.abc import Sequence

from uictest.core.physics import FILL, air_changes, clamp, coldness, enthalpy, fma, maximum, minimum, uniform
from uictest.rig.model.cycle import CHANNELS, is_active, noise_words
from uictest.rig.model.parameters import Parameters, WheelsetParameters
from uictest.rig.model.pneumatics import module_volume, orifice
from uictest.rig.model.state import Car, Wheelset

_FAULT = 4
"""Noise channel of a wheelset for the random errors of a faulty speed sensor."""


def update_faults(
    car: Car, wheelsets: Sequence[Wheelset], p: Parameters, wheelset_parameters: Sequence[WheelsetParameters]
) -> None:
    """Decide which faults are active in the coming cycle, and set what they change in the wheelsets."""
    _decide_activity(car, p)
    car.line_leak = 0.0
    car.dynamic_failed = 0.0
    car.track_brake_failed = 0.0
    for i in range(4):
        _make_sound(wheelsets[i], wheelset_parameters[i])
    for k in range(p.fault_count):
        if is_active(car, k):
            car.line_leak += p.fault_line_leak[k]
            car.dynamic_failed = maximum(car.dynamic_failed, p.fault_dynamic_failed[k])
            car.track_brake_failed = maximum(car.track_brake_failed, p.fault_track_failed[k])
            _act(wheelsets[int(p.fault_wheelset[k])], p, k)


def _decide_activity(car: Car, p: Parameters) -> None:
    """Begin and end faults; what has begun goes on although the train should gain speed again."""
    for k in range(p.fault_count):
        if (
            car.time >= p.fault_begin_time[k]
            and car.speed <= p.fault_begin_speed[k]
            and car.position >= p.fault_begin_distance[k]
        ):
            car.begun_faults |= 1 << k
        if (
            car.time >= p.fault_end_time[k]
            and car.speed <= p.fault_end_speed[k]
            and car.position >= p.fault_end_distance[k]
        ):
            car.ended_faults |= car.begun_faults & (1 << k)
    car.active_faults = car.begun_faults & ~car.ended_faults


def _make_sound(wheelset: Wheelset, parameters: WheelsetParameters) -> None:
    wheelset.speed_valid = 1
    wheelset.speed_held = 0.0
    wheelset.pressure_held = 0.0
    wheelset.speed_sensor_faulty = 0.0
    wheelset.tank_leak = 0.0
    wheelset.sander_blocked = 0.0
    wheelset.missing_teeth = parameters.missing_teeth
    wheelset.valve_travel_per_step = parameters.valve_travel_per_step


def _act(wheelset: Wheelset, p: Parameters, k: int) -> None:
    """Set what one active fault changes for the whole cycle."""
    if p.fault_speed_valid[k] == 0.0:
        wheelset.speed_valid = 0
    wheelset.speed_held = maximum(wheelset.speed_held, p.fault_speed_held[k])
    wheelset.pressure_held = maximum(wheelset.pressure_held, p.fault_pressure_held[k])
    wheelset.speed_sensor_faulty = maximum(wheelset.speed_sensor_faulty, p.fault_of_speed_sensor[k])
    wheelset.faulty = maximum(wheelset.faulty, p.fault_of_wheelset[k])
    wheelset.report_required = maximum(wheelset.report_required, p.fault_report_required[k])
    wheelset.tank_leak += p.fault_tank_leak[k]
    wheelset.sander_blocked = maximum(wheelset.sander_blocked, p.fault_sander_blocked[k])
    wheelset.missing_teeth += p.fault_lost_teeth[k]
    wheelset.valve_travel_per_step = minimum(wheelset.valve_travel_per_step, p.fault_travel_per_step[k])


def falsify_readings(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Put in the place of the sensors' readings what faulty ones show to the controller."""
    for i in range(4):
        _hold_readings(wheelsets[i])
    for k in range(p.fault_count):
        if is_active(car, k):
            _falsify(wheelsets[int(p.fault_wheelset[k])], car, p, k)


def _hold_readings(wheelset: Wheelset) -> None:
    """Keep the last readings for sensors that get stuck, and let stuck ones show them."""
    if wheelset.speed_held > 0.0:
        wheelset.measured_speed = wheelset.held_speed
    wheelset.held_speed = wheelset.measured_speed
    if wheelset.pressure_held == 0.0:
        wheelset.shown_pressure = wheelset.pressure_reading
        wheelset.held_pressure = wheelset.pressure_reading
    else:
        wheelset.shown_pressure = wheelset.held_pressure


def _falsify(wheelset: Wheelset, car: Car, p: Parameters, k: int) -> None:
    speed = fma(wheelset.measured_speed, p.fault_speed_factor[k], p.fault_speed_offset[k])
    if p.fault_speed_jump[k] > 0.0 or p.fault_drop_out[k] > 0.0:
        number = int(p.fault_wheelset[k])
        word_0, word_1 = noise_words(p, car.cycle, number * CHANNELS + _FAULT)
        speed += p.fault_speed_jump[k] * (2.0 * uniform((word_0, word_1)) - 1.0)
        if uniform((word_1, word_0)) < p.fault_drop_out[k]:
            speed = 0.0
    wheelset.measured_speed = maximum(speed, 0.0)
    pressure = fma(wheelset.shown_pressure, p.fault_pressure_factor[k], p.fault_pressure_offset[k])
    wheelset.shown_pressure = maximum(pressure, 0.0)


def silence_controller(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """While no command reaches the valves, let them keep the last one, and fill once that lasts too long.

    So it is with the reduction of the dynamic brake, which then comes back, and with requests for sand and
    the track brake.
    """
    silent = False
    released = False
    for k in range(p.fault_count):
        if is_active(car, k) and p.fault_silent[k] > 0.0:
            silent = True
            released = released or car.silent_cycles >= p.fault_release_cycles[k]
    car.silent_cycles = car.silent_cycles + 1 if silent else 0
    for i in range(4):
        wheelset = wheelsets[i]
        if silent:
            wheelset.valve_command = FILL if released else wheelset.kept_command
            wheelset.dynamic_reduction = 0.0 if released else wheelset.kept_reduction
            wheelset.sand_request = 0 if released else wheelset.kept_request
        else:
            wheelset.kept_command = wheelset.valve_command
            wheelset.kept_reduction = wheelset.dynamic_reduction
            wheelset.kept_request = wheelset.sand_request
    if silent:
        car.track_brake_request = 0 if released else car.kept_track_request
    else:
        car.kept_track_request = car.track_brake_request


def limit_valves(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Keep the openings that the valves are commanded to within what faulty magnets and valves can do."""
    for k in range(p.fault_count):
        if is_active(car, k):
            wheelset = wheelsets[int(p.fault_wheelset[k])]
            least, most = p.fault_fill_at_least[k], p.fault_fill_at_most[k]
            wheelset.fill_before = clamp(wheelset.fill_before, least, most)
            wheelset.fill_after = clamp(wheelset.fill_after, least, most)
            least, most = p.fault_vent_at_least[k], p.fault_vent_at_most[k]
            wheelset.vent_before = clamp(wheelset.vent_before, least, most)
            wheelset.vent_after = clamp(wheelset.vent_after, least, most)


def let_air_leak(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Let air leak for one step, before the valves and walls do their part in it."""
    for i in range(4):
        _leak_from_tank(wheelsets[i], p)
    _leak_from_line(car, p)


def _leak_from_tank(wheelset: Wheelset, p: Parameters) -> None:
    leaked = p.step * orifice(
        wheelset.pressure,
        p.atmospheric_pressure,
        wheelset.air_coldness,
        p.air_coldness,
        wheelset.tank_leak,
        p,
    )
    lost = enthalpy(leaked, wheelset.air_temperature, p.air_temperature, p.heat_capacity_pressure)
    wheelset.air_mass -= leaked
    warming, rise = _changes(
        wheelset.pressure,
        wheelset.air_temperature,
        wheelset.air_mass,
        leaked,
        lost,
        module_volume(wheelset, p),
        p,
    )
    wheelset.air_temperature += warming
    wheelset.pressure += rise
    wheelset.air_coldness = coldness(wheelset.air_temperature)
    wheelset.leaked_air += leaked
    wheelset.leaked_enthalpy += lost


def _leak_from_line(car: Car, p: Parameters) -> None:
    leaked = p.step * orifice(
        car.line_pressure, p.atmospheric_pressure, car.line_coldness, p.air_coldness, car.line_leak, p
    )
    lost = enthalpy(leaked, car.line_temperature, p.air_temperature, p.heat_capacity_pressure)
    car.line_mass -= leaked
    warming, rise = _changes(
        car.line_pressure, car.line_temperature, car.line_mass, leaked, lost, p.line_volume, p
    )
    car.line_temperature += warming
    car.line_pressure += rise
    car.line_coldness = coldness(car.line_temperature)
    car.leaked_air += leaked
    car.leaked_enthalpy += lost


def _changes(
    pressure: float, temperature: float, mass: float, leaked: float, lost: float, volume: float, p: Parameters
) -> tuple[float, float]:
    """Changes of temperature and pressure of air in a fixed volume that loses so many kg and J."""
    return air_changes(
        pressure,
        temperature,
        mass,
        -leaked,
        -lost,
        volume,
        0.0,
        p.air_temperature,
        0.0,
        p.gas_constant,
        p.heat_capacity_volume,
    )

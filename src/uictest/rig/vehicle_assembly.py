"""Parameters of vehicle, wheelsets and sensors that follow from several values, or from one and a formula.

Each function sets fields of a record from what its arguments name (:mod:`uictest.rig.assembly`).
"""

import math
from typing import Any, Final

from uictest.core.physics import stiffnesses
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.scenario import Caliper, Sensors, Vehicle
from uictest.rig.model.parameters import Parameters, WheelsetParameters

_WHEELS: Final = 8.0


def set_frames(p: Parameters, vehicle: Vehicle, time_step: float) -> None:
    """Set what a force or moment on the car body, a bogie or a wheelset changes within one step."""
    body, bogie, step = vehicle.loaded_body, vehicle.bogie, float(time_step)
    p.body_mass, p.body_inertia = body.mass, body.pitch_inertia
    p.body_mass_rate = body.mass / step
    p.body_mass_response = step / body.mass
    p.body_pitch_response = step / body.pitch_inertia
    p.bogie_mass_response = step / bogie.mass
    p.bogie_pitch_response = step / bogie.pitch_inertia
    p.mass_response = step / vehicle.wheelset.mass


def set_weight(p: Parameters, vehicle: Vehicle) -> None:
    """Set the mass of the car and what its wheels carry at rest."""
    p.gravity = STANDARD_GRAVITY
    p.total_mass = vehicle.total_mass
    p.static_wheel_load = vehicle.total_mass * STANDARD_GRAVITY / _WHEELS


def set_train_sensors(p: Parameters, sensors: Sensors, cycle_time: float) -> None:
    """Set the second source of speed and the accelerometer; zeros without them."""
    speed, acceleration, cycle = sensors.train_speed, sensors.acceleration, float(cycle_time)
    p.has_train_speed, p.has_accelerometer = float(speed is not None), float(acceleration is not None)
    p.train_speed_period = p.train_speed_delay = 0
    p.train_speed_noise = p.train_speed_gain_error = p.accelerometer_noise = p.accelerometer_offset = 0.0
    if speed is not None:
        p.train_speed_period = max(round(speed.period / cycle), 1)
        p.train_speed_delay = min(round(speed.delay / cycle), 3 * p.train_speed_period)
        p.train_speed_noise, p.train_speed_gain_error = speed.noise, speed.gain_error
    if acceleration is not None:
        p.accelerometer_noise, p.accelerometer_offset = acceleration.noise, acceleration.offset


def set_pole_wheels(p: Parameters, vehicle: Vehicle, sensors: Sensors) -> None:
    """Set whether a speed sensor does more than to give the momentary speed."""

    def differs(sensor: Any) -> bool:
        method = sensors.speed.method if sensor.method is None else sensor.method
        eccentricity = sensors.speed.eccentricity if sensor.eccentricity is None else sensor.eccentricity
        return method != "momentary" or float(eccentricity) > 0.0

    p.uses_pole_wheels = float(any(differs(sensor.sensors.speed) for sensor in vehicle.wheelsets.values()))


VEHICLE: Final = (set_frames, set_weight, set_train_sensors, set_pole_wheels)
"""What sets parameters of the vehicle and its sensors."""
VALUES_OF_WHEELSET: Final = {
    **{name: name for name in ("wheel_radius", "configured_radius", "rotational_inertia")},
    "load_friction": "caliper.load_friction",
    **{name: f"wsp_valve.{name}" for name in ("travel_time", "switching_delay")},
    **{name: f"sensors.speed.{name}" for name in ("teeth", "method")},
}
"""Argument of a function that sets parameters of a wheelset -> value of that wheelset, as
:func:`uictest.plans.scenario.wheelset_value` names it."""


def set_slip(
    p: WheelsetParameters,
    wheel_radius: float,
    rotational_inertia: float,
    wheelset_mass: float,
    time_step: float,
) -> None:
    """Set what a moment and a creep force change within one step, and the inverses."""
    step = float(time_step)
    p.inertia_response = step / rotational_inertia
    p.inertia_stiffness = 1.0 / p.inertia_response
    p.slip_response = step / wheelset_mass + wheel_radius * wheel_radius * p.inertia_response
    p.slip_stiffness = 1.0 / p.slip_response


def set_own_caliper(p: WheelsetParameters, load_friction: float, caliper: Caliper, time_step: float) -> None:
    """Set what :func:`uictest.core.physics.stiffnesses` gives for the caliper of a wheelset."""
    _, _, p.squeezing_stiffness, p.releasing_stiffness, _, *compliances = stiffnesses(
        float(caliper.spring_rate),
        float(load_friction),
        float(caliper.viscous_friction),
        float(caliper.contact_friction),
        float(caliper.contact_stiffness),
        float(time_step),
    )
    p.squeezing_compliance, p.releasing_compliance = compliances


def set_valve(
    p: WheelsetParameters, travel_time: float, switching_delay: float, time_step: float, cycle_time: float
) -> None:
    """Set travel and delay of the valve, the delay in whole controller cycles and the steps that remain."""
    step = float(time_step)
    p.valve_travel_per_step = min(step / max(travel_time, step), 1.0)
    p.valve_delay_cycles, p.valve_delay_steps = divmod(
        round(switching_delay / step), round(float(cycle_time) / step)
    )


def set_speed_sensor(p: WheelsetParameters, configured_radius: float, teeth: float, method: str) -> None:
    """Set how the speed sensor counts."""
    p.tooth_pitch = 2.0 * math.pi * configured_radius / teeth
    p.counts_teeth = float(method == "whole-teeth")


OF_WHEELSET: Final = (set_slip, set_own_caliper, set_valve, set_speed_sensor)
"""What sets parameters of a wheelset."""

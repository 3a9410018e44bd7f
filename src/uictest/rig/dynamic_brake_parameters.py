"""Parameters of the dynamic brake, from its section of the scenario; all zero without one.

The blending knows the regular brake of the car: the pressure at which the pads of the squeezing caliper touch
the disc, the force at the rims of four regular wheelsets above it, and the width of the caliper's loop.
"""

import math

from uictest.core.physics import torque
from uictest.plans.scenario import WHEELSET_NUMBERS, DynamicBrake, Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.parameters import Parameters


def _set_motors(p: Parameters, scenario: Scenario) -> None:
    motors = scenario.brake.dynamic
    p.has_dynamic_brake = float(motors is not None)
    p.motor_forces = p.motor_powers = [0.0] * len(WHEELSET_NUMBERS)
    p.fade_end = p.fade_rate = p.motor_response = 0.0
    if motors is not None:
        p.motor_forces = _shares(float(motors.force), motors)
        p.motor_powers = _shares(float(motors.power), motors)
        begin, p.fade_end = map(float, motors.fade_out)
        p.fade_rate = 1.0 / (begin - p.fade_end)
        cycles = float(motors.response_time) / float(scenario.controller.cycle_time)
        p.motor_response = -math.expm1(-1.0 / cycles)


def _shares(whole: float, motors: DynamicBrake) -> list[float]:
    """Return what each wheelset has of what the motored ones share."""
    share = whole / len(motors.wheelsets)
    return [share if number in motors.wheelsets else 0.0 for number in WHEELSET_NUMBERS]


def _set_friction_brake(p: Parameters, scenario: Scenario) -> None:
    p.zero_force_pressure = p.force_per_pressure = p.coulomb_width = p.load_width = 0.0
    if scenario.brake.dynamic is not None:
        caliper, disc = scenario.rig.caliper, scenario.brake.system.disc
        clamping = caliper.lever_ratio * caliper.piston_area / (1.0 + caliper.load_friction)
        braking = torque(
            clamping,
            disc.calipers_per_wheelset,
            disc.pads_per_caliper,
            disc.pad_friction,
            disc.mean_radius,
        )
        p.zero_force_pressure = caliper.closing_force / caliper.piston_area
        p.force_per_pressure = len(WHEELSET_NUMBERS) * braking / scenario.vehicle.wheelset.radius
        p.coulomb_width = 2.0 * caliper.coulomb_friction / caliper.piston_area
        p.load_width = 2.0 * caliper.load_friction / (1.0 + caliper.load_friction)


DYNAMIC_BRAKE: tuple[Assignment, ...] = (
    Assignment(_set_motors, ("brake.dynamic", "controller.cycle_time")),
    Assignment(
        _set_friction_brake,
        ("brake.dynamic", "rig.caliper", "brake.system.disc", "vehicle.wheelset"),
    ),
)
"""What sets the parameters of the dynamic brake."""

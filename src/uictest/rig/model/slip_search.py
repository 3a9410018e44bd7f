"""Search for the slip speeds at the end of a step, which the creep forces are implicit in.

Nothing of a search outlasts its step: it is passed from function to function, not kept in the records.
"""

from collections.abc import Sequence
from typing import NamedTuple

from uictest.core.physics import (
    SLOWEST_CREEP,
    contact_stiffness,
    fma,
    force_and_slope,
    friction_limit,
    lowest_slip,
    maximum,
    minimum,
    refined_slip,
    select,
    stress_gradient,
    turning_direction,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Wheelset

HIGHEST_LOAD = 2.5
"""Share of the reference load beyond which the contact ellipse stays as it is; chosen."""


class Slip(NamedTuple):
    """Slip speed of one wheelset, as far as it has been found: sizes, m/s."""

    direction: float  # 1, or -1 where the rail drives the wheelset
    free: float  # without a creep force
    lowest: float
    highest: float
    estimate: float


Limit = tuple[float, float]
Gradient = tuple[float, float, float, float, float, float]
OfWheelsets = tuple[float, float, float, float]
Slips = tuple[Slip, Slip, Slip, Slip]


def find_slips(
    wheelsets: Sequence[Wheelset], thrusts: OfWheelsets, p: Parameters
) -> tuple[Slips, OfWheelsets]:
    """Take two Newton steps for each wheelset; the first finds the force at the last slip speed.

    Args:
        wheelsets: four wheelset records.
        thrusts: force of suspension and gradient on each, N.
        p: parameter record.

    Returns:
        The slip speeds, and the creep forces at the last slip speeds, N.
    """
    slips = (
        bracket_slip(wheelsets[0], thrusts[0], p),
        bracket_slip(wheelsets[1], thrusts[1], p),
        bracket_slip(wheelsets[2], thrusts[2], p),
        bracket_slip(wheelsets[3], thrusts[3], p),
    )
    better, sliding_forces = _refine_all(slips, wheelsets, p)
    found, _ = _refine_all(better, wheelsets, p)
    return found, sliding_forces


def _refine_all(slips: Slips, wheelsets: Sequence[Wheelset], p: Parameters) -> tuple[Slips, OfWheelsets]:
    """Refine the four side by side: the processor then works on all four chains at once."""
    limit_0 = _friction_limit(slips[0], wheelsets[0], p)
    limit_1 = _friction_limit(slips[1], wheelsets[1], p)
    limit_2 = _friction_limit(slips[2], wheelsets[2], p)
    limit_3 = _friction_limit(slips[3], wheelsets[3], p)
    gradient_0 = _stress_gradient(slips[0], limit_0, wheelsets[0], p)
    gradient_1 = _stress_gradient(slips[1], limit_1, wheelsets[1], p)
    gradient_2 = _stress_gradient(slips[2], limit_2, wheelsets[2], p)
    gradient_3 = _stress_gradient(slips[3], limit_3, wheelsets[3], p)
    slip_0, force_0 = _refine(slips[0], limit_0, gradient_0, wheelsets[0], p)
    slip_1, force_1 = _refine(slips[1], limit_1, gradient_1, wheelsets[1], p)
    slip_2, force_2 = _refine(slips[2], limit_2, gradient_2, wheelsets[2], p)
    slip_3, force_3 = _refine(slips[3], limit_3, gradient_3, wheelsets[3], p)
    return (slip_0, slip_1, slip_2, slip_3), (force_0, force_1, force_2, force_3)


def bracket_slip(wheelset: Wheelset, thrust: float, p: Parameters) -> Slip:
    """Bracket the slip speed at the end of the step and begin from the last one.

    The full brake torque is assumed to act on a turning wheelset; a lock is detected at the end of the step.
    """
    load_ratio = minimum(wheelset.wheel_load * p.load_scale, HIGHEST_LOAD)
    wheelset.contact_stiffness = contact_stiffness(p.creep_stiffness, load_ratio)
    slip = fma(-wheelset.wheel_radius, wheelset.rotation, wheelset.speed)
    braking = turning_direction(wheelset.rotation, wheelset.speed) * wheelset.torque
    pushed = fma(p.mass_response, thrust, slip)
    free_slip = fma(wheelset.inertia_response * wheelset.wheel_radius, braking, pushed)
    direction = select(free_slip < 0.0, -1.0, 1.0)
    free = direction * free_slip
    lowest = lowest_slip(free, wheelset.slip_response, wheelset.wheel_load, wheelset.friction)
    return Slip(direction, free, lowest, free, maximum(direction * slip, 0.0))


def _friction_limit(slip: Slip, wheelset: Wheelset, p: Parameters) -> Limit:
    """Friction limit at the estimated slip speed, and how it changes."""
    return friction_limit(
        slip.estimate,
        wheelset.wheel_load,
        wheelset.friction,
        wheelset.friction_ratio,
        wheelset.friction_decay,
    )


def _stress_gradient(slip: Slip, limit: Limit, wheelset: Wheelset, p: Parameters) -> Gradient:
    """Gradient of the tangential stress at the estimated slip speed."""
    return stress_gradient(
        slip.estimate,
        maximum(abs(wheelset.speed), SLOWEST_CREEP),
        limit[0],
        wheelset.contact_stiffness,
        wheelset.reduction_adhesion,
        wheelset.reduction_slip,
    )


def _refine(
    slip: Slip, limit: Limit, gradient: Gradient, wheelset: Wheelset, p: Parameters
) -> tuple[Slip, float]:
    """Take one Newton step; return the better slip speed and the creep force of both wheels before it, N."""
    force, slope = force_and_slope(
        gradient,
        maximum(abs(wheelset.speed), SLOWEST_CREEP),
        limit[0],
        limit[1],
        wheelset.contact_stiffness,
        wheelset.reduction_adhesion,
        wheelset.reduction_slip,
    )
    estimate, lowest, highest = refined_slip(
        slip.estimate, slip.lowest, slip.highest, slip.free, wheelset.slip_response, force, slope
    )
    return Slip(slip.direction, slip.free, lowest, highest, estimate), 2.0 * force

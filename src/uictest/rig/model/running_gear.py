"""Motion of the vehicle: wheelsets on the rail, bogies and car body coupled by their suspensions.

All forces come from the state at the beginning of the step; speeds are advanced first and positions
with the new speeds (semi-implicit Euler), which keeps the energy of the suspensions bounded without
damping of its own. Only the creep force is implicit, since only it is stiff: a search finds the slip speed at
the end of the step. Nothing of a search outlasts its step, so it is passed from function to function.
"""

from collections.abc import Sequence
from typing import NamedTuple

from uictest.core.physics import (
    SLOWEST_CREEP,
    contact_stiffness,
    fma,
    force_and_slope,
    friction_limit,
    gradient_force,
    locked_force,
    longitudinal,
    lowest_slip,
    maximum,
    minimum,
    refined_slip,
    running_resistance,
    select,
    stress_gradient,
    suspension_force,
    torque,
    turning_direction,
    vertical,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Bogie, Car, Frame, Wheelset

LOWEST_LOAD = 0.2
"""Smallest load of a wheel, share of the reference load: far less than braking leaves; chosen."""
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
_HELD_WITHIN = 1.001
"""A speed above that share of the one to be held is not held; chosen."""
_NOT_YET, _HOLDS, _HELD = 0, 1, 2


def clear_forces(frame: Frame) -> None:
    """Clear the forces on the car body before they are summed anew."""
    frame.longitudinal_force = 0.0
    frame.vertical_force = 0.0
    frame.moment = 0.0


def begin_forces(bogie: Bogie) -> None:
    """Begin the sums on a bogie with the force of its magnets: zero but for :mod:`.track_brake`."""
    bogie.longitudinal_force = bogie.magnet_force
    bogie.vertical_force = 0.0
    bogie.moment = bogie.magnet_moment


def couple_body(car: Car, bogie: Bogie, p: Parameters) -> None:
    """Add the forces of the secondary suspension and the traction link between a bogie and the body."""
    _couple_longitudinally(
        car,
        bogie,
        p.secondary_longitudinal_stiffness,
        p.secondary_longitudinal_damping,
        p.secondary_height,
        p,
    )
    _couple_longitudinally(car, bogie, p.link_stiffness, p.link_damping, p.link_height, p)
    rise = vertical(car.height, car.pitch, bogie.ahead) - bogie.height
    rate = vertical(car.vertical_speed, car.pitch_rate, bogie.ahead) - bogie.vertical_speed
    lift = suspension_force(p.secondary_vertical_stiffness, p.secondary_vertical_damping, rise, rate)
    bogie.vertical_force += lift
    car.vertical_force -= lift
    car.moment -= bogie.ahead * lift
    car.damper_loss += p.step * p.secondary_vertical_damping * rate * rate


def _couple_longitudinally(
    car: Car, bogie: Bogie, stiffness: float, damping: float, height: float, p: Parameters
) -> None:
    above_body = height - p.body_height
    above_bogie = height - p.bogie_height
    shift = longitudinal(car.position, car.pitch, above_body) - longitudinal(
        bogie.position, bogie.pitch, above_bogie
    )
    rate = longitudinal(car.speed, car.pitch_rate, above_body) - longitudinal(
        bogie.speed, bogie.pitch_rate, above_bogie
    )
    pull = suspension_force(stiffness, damping, shift, rate)
    bogie.longitudinal_force += pull
    bogie.moment -= above_bogie * pull
    car.longitudinal_force -= pull
    car.moment += above_body * pull
    car.damper_loss += p.step * damping * rate * rate


def couple_wheelset(wheelset: Wheelset, bogie: Bogie, car: Car, p: Parameters) -> float:
    """Add the forces of a primary suspension to the bogie; find the wheelset's load and torque.

    Returns:
        Thrust of suspension and gradient on the wheelset, N.
    """
    above = wheelset.wheel_radius - p.bogie_height
    shift = wheelset.position - longitudinal(bogie.position, bogie.pitch, above)
    rate = wheelset.speed - longitudinal(bogie.speed, bogie.pitch_rate, above)
    pull = suspension_force(p.primary_longitudinal_stiffness, p.primary_longitudinal_damping, shift, rate)
    rise = vertical(bogie.height, bogie.pitch, wheelset.ahead)
    rise_rate = vertical(bogie.vertical_speed, bogie.pitch_rate, wheelset.ahead)
    lift = suspension_force(p.primary_vertical_stiffness, p.primary_vertical_damping, rise, rise_rate)
    bogie.longitudinal_force += pull
    bogie.vertical_force -= lift
    bogie.moment -= fma(above, pull, wheelset.ahead * lift)
    car.damper_loss += p.step * fma(
        p.primary_longitudinal_damping * rate, rate, p.primary_vertical_damping * rise_rate * rise_rate
    )
    wheelset.wheel_load = maximum(fma(-0.5, lift, p.static_wheel_load), LOWEST_LOAD * p.reference_load)
    friction_torque = wheelset.brake_force * torque(
        wheelset.clamping_force,
        p.calipers_per_wheelset,
        p.pads_per_caliper,
        wheelset.pad_friction,
        p.disc_radius,
    )
    wheelset.torque = friction_torque + wheelset.dynamic_torque
    return -pull - gradient_force(p.wheelset_mass, p.gradient, p.gravity)


def step_wheelset(
    wheelset: Wheelset, bogie: Bogie, thrust: float, sliding_force: float, slip: Slip, p: Parameters
) -> tuple[float, float, float]:
    """Advance speed and rotation under rail and brake; the brake torque reacts on the bogie.

    Where the full brake torque would turn the wheelset against its sense of rotation the brake holds it: it
    stands, and its brake carries just the torque of the rail. It stays so until the rail's torque exceeds the
    brake's, without chatter. A locked wheelset slides as fast as it did, so that its force is the one found
    at the last slip speed. The dynamic brake has faded out long before, so that friction alone holds.

    Args:
        wheelset: its record.
        bogie: that of its bogie.
        thrust: :func:`couple_wheelset`, N.
        sliding_force: creep force at the last slip speed, N.
        slip: at the end of the step, for a wheelset that turns.
        p: parameter record.

    Returns:
        The torques that friction and motor transmit, against a positive rotation, N m, and the mean rotation
        of the discs over the step against the bogie at its beginning, rad/s.
    """
    speed = wheelset.speed
    rotation = wheelset.rotation
    direction = turning_direction(rotation, speed)
    slip_change = slip.free - slip.estimate
    turning_creep = slip.direction * slip_change * wheelset.slip_stiffness
    moment = fma(wheelset.wheel_radius, turning_creep, -direction * wheelset.torque)
    turned = fma(wheelset.inertia_response, moment, rotation)
    locked = turned * direction <= 0.0
    free_speed = fma(p.mass_response, thrust, speed)
    sliding_creep = locked_force(speed, free_speed, sliding_force, p.mass_response)
    holding = fma(wheelset.wheel_radius, sliding_creep, rotation * wheelset.inertia_stiffness)
    creep = select(locked, sliding_creep, turning_creep)
    braking = select(locked, holding, direction * wheelset.torque)
    wheelset.creep_force = creep
    wheelset.speed = fma(-p.mass_response, creep, free_speed)
    wheelset.rotation = select(locked, 0.0, turned)
    wheelset.position += p.step * wheelset.speed
    turning = 0.5 * (rotation + wheelset.rotation)
    wheelset.angle += p.step * turning
    wheelset.contact_loss += (
        p.step * creep * (0.5 * (speed + wheelset.speed) - wheelset.wheel_radius * turning)
    )
    bogie.moment -= braking
    dynamic = direction * wheelset.dynamic_torque
    return braking - dynamic, dynamic, turning + bogie.pitch_rate


def step_frame(
    frame: Frame, mass: float, mass_response: float, pitch_response: float, resistance: float, p: Parameters
) -> None:
    """Advance the three motions of a bogie or the car body under the forces summed on it."""
    drag = resistance + gradient_force(mass, p.gradient, p.gravity)
    frame.speed += mass_response * (frame.longitudinal_force - drag)
    frame.vertical_speed += mass_response * frame.vertical_force
    frame.pitch_change = pitch_response * frame.moment
    frame.pitch_rate += frame.pitch_change
    frame.position += p.step * frame.speed
    frame.height += p.step * frame.vertical_speed
    frame.pitch += p.step * frame.pitch_rate


def account_for_brakes(
    wheelset: Wheelset, bogie: Bogie, torques: tuple[float, float, float], p: Parameters
) -> None:
    """Add the work of pads and motor, which pitch with the bogie: known once its pitch rate is advanced.

    The torques in N m and the rotation in rad/s are those of :func:`step_wheelset`.
    """
    friction, dynamic, rotation = torques
    rubbing = fma(0.5, bogie.pitch_change, rotation)
    wheelset.brake_heat += p.step * friction * rubbing
    wheelset.dynamic_energy += p.step * dynamic * rubbing


def step_body(car: Car, p: Parameters) -> None:
    """Advance the car body and note the instant and place of standstill, or of the speed at which it ends."""
    speed = car.speed
    position = car.position
    drag = running_resistance(speed, p.resistance_constant, p.resistance_linear, p.resistance_quadratic)
    traction = traction_force(car, drag + gradient_force(p.body_mass, p.gradient, p.gravity), p)
    car.longitudinal_force += traction + car.coupler_force
    car.moment += car.coupler_moment
    step_frame(car, p.body_mass, p.body_mass_response, p.body_pitch_response, drag, p)
    car.traction_work += p.step * traction * 0.5 * (speed + car.speed)
    car.resistance_loss += p.step * drag * 0.5 * (speed + car.speed)
    stops = (1.0 - car.stopped) * select(car.speed <= p.end_speed, 1.0, 0.0) > 0.0
    share = (speed - p.end_speed) / select(stops, speed - car.speed, 1.0)
    car.stop_time = select(stops, car.vehicle_steps * p.step + share * p.step, car.stop_time)
    car.stop_position = select(
        stops, position + 0.5 * share * p.step * (speed + p.end_speed), car.stop_position
    )
    car.stopped = select(stops, 1.0, car.stopped)


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


def hold_speed(car: Car, p: Parameters) -> None:
    """Begin or end drag braking with the coming cycle; scalar code.

    From a speed on, traction holds the train while its brake acts, for a time. It is what an ideal locomotive
    gives: at every step just the force that keeps the car body at the speed. It pulls and never brakes.
    """
    if car.drag_phase == _NOT_YET and car.speed <= p.drag_speed:
        car.drag_phase = _HOLDS
        car.drag_ends = car.time + p.drag_duration
    if car.drag_phase == _HOLDS and car.time > car.drag_ends - 0.5 * p.step:
        car.drag_phase = _HELD
    car.holds_speed = 1.0 if car.drag_phase == _HOLDS else 0.0
    if car.holds_speed > 0.0 and car.speed <= p.drag_speed * _HELD_WITHIN:
        car.held_time += p.cycle_time


def traction_force(car: Car, drag: float, p: Parameters) -> float:
    """Return the force on the car body, N, against ``drag`` N and the forces summed on it."""
    missing = (p.drag_speed - car.speed) * p.body_mass_rate
    return car.holds_speed * maximum(missing + drag - car.longitudinal_force, 0.0)

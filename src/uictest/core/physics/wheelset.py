"""One wheelset on the rail: slip speed, rotation and lock, implicit in the creep force.

    m v' = P - F(w),      J omega' = r F(w) - T,      w = v - r omega

with wheelset mass m, rotational inertia J, radius r, force P of the vehicle on the wheelset, creep
force F of the rail against the motion and brake torque T. Near standstill the creep force reacts within
microseconds, so that the slip speed at the end of the step is the unknown: with g = dt (1/m + r^2/J),

    w1 + g F(w1) = w0 + dt (P/m + r T/J)
"""

from uictest.core.physics.arithmetic import clamp, fma, maximum, minimum, select

SLOWEST_CREEP = 0.01
"""Running speed in m/s below which the creepage is taken at this speed: s = w / v stays finite."""


def lowest_slip(free_slip: float, softness: float, wheel_load: float, initial_friction: float) -> float:
    """Least slip speed in m/s that the end of the step can have, for sizes of the slip speed.

    The creep force opposes the slip and is at most the friction limit, so that the slip speed w1 that solves
    ``w1 + softness F(w1) = free_slip`` lies between this and ``free_slip``.

    Args:
        free_slip: slip speed that would be reached without a creep force, m/s, >= 0.
        softness: change of slip speed per force of the wheelset, dt (1/m + r^2/J), m/(s N).
        wheel_load: load of one wheel, N.
        initial_friction: mu0.
    """
    return maximum(fma(-softness * 2.0 * wheel_load, initial_friction, free_slip), 0.0)


def refined_slip(
    slip: float, low: float, high: float, free_slip: float, softness: float, force: float, slope: float
) -> tuple[float, float, float]:
    """One Newton step towards the slip speed that solves ``w1 + softness F(w1) = free_slip``.

    The step never leaves the bracket, which it narrows; where the creep force falls so steeply that
    Newton would turn back, the bracket is halved instead. All of them are sizes, m/s.

    Args:
        slip: present estimate; may lie outside of the bracket.
        low: lower end of the bracket.
        high: upper end of the bracket.
        free_slip: slip speed that would be reached without a creep force.
        softness: change of slip speed per force of the wheelset, m/(s N).
        force: creep force of one wheel at ``slip``, N.
        slope: its slope, N s/m.

    Returns:
        The better estimate and the bracket around the root.
    """
    residual = fma(softness * 2.0, force, slip - free_slip)
    rise = fma(softness * 2.0, slope, 1.0)
    high = select(residual > 0.0, minimum(slip, high), high)
    low = select(residual > 0.0, low, maximum(slip, low))
    newton = slip - residual / select(rise > 0.0, rise, 1.0)
    return clamp(select(rise > 0.0, newton, 0.5 * (low + high)), low, high), low, high


def locked_force(speed: float, free_speed: float, sliding_force: float, softness: float) -> float:
    """Force of the rail on a locked wheelset in N, against its motion.

    A locked wheelset slides at its running speed v. Its friction is taken in proportion to the new speed,
    v1 = free_speed - softness F v1 / v, so that it can stop the motion but not turn it.

    Args:
        speed: running speed before the step, m/s.
        free_speed: running speed that would be reached without friction, m/s.
        sliding_force: size F of the friction force while sliding at ``speed``, N.
        softness: dt / m, s/kg.
    """
    running = maximum(abs(speed), SLOWEST_CREEP)
    return sliding_force * free_speed / fma(softness, sliding_force, running)


def turning_direction(rotation: float, speed: float) -> float:
    """Sense in which the wheelset turns, or would begin to turn when it stands: 1 forward, -1 backward."""
    rolling = select(speed < 0.0, -1.0, 1.0)
    return select(rotation > 0.0, 1.0, select(rotation < 0.0, -1.0, rolling))

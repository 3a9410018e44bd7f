"""Planar vehicle on its wheelsets: seventeen degrees of freedom, and the resistance to its motion.

Car body and two bogies move longitudinally, vertically and in pitch; four wheelsets move longitudinally
and turn on a rigid rail. Coordinates are displacements from running at rest on level track: x forward,
z up, pitch positive nose up. The point at distance L ahead of and height h above a centre of gravity
moves by (x - h pitch, z + L pitch).

One wheelset on the rail is implicit in the creep force, with slip speed w and rotation omega:

    m v' = P - F(w),      J omega' = r F(w) - T,      w = v - r omega

with wheelset mass m, rotational inertia J, radius r, force P of the vehicle on the wheelset, creep
force F of the rail against the motion and brake torque T. Near standstill the creep force reacts within
microseconds, so that the slip speed at the end of the step is the unknown: with g = dt (1/m + r^2/J),

    w1 + g F(w1) = w0 + dt (P/m + r T/J)
"""

from uictest.core.physics.arithmetic import clamp, fma, maximum, minimum, select


def longitudinal(position: float, pitch: float, height: float) -> float:
    """Longitudinal displacement (or speed) of a point ``height`` m above the centre of gravity."""
    return fma(-height, pitch, position)


def vertical(position: float, pitch: float, ahead: float) -> float:
    """Vertical displacement (or speed) of a point ``ahead`` m in front of the centre of gravity."""
    return fma(ahead, pitch, position)


def suspension_force(stiffness: float, damping: float, deflection: float, rate: float) -> float:
    """Force of a spring and a damper side by side, N, in the direction of the deflection."""
    return fma(stiffness, deflection, damping * rate)


def spring_energy(stiffness: float, deflection: float) -> float:
    """Energy stored in a spring, J."""
    return 0.5 * stiffness * deflection * deflection


def kinetic_energy(inertia: float, speed: float) -> float:
    """Kinetic energy of a mass (or a moment of inertia) at a speed (or a rate), J."""
    return 0.5 * inertia * speed * speed


def running_resistance(speed: float, constant: float, linear: float, quadratic: float) -> float:
    """Force against the motion, N: R = a + b v + c v^2 (Davis), none at standstill; ``speed`` in m/s."""
    size = abs(speed)
    direction = select(speed > 0.0, 1.0, select(speed < 0.0, -1.0, 0.0))
    return direction * fma(fma(quadratic, size, linear), size, constant)


def gradient_force(mass: float, gradient: float, gravity: float) -> float:
    """Force in N on ``mass`` kg against the motion uphill; gradient as height over length, small."""
    return mass * gravity * gradient


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

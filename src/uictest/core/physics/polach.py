"""Creep force between wheel and rail, and the largest that a contact can transmit.

O. Polach, Creep forces in simulations of traction vehicles running on adhesion limit, Wear 258 (2005)
992-1000.

    mu  = mu0 [(1 - A) exp(-B w) + A]
    eps = (1/4) G pi a b c11 s / (Q mu),      s = w / v
    F   = (2 Q mu / pi) [kA eps / (1 + (kA eps)^2) + arctan(kS eps)],      kS <= kA <= 1

with slip speed w, running speed v, creepage s, load Q of one wheel, contact semi-axes a and b (which
grow with the cube root of the load, Hertz), shear modulus G and Kalker's coefficient c11. Longitudinal
creep only.

With x = B w this law reads

    F / (Q mu0) = (2 / pi) g [kA eps / (1 + (kA eps)^2) + arctan(kS eps)]
    g = (1 - A) exp(-x) + A,      eps = x / (g u^2),      u^2 = B v Q mu0 / C

with the tangential contact stiffness C. For one rail condition, A, kA and kS, the maximum over x is a
function of u alone. It falls from 1 at u = 0 towards A; up to the u1 at which it is about there it is a
polynomial of u / u1, which :mod:`uictest.rig.highest_creep` fits.
"""

from uictest.core.physics.arithmetic import (
    arctan_within_octant,
    exp,
    fma,
    minimum,
    octant,
    power_two_thirds,
    sqrt,
)

_TWO_OVER_PI = 0.6366197723675814


def contact_stiffness(reference_stiffness: float, load_ratio: float) -> float:
    """Tangential contact stiffness (1/4) G pi a b c11 in N; a b grows with the load to the power 2/3.

    Args:
        reference_stiffness: at the reference load, N.
        load_ratio: wheel load over the reference load.
    """
    return reference_stiffness * power_two_thirds(load_ratio)


def friction_limit(
    slip_speed: float, wheel_load: float, initial_friction: float, ratio: float, decay: float
) -> tuple[float, float]:
    """Friction limit Q mu of one wheel in N and its slope with respect to slip speed in N s/m.

    Args:
        slip_speed: size of the slip speed w, m/s, >= 0.
        wheel_load: load Q of one wheel, N.
        initial_friction: mu0.
        ratio: A, friction at infinite slip over mu0.
        decay: B, s/m.
    """
    weight = wheel_load * initial_friction
    fading = weight * ((1.0 - ratio) * exp(-decay * slip_speed))
    return fma(weight, ratio, fading), -decay * fading


def stress_gradient(
    slip_speed: float,
    speed: float,
    limit: float,
    stiffness: float,
    reduction_adhesion: float,
    reduction_slip: float,
) -> tuple[float, float, float, float, float, float]:
    """Return the gradient eps of the tangential stress as a quotient, and what a force needs of it.

    Args:
        slip_speed: size of the slip speed w, m/s, >= 0.
        speed: size of the running speed v, m/s, > 0.
        limit: friction limit Q mu of one wheel, N.
        stiffness: :func:`contact_stiffness`, N.
        reduction_adhesion: kA, reduction in the area of adhesion.
        reduction_slip: kS, reduction in the area of slip.

    Returns:
        Numerator n and denominator d of eps; 1 / (d^2 + (kA n)^2) and 1 / (d^2 + (kS n)^2); arctan(kS eps) as
        an angle and the tangent of a small rest. One division serves all of them.
    """
    numerator, denominator = stiffness * slip_speed, speed * limit
    adhering, slipping = reduction_adhesion * numerator, reduction_slip * numerator
    denominator_squared = denominator * denominator
    adhesion_part = fma(adhering, adhering, denominator_squared)
    slip_part = fma(slipping, slipping, denominator_squared)
    angle, opposite, adjacent = octant(slipping, denominator)
    parts = adhesion_part * slip_part
    inverse = 1.0 / (parts * adjacent)
    inverse_parts = inverse * adjacent
    return (
        numerator,
        denominator,
        slip_part * inverse_parts,
        adhesion_part * inverse_parts,
        angle,
        opposite * parts * inverse,
    )


def force_and_slope(
    gradient: tuple[float, float, float, float, float, float],
    speed: float,
    limit: float,
    limit_slope: float,
    stiffness: float,
    reduction_adhesion: float,
    reduction_slip: float,
) -> tuple[float, float]:
    """Return the creep force of one wheel in N and its slope with respect to slip speed in N s/m.

    Args:
        gradient: :func:`stress_gradient`.
        limit_slope: change of the friction limit with the slip speed, N s/m.
        speed, limit, stiffness, reduction_adhesion, reduction_slip: as there.
    """
    numerator, denominator, per_adhesion, per_slip, angle, tangent = gradient
    adhering = reduction_adhesion * numerator
    shape = fma(adhering * denominator, per_adhesion, angle + arctan_within_octant(tangent))
    bend = fma(-adhering, adhering, denominator * denominator) * per_adhesion * per_adhesion
    shape_slope = fma(reduction_adhesion, bend, reduction_slip * per_slip)
    quotient_slope = fma(stiffness, denominator, -numerator * speed * limit_slope)
    force = _TWO_OVER_PI * limit * shape
    return force, _TWO_OVER_PI * fma(limit_slope, shape, limit * shape_slope * quotient_slope)


def creep_force(
    slip_speed: float,
    speed: float,
    wheel_load: float,
    stiffness: float,
    initial_friction: float,
    ratio: float,
    decay: float,
    reduction_adhesion: float,
    reduction_slip: float,
) -> tuple[float, float]:
    """Return the creep force of one wheel in N and its slope with respect to slip speed in N s/m.

    Args:
        slip_speed: size of the slip speed w, m/s, >= 0.
        speed: size of the running speed v, m/s, > 0.
        wheel_load: load Q of one wheel, N, > 0.
        stiffness: :func:`contact_stiffness`, N.
        initial_friction: mu0.
        ratio: A, friction at infinite slip over mu0.
        decay: B, s/m.
        reduction_adhesion: kA, reduction in the area of adhesion.
        reduction_slip: kS, reduction in the area of slip.
    """
    limit, limit_slope = friction_limit(slip_speed, wheel_load, initial_friction, ratio, decay)
    law = (stiffness, reduction_adhesion, reduction_slip)
    gradient = stress_gradient(slip_speed, speed, limit, *law)
    return force_and_slope(gradient, speed, limit, limit_slope, *law)


FITTED_TERMS = 8
"""Coefficients of the polynomial."""


def highest_creep_force(
    speed: float,
    wheel_load: float,
    initial_friction: float,
    stiffness: float,
    scale: float,
    c0: float,
    c1: float,
    c2: float,
    c3: float,
    c4: float,
    c5: float,
    c6: float,
    c7: float,
) -> float:
    """Return the largest creep force of one wheel over all slip speeds, N.

    Args:
        speed: running speed v, m/s, >= 0.
        wheel_load: load Q of one wheel, N.
        initial_friction: mu0.
        stiffness: :func:`~uictest.core.physics.polach.contact_stiffness`, N.
        scale: B / u1^2, s/m.
        c0, c1, c2, c3, c4, c5, c6, c7: coefficients of the polynomial of u / u1.
    """
    weight = wheel_load * initial_friction
    t = minimum(sqrt(scale * speed * weight / stiffness), 1.0)
    t2 = t * t
    t4 = t2 * t2
    low = fma(t2, fma(c3, t, c2), fma(c1, t, c0))
    high = fma(t2, fma(c7, t, c6), fma(c5, t, c4))
    return weight * fma(t4, high, low)

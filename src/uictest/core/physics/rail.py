"""Wheel and rail: creep force, friction along the track and in time, cleaning by sliding.

**Creep force** and the largest that a contact can transmit: O. Polach, Creep forces in simulations of
traction vehicles running on adhesion limit, Wear 258 (2005) 992-1000.

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
polynomial of u / u1, which :mod:`uictest.rig.rail_assembly` fits.

**Cleaning.** Sliding wheels clean the rail, and what follows runs on what they have cleaned. A wheelset that
loses W joules per metre of track to its contacts cleans the rail under it,

    dc/dx = (1 - exp(-W / Wc) - c) / reach

and leaves C = 1 - (1 - c) (1 - k C'), where C' is the share that the wheelset before it has left at the same
place and k the part of it that lasts until then. Friction rises with the cleaned share from mu0 towards the
friction mur of a clean rail: mu0 + C (mur - mu0). It never falls.

That sliding cleans the rail to the benefit of the wheelsets behind is published (Allotta, Meli, Ridolfi and
Rindi, Tribology International 69 (2014) 128; Voltr and Lata, Vehicle System Dynamics 53 (2015) 605). This
form of the equations is ours.
"""

from collections.abc import Sequence
from typing import Final

from uictest.core.physics.arithmetic import (
    arctan_within_octant,
    exp,
    fma,
    maximum,
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
        stiffness: :func:`~uictest.core.physics.rail.contact_stiffness`, N.
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


MOST_SAND_POINTS: Final = 16
"""Points that a table of what sand does may have."""


def interpolated(at: float, points: Sequence[float], values: Sequence[float], count: int) -> float:
    """Value at ``at`` of a piecewise linear law through ``count`` points, constant beyond its ends.

    Two points at the same place make a step; the value there is that of the later point.
    """
    if at < points[0]:
        return values[0]
    i = 0
    while i + 1 < count and points[i + 1] <= at:
        i += 1
    if i + 1 >= count:
        return values[count - 1]
    share = (at - points[i]) / (points[i + 1] - points[i])
    return values[i] + share * (values[i + 1] - values[i])


def log_normal_factor(deviation: float, log_spread: float) -> float:
    """Factor of mean 1 whose logarithm has a normal distribution.

    Args:
        deviation: normal, of mean 0 and variance 1.
        log_spread: standard deviation of the logarithm.
    """
    logarithm = log_spread * deviation - 0.5 * log_spread * log_spread
    return exp(minimum(logarithm, 0.0)) / exp(minimum(-logarithm, 0.0))


def cleaned_share(share: float, loss: float, distance: float, response: float, decay: float) -> float:
    """Share of the rail that a wheelset itself has cleaned, c, at the end of a stretch of track.

    The loss per metre is constant over the stretch, for which the equation is solved exactly.

    Args:
        share: c at its beginning.
        loss: energy turned into heat in the contacts of both wheels on the way, J.
        distance: length of the stretch, > 0, m.
        response: 1 / Wc, m/J.
        decay: 1 / reach, 1/m.
    """
    settled = 1.0 - exp(-response * maximum(loss / distance, 0.0))
    return settled + (share - settled) * exp(-decay * distance)


def share_left_behind(share: float, arrived: float, carry_over: float) -> float:
    """Cleaned share of the rail under and behind a wheelset, C.

    Args:
        share: c, what the wheelset itself has cleaned.
        arrived: C', what the wheelset before it has left at this place.
        carry_over: k.
    """
    return 1.0 - (1.0 - share) * (1.0 - carry_over * arrived)


def cleaned_friction(friction: float, share: float, recovered_friction: float) -> float:
    """Initial friction coefficient of a rail of which a share is clean; a better rail keeps its own.

    Args:
        friction: mu0 of the rail as it is found.
        share: C.
        recovered_friction: mur.
    """
    return friction + share * maximum(recovered_friction - friction, 0.0)

"""Creep force between wheel and rail.

O. Polach, Creep forces in simulations of traction vehicles running on adhesion limit, Wear 258 (2005)
992-1000.

    mu  = mu0 [(1 - A) exp(-B w) + A]
    eps = (1/4) G pi a b c11 s / (Q mu),      s = w / v
    F   = (2 Q mu / pi) [kA eps / (1 + (kA eps)^2) + arctan(kS eps)],      kS <= kA <= 1

with slip speed w, running speed v, creepage s, load Q of one wheel, contact semi-axes a and b (which
grow with the cube root of the load, Hertz), shear modulus G and Kalker's coefficient c11. Longitudinal
creep only.
"""

from uictest.physics.arithmetic import arctan, exp, power_two_thirds

_TWO_OVER_PI = 0.6366197723675814


def contact_stiffness(reference_stiffness: float, load_ratio: float) -> float:
    """Tangential contact stiffness (1/4) G pi a b c11 in N; a b grows with the load to the power 2/3.

    Args:
        reference_stiffness: at the reference load, N.
        load_ratio: wheel load over the reference load.
    """
    return reference_stiffness * power_two_thirds(load_ratio)


def friction(slip_speed: float, initial_friction: float, ratio: float, decay: float) -> float:
    """Friction coefficient mu at a slip speed >= 0 in m/s: mu0 [(1 - A) exp(-B w) + A]."""
    return initial_friction * ((1.0 - ratio) * exp(-decay * slip_speed) + ratio)


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
    """Creep force of one wheel in N and its slope with respect to slip speed in N s/m.

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
    fading = (1.0 - ratio) * exp(-decay * slip_speed)
    limit = wheel_load * initial_friction * (fading + ratio)
    limit_slope = -decay * wheel_load * initial_friction * fading
    inverse = 1.0 / (speed * limit)
    gradient = stiffness * inverse
    eps = gradient * slip_speed
    adhering = reduction_adhesion * eps
    slipping = reduction_slip * eps
    adhesion_part = 1.0 + adhering * adhering
    slip_part = 1.0 + slipping * slipping
    both = 1.0 / (adhesion_part * slip_part)
    flatness = slip_part * both
    shape = adhering * flatness + arctan(slipping)
    bend = (2.0 - adhesion_part) * flatness * flatness
    shape_slope = reduction_adhesion * bend + reduction_slip * adhesion_part * both
    eps_slope = gradient - eps * limit_slope * speed * inverse
    force = _TWO_OVER_PI * limit * shape
    return force, _TWO_OVER_PI * (limit_slope * shape + limit * shape_slope * eps_slope)

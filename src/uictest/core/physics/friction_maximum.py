"""Largest force that a contact can transmit: the maximum of Polach's creep curve over the slip speed.

With x = B w the law of :mod:`uictest.core.physics.polach` reads

    F / (Q mu0) = (2 / pi) g [kA eps / (1 + (kA eps)^2) + arctan(kS eps)]
    g = (1 - A) exp(-x) + A,      eps = x / (g u^2),      u^2 = B v Q mu0 / C

with the tangential contact stiffness C. For one rail condition, A, kA and kS, the maximum over x is a
function of u alone. It falls from 1 at u = 0 towards A; up to the u1 at which it is about there it is a
polynomial of u / u1, which :mod:`uictest.rig.highest_creep` fits.
"""

from uictest.core.physics.arithmetic import fma, minimum, sqrt

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

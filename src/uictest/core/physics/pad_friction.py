"""Friction of the pads: mu_pad = mu_ref h(v_d) q(F) g(T).

v_d is the speed of the friction surface at the mean radius, F the clamping force of one pad, T the
temperature of the friction surface. Each factor is a table (:func:`uictest.core.physics.interpolated`) or,
for speed and force, a quotient of two straight lines.
"""

MOST_PAD_POINTS = 16
"""Points that a table may have."""


def quotient_factor(x: float, numerator: float, denominator: float, scale: float) -> float:
    """Factor (x + a) / (x + b) times a scale that makes it 1 at the reference point.

    The form of Karwatzki's law for composite brake blocks, there over the force of a block and the speed of
    the train, which is that of the tread that the block rubs on.

    Args:
        x: speed of the friction surface, m/s, or clamping force of one pad, N.
        numerator: a, in the unit of ``x``.
        denominator: b, likewise.
        scale: (x0 + b) / (x0 + a) of the reference point x0.
    """
    return scale * (x + numerator) / (x + denominator)


def quotient_scale(reference: float, numerator: float, denominator: float) -> float:
    """Scale with which :func:`quotient_factor` is 1 at ``reference``."""
    return (reference + denominator) / (reference + numerator)

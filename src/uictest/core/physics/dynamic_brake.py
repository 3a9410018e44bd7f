"""The dynamic brake: motors that work as generators, and how the friction brake makes up for the rest.

A motor holds its force up to the speed from which its power limits it, F = min(F_max, P / v), and fades out
over a range of low speeds, in which a machine without excitation of its own gives ever less.

Blended, the dynamic brake comes first: of the force that a command asks for, the friction brake is asked for
the share that the dynamic brake does not give. The clamping force begins only at a pressure p0 > 0, from
which on it is linear, so that the pressure p of a command becomes p - share (p - p0): with a share of 1 the
pads just touch the discs.

A caliper that is relieved keeps its force until the pressure has fallen through its loop. Its friction being
Fc + alpha N at the piston of area A, the force of a pressure p0 + q on the squeezing line is that of
p0 + q - w(q) on the releasing line, with w(q) = 2 Fc / A + 2 alpha / (1 + alpha) q.
"""

from uictest.core.physics.arithmetic import clamp, maximum, minimum
from uictest.core.physics.caliper import force_after

_SLOWEST = 1e-3
"""m/s below which a force from power is not computed: the brake has faded out far above it."""


def dynamic_force(speed: float, force: float, power: float, fade_end: float, fade_rate: float) -> float:
    """Largest force of the dynamic brake at the rims, N.

    Args:
        speed: of the rims, >= 0, m/s.
        force: largest at any speed, N.
        power: largest, W.
        fade_end: speed at and below which it gives nothing, m/s.
        fade_rate: share that it gives more for every m/s above, s/m.
    """
    faded = clamp((speed - fade_end) * fade_rate, 0.0, 1.0)
    return faded * minimum(force, power / maximum(speed, _SLOWEST))


def friction_pressure(pressure: float, share: float, zero_force_pressure: float) -> float:
    """Gauge pressure that the friction brake is asked for where the dynamic one gives a share, Pa.

    Args:
        pressure: of the command, Pa.
        share: of the force at that pressure that the dynamic brake gives.
        zero_force_pressure: p0, up to which there is no force, Pa.
    """
    return pressure - share * maximum(pressure - zero_force_pressure, 0.0)


def loop_width(excess: float, coulomb_width: float, load_width: float) -> float:
    """Width w(q), Pa, at q = ``excess``, Pa, from 2 Fc / A, Pa, and 2 alpha / (1 + alpha)."""
    return coulomb_width + load_width * excess


def held_excess(held: float, excess: float, coulomb_width: float, load_width: float) -> float:
    """Pressure above p0 that would give a squeezing caliper its present clamping force, Pa.

    ``held`` is what was returned before, ``excess`` the pressure above p0, negative below; widths as before.
    """
    releasing = (excess + coulomb_width) / (1.0 - load_width)
    return force_after(held, maximum(excess, 0.0), maximum(releasing, 0.0))

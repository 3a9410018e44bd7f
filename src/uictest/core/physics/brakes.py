"""Brake forces: disc brake, dynamic brake and magnetic track brake.

**Disc brake** of one wheelset: torque, friction of the pads, temperature of the discs. The friction of the
pads is mu_pad = mu_ref h(v_d) q(F) g(T). v_d is the speed of the friction surface at the mean radius, F the
clamping force of one pad, T the temperature of the friction surface. Each factor is a table
(:func:`uictest.core.physics.interpolated`) or, for speed and force, a quotient of two straight lines.

The ring of a disc under one pad face is a slab of thickness L, conductivity k, density rho and specific heat
c, heated on its friction surface by a flux q, insulated at its back (or heated alike from both sides, then L
is half of it). All of a face's heat is spread over the whole ring. With the diffusivity alpha = k / (rho c)
the surface is

    T_surface = T + sum over n of a_n,    da_n/dt = 2 q / (rho c L) - n^2 pi^2 alpha / L^2 a_n

(H. S. Carslaw and J. C. Jaeger, Conduction of Heat in Solids, 2nd ed., 1959, section 3.8) and the bulk
temperature T follows from the heat that the ring holds; it loses heat h A (T - T_ambient) to the air. That
loss is taken from the bulk: its gradient within the ring, h L / k of the excess, is left out. Of the modes
:data:`MODES` are followed, the faster ones are where the present flux would hold them: that holds the highest
temperature of a stop of t_s within 1 % while L is at most 5.5 sqrt(alpha t_s), 0.1 m for 28 s on cast iron.

**Dynamic brake**: motors that work as generators, and how the friction brake makes up for the rest.

A motor holds its force up to the speed from which its power limits it, F = min(F_max, P / v), and fades out
over a range of low speeds, in which a machine without excitation of its own gives ever less.

Blended, the dynamic brake comes first: of the force that a command asks for, the friction brake is asked for
the share that the dynamic brake does not give. The clamping force begins only at a pressure p0 > 0, from
which on it is linear, so that the pressure p of a command becomes p - share (p - p0): with a share of 1 the
pads just touch the discs.

A caliper that is relieved keeps its force until the pressure has fallen through its loop. Its friction being
Fc + alpha N at the piston of area A, the force of a pressure p0 + q on the squeezing line is that of
p0 + q - w(q) on the releasing line, with w(q) = 2 Fc / A + 2 alpha / (1 + alpha) q.

**Track brake**: magnets that the rail attracts and that rub on it. The attraction acts between magnet and
rail, so that it loads no wheel, and the force needs no adhesion of the wheels. Friction falls with speed, mu
= mu_inf (v + a)/(v + b) with a >= b. The default, 0.095 (v + 9.26 km/h)/(v + 4.63 km/h), is a formula for
steel that slides on dry rails, taken for magnets by analogy (chosen): its published constants for wet rails
give more friction, so that the reading is doubtful.
"""

import math

from uictest.core.physics.arithmetic import clamp, exp, fma, maximum, minimum
from uictest.core.physics.caliper import force_after


def torque(
    clamping_force: float, calipers: float, pads: float, pad_friction: float, mean_radius: float
) -> float:
    """Largest brake torque on the wheelset, N m: calipers x pads x mu_pad x F x r_mean.

    Args:
        clamping_force: force of one pad on the disc, N.
        calipers: calipers per wheelset.
        pads: friction faces per caliper.
        pad_friction: friction coefficient between pad and disc.
        mean_radius: mean friction radius, m.
    """
    return calipers * pads * pad_friction * clamping_force * mean_radius


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


MODES = 6
"""Modes that are followed; for a ring of cast iron of 20 mm the next relaxes in 0.06 s."""
_SLOW = 1e-2
"""Below it the series of 1 - exp(-x) is used; its first term left out is below 2e-13 of it."""


def relaxed_share(x: float) -> float:
    """Share 1 - exp(-x), x >= 0, of the way to equilibrium that is covered in x time constants."""
    if x < _SLOW:
        return x * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0))))
    return 1.0 - exp(-x)


def bulk_change(
    temperature: float, surroundings: float, heat: float, warming: float, relaxation: float
) -> float:
    """Change of the bulk temperature, K, within an interval of constant heating: the exact solution.

    Args:
        temperature: of the bulk at the beginning, K.
        surroundings: temperature of the air, K.
        heat: that the pads give off in the interval, J.
        warming: (1 - exp(-x)) / (x C), K/J, with x = h A dt / C.
        relaxation: 1 - exp(-x).
    """
    return fma(warming, heat, -relaxation * (temperature - surroundings))


def cooled_heat(
    temperature: float, surroundings: float, heat: float, capacity: float, warming: float, relaxation: float
) -> float:
    """Heat that the air takes from the ring, h A (T - T_ambient), in an interval of constant heating, J.

    Args:
        capacity: C, J/K.
        temperature, surroundings, heat, warming, relaxation: :func:`bulk_change`.
    """
    return fma(1.0 - capacity * warming, heat, capacity * relaxation * (temperature - surroundings))


def mode_after(mode: float, heat: float, rise: float, relaxation: float) -> float:
    """Mode of the temperature profile, K, at the end of an interval of constant flux: the exact solution.

    Args:
        mode: at the beginning, K.
        heat: that the pads give off in the interval, J.
        rise: what the mode gains from it, K/J; its steady value per heat times ``relaxation``.
        relaxation: 1 - exp(-n^2 pi^2 alpha dt / L^2).
    """
    return mode + fma(rise, heat, -relaxation * mode)


def mode_relaxation(number: int, fourier: float) -> float:
    """Share of the n-th mode that dies away in an interval with Fourier number alpha dt / L^2."""
    return relaxed_share(number * number * math.pi * math.pi * fourier)


def held_mode(number: int) -> float:
    """The n-th mode under a steady flux, in q L / k: 2 / (n^2 pi^2)."""
    return 2.0 / (number * number * math.pi * math.pi)


def held_rest() -> float:
    """All modes beyond the :data:`MODES` that are followed under a steady flux, in q L / k.

    The sum of all is 1/3.
    """
    return 1.0 / 3.0 - math.fsum(held_mode(number) for number in range(1, MODES + 1))


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


def track_brake_force(
    speed: float, attraction: float, friction: float, numerator: float, denominator: float, slowest: float
) -> float:
    """Force on magnets that slide over the rail, along their motion, N: negative while they move forward.

    Below the slowest speed it falls to zero with speed, so that it never moves what stands.

    Args:
        speed: of the magnets, m/s.
        attraction: of all of them together, N.
        friction: coefficient at high speed.
        numerator: a, m/s.
        denominator: b, m/s.
        slowest: speed from which it is whole, m/s.
    """
    sliding = abs(speed)
    coefficient = friction * (sliding + numerator) / (sliding + denominator)
    return 0.0 - attraction * coefficient * (speed / maximum(sliding, slowest))

"""From the pressure of a tank to the clamping force of a caliper, as identified or as modelled.

Four-phase hysteresis, the clamping force that a tank's pressure would give, Lee and Kang (2015), equations
(4)-(7): the force is linear in pressure, with a slope and an intercept of its own when the brake cylinder
squeezes or releases in ordinary braking (BC) and when the WSP acts. Between the squeezing and the releasing
line the force stays where it is while the pressure turns: a play operator bounded by two lines.

Cylinder dynamics, a third-order discrete transfer function from tank pressure to cylinder pressure,
equation (8):

    y[n] = (b0 + b1 z^-1 + b2 z^-2 + b3 z^-3) / (1 + a1 z^-1 + a2 z^-2 + a3 z^-3) u[n]

in transposed direct form II: three memories, each the part of later outputs that is already known.

The modelled caliper has a piston, a return spring, friction, a clearance and a lever. The piston has no
inertia: at its loads it settles within a few milliseconds. Its equilibrium while it moves is

    p A - F0 - k y - N - sgn(y') (Fc + alpha N) - c y' - cN z' = 0,     N = kc z,  z = max(0, y - y0)

with gauge pressure p, piston area A, spring preload F0 and rate k, contact force N at the piston once
the stroke y has closed the clearance y0, Coulomb friction Fc, friction alpha proportional to the load
(seals, pins, lever), a viscous part c of the piston and a viscous part cN of lever, pins and pads, which
move under load while the pads touch: the quicker the pressure changes, the wider is the loop. While
friction can carry the difference nothing moves.
"""

from uictest.core.physics.arithmetic import clamp, fma, maximum, minimum


def phase_share(share: float, wsp_acting: float, largest_change: float) -> float:
    """Share of the WSP lines (0 BC, 1 WSP) after one step towards ``wsp_acting``.

    The lines are exchanged over a finite time, so that the force does not jump when the phase changes.
    """
    return share + clamp(wsp_acting - share, -largest_change, largest_change)


def line(pressure: float, slope: float, intercept: float) -> float:
    """Clamping force on one line, N, never negative; gauge pressure in Pa, slope in N/Pa, intercept in N."""
    return maximum(fma(slope, pressure, intercept), 0.0)


def force_after(force: float, squeezing: float, releasing: float) -> float:
    """Clamping force in N after the pressure changed: kept, unless one of the two lines moves it."""
    return clamp(force, squeezing, maximum(squeezing, releasing))


def output(pressure: float, memory_1: float, b0: float) -> float:
    """Cylinder pressure y[n] for tank pressure u[n], in the unit of the pressures."""
    return fma(b0, pressure, memory_1)


def memory(pressure: float, filtered: float, b: float, a: float, following: float) -> float:
    """Memory i after the step: b_i u[n] - a_i y[n] + memory i+1 before it."""
    return fma(b, pressure, fma(-a, filtered, following))


def stiffnesses(
    spring_rate: float,
    load_friction: float,
    viscous_friction: float,
    contact_friction: float,
    contact_stiffness: float,
    step: float,
) -> tuple[float, float, float, float, float, float, float]:
    """Numbers of :func:`stroke_after` that do not change while the rig runs: divided only once.

    Args:
        spring_rate: k, N/m.
        load_friction: alpha.
        viscous_friction: c, N s/m.
        contact_friction: cN, N s/m.
        contact_stiffness: kc, N/m.
        step: time step, s.

    Returns:
        c / step and cN / step; the stiffness of squeezing and of releasing contact, kc (1 +- alpha) +
        cN / step, N/m; the compliance of the free piston and those of squeezing and releasing contact, m/N.
    """
    damping = viscous_friction / step
    contact_damping = contact_friction / step
    free = spring_rate + damping
    squeezing = fma(contact_stiffness, 1.0 + load_friction, contact_damping)
    releasing = fma(contact_stiffness, 1.0 - load_friction, contact_damping)
    return (
        damping,
        contact_damping,
        squeezing,
        releasing,
        1.0 / free,
        1.0 / (free + squeezing),
        1.0 / (free + releasing),
    )


def stroke_after(
    stroke: float,
    pressure: float,
    piston_area: float,
    preload: float,
    coulomb_friction: float,
    clearance: float,
    damping: float,
    contact_damping: float,
    squeezing_stiffness: float,
    releasing_stiffness: float,
    free_compliance: float,
    squeezing_compliance: float,
    releasing_compliance: float,
) -> float:
    """Stroke in m after one step under a gauge pressure of ``pressure`` Pa (backward Euler, exact).

    The equation is linear before and after contact, and its residual falls with the stroke: the smaller of
    the two linear solutions is the solution. A piston between the squeezing and the releasing one sticks.

    Args:
        stroke: before the step, m.
        pressure: gauge pressure at the end of the step, Pa.
        piston_area: A, m2.
        preload: F0, N.
        coulomb_friction: Fc, N.
        clearance: y0, m.
        damping, contact_damping, squeezing_stiffness, releasing_stiffness, free_compliance,
            squeezing_compliance, releasing_compliance: :func:`stiffnesses`.
    """
    compressed = maximum(stroke - clearance, 0.0)
    held_back = fma(damping, stroke, fma(contact_damping, compressed, -preload))
    load = fma(pressure, piston_area, held_back)
    squeezing_load = load - coulomb_friction
    releasing_load = load + coulomb_friction
    squeezing = minimum(
        squeezing_load * free_compliance,
        fma(squeezing_stiffness, clearance, squeezing_load) * squeezing_compliance,
    )
    releasing = minimum(
        releasing_load * free_compliance,
        fma(releasing_stiffness, clearance, releasing_load) * releasing_compliance,
    )
    return maximum(clamp(stroke, squeezing, releasing), 0.0)


def clamping_force(stroke: float, clearance: float, contact_stiffness: float, lever_ratio: float) -> float:
    """Force of one pad on the disc, N: lever ratio times contact force at the piston."""
    return lever_ratio * contact_stiffness * maximum(stroke - clearance, 0.0)

"""Four-phase hysteresis: the clamping force that a tank's pressure would give on a caliper.

Lee and Kang (2015), equations (4)-(7): the force is linear in pressure, with a slope and an intercept
of its own when the brake cylinder squeezes or releases in ordinary braking (BC) and when the WSP acts.
Between the squeezing and the releasing line the force stays where it is while the pressure turns: a
play operator bounded by two lines.
"""

from uictest.core.physics.arithmetic import clamp, fma, maximum


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

"""Air of the module with a caliper, computed beside a tank that obeys the same valve commands.

A tank's pressure tells how much air has flowed through its valve; the same valve would have let nearly as
much into the module with the caliper, whose wall warms the air faster and whose piston moves. Both amounts
of air are written as pressures: q = m R Tw / V, the pressure of the mass m at the temperature Tw of the
walls in the volume V of a tank. With k = cp / cv, the temperature T / Tw = p v / q and the volume v over
that of a tank, the energy balance of :mod:`uictest.core.physics.tank` reads

    d(p v) = k (T / Tw)_from dq + W (1 - T / Tw) - (k - 1) p dv,       W = (k - 1) h A Tw dt / V

The tank has v = 1 and a known p, which gives its dq; what flows into the other module differs from it by what
the valve lets through at the other pressure. The volume v grows from 1 - s to 1 while the clearance closes:
the piston moves out at one pressure and back at a lower one.

The form of this compensation is ours, not that of Lee and Kang (2015).
"""

from uictest.core.physics.arithmetic import clamp, fma, select


def amount_gained(
    pressure: float, rise: float, amount: float, exchange: float, heat_capacity_ratio: float
) -> float:
    """Air that has flowed into a tank, dq in Pa, from the rise of its pressure.

    Args:
        pressure: p before, absolute, Pa.
        rise: of the pressure within the step, Pa.
        amount: q before, Pa.
        exchange: W, Pa.
        heat_capacity_ratio: k.
    """
    warmth = pressure / amount
    heated = fma(-exchange, 1.0 - warmth, rise)
    return heated / (heat_capacity_ratio * select(heated < 0.0, warmth, 1.0))


def pressure_volume_after(
    pressure: float,
    volume: float,
    growth: float,
    amount: float,
    gained: float,
    exchange: float,
    heat_capacity_ratio: float,
) -> float:
    """Pressure times volume of the module's air, p v in Pa, after it gained dq = ``gained``.

    Args:
        pressure: p before, absolute, Pa.
        volume: v before.
        growth: dv within the step.
        amount: q before, Pa.
        gained: dq, Pa.
        exchange: W, Pa.
        heat_capacity_ratio: k.
    """
    before = pressure * volume
    warmth = before / amount
    carried = heat_capacity_ratio * gained * select(gained < 0.0, warmth, 1.0)
    work = (heat_capacity_ratio - 1.0) * pressure * growth
    return before + carried + exchange * (1.0 - warmth) - work


def travel_after(
    travel: float, pressure_volume: float, swept: float, closing_pressure: float, opening_pressure: float
) -> float:
    """Travel of the piston, 0 at rest to 1 at the disc: it moves while its pressure would leave the two.

    Args:
        travel: before.
        pressure_volume: p v, Pa.
        swept: s, share of a tank's volume that the piston sweeps, > 0.
        closing_pressure: absolute pressure at which it moves towards the disc, Pa.
        opening_pressure: absolute pressure at which it moves back, below it, Pa.
    """
    at_rest = 1.0 - swept
    out = (pressure_volume / closing_pressure - at_rest) / swept
    back = (pressure_volume / opening_pressure - at_rest) / swept
    return clamp(clamp(travel, out, back), 0.0, 1.0)

"""Air of the brake: flows through orifices, vessels, the main reservoir, the module with a caliper; valves.

A flow follows ISO 6358-1 (:func:`reduced_flow`). A vessel - a tank, a cylinder, a pipe - exchanges air with
others and heat with its wall (:func:`air_changes`):

    d(m cv T)/dt = cp T_in m_in' - cp T_out m_out' - p V' + h A (T_wall - T),     p V = m R T

E. Richer and Y. Hurmuzlu, A high performance pneumatic force actuator system, part I, J. Dyn. Sys. Meas.
Control 122 (2000) 416-425. A flow carries the enthalpy of the side that it comes from. The heat is that of
the temperature at the end of the step (backward Euler), so that any heat conductance h A is stable: none is
adiabatic, a large one isothermal. Both changes are exactly zero at rest.

The air of the module with a caliper is computed beside a tank that obeys the same valve commands. A tank's
pressure tells how much air has flowed through its valve; the same valve would have let nearly as much into
the module with the caliper, whose wall warms the air faster and whose piston moves. Both amounts of air are
written as pressures: q = m R Tw / V, the pressure of the mass m at the temperature Tw of the walls in the
volume V of a tank. With k = cp / cv, the temperature T / Tw = p v / q and the volume v over that of a tank,
the energy balance of a vessel reads

    d(p v) = k (T / Tw)_from dq + W (1 - T / Tw) - (k - 1) p dv,       W = (k - 1) h A Tw dt / V

The tank has v = 1 and a known p, which gives its dq; what flows into the other module differs from it by what
the valve lets through at the other pressure. The volume v grows from 1 - s to 1 while the clearance closes:
the piston moves out at one pressure and back at a lower one. The form of this compensation is ours, not that
of Lee and Kang (2015).

Valves are the relay valve of the brake operating unit (BOU) and the WSP valve. A command reaches the
armatures of the WSP valve a whole delay after the controller issues it. Commands change only with the
controller's cycle, so the past is kept as a shift register of two bits per cycle.
"""

from uictest.core.physics.arithmetic import clamp, fma, maximum, minimum, select, sqrt

REFERENCE_DENSITY = 1.185
"""Density of air in the reference atmosphere (ANR) of ISO 8778, kg/m3: 293.15 K, 1 bar, 65 % humidity."""
REFERENCE_TEMPERATURE = 293.15
"""Temperature of the reference atmosphere (ANR) of ISO 8778, K."""


def orifice_law(critical_ratio: float, laminar_ratio: float) -> tuple[float, float, float]:
    """Numbers of :func:`mass_flow` that do not change while the rig runs: divided only once.

    Args:
        critical_ratio: critical pressure ratio b, 0 < b < laminar_ratio.
        laminar_ratio: pressure ratio l above which the flow is linear, below 1.

    Returns:
        b, 1 / (1 - b) and sqrt(1 - ((l - b) / (1 - b))^2) / (1 - l).
    """
    subsonic_scale = 1.0 / (1.0 - critical_ratio)
    where_linear = (laminar_ratio - critical_ratio) * subsonic_scale
    laminar_slope = sqrt(1.0 - where_linear * where_linear) / (1.0 - laminar_ratio)
    return critical_ratio, subsonic_scale, laminar_slope


def coldness(temperature: float) -> float:
    """Temperature of the reference atmosphere over a temperature in K, T0 / T."""
    return REFERENCE_TEMPERATURE / temperature


def reduced_flow(
    pressure_1: float,
    pressure_2: float,
    coldness_1: float,
    coldness_2: float,
    critical_ratio: float,
    subsonic_scale: float,
    laminar_slope: float,
) -> float:
    """Flow from side 1 to side 2 in Pa, over C rho0 of the orifice; negative when side 2 is the higher.

        sqrt(T0 / T1) p1                                            p2 / p1 <= b   (choked)
        sqrt(T0 / T1) p1 sqrt(1 - ((p2 / p1 - b) / (1 - b))^2)      otherwise

    Above the laminar ratio the flow falls linearly to zero at equal pressures, along the chord of this
    curve: its slope stays finite. The curve bends down everywhere, so that the smaller of curve and chord
    is the flow; and with p1 under the root nothing is divided and one root serves both.

    Args:
        pressure_1: absolute pressure of side 1, Pa.
        pressure_2: absolute pressure of side 2, Pa.
        coldness_1: T0 / T of the air on side 1.
        coldness_2: T0 / T of the air on side 2.
        critical_ratio, subsonic_scale, laminar_slope: :func:`orifice_law`.
    """
    backwards = pressure_2 > pressure_1
    upstream = maximum(pressure_1, pressure_2)
    downstream = minimum(pressure_1, pressure_2)
    subsonic = maximum(fma(-critical_ratio, upstream, downstream), 0.0) * subsonic_scale
    curve_squared = maximum(fma(-subsonic, subsonic, upstream * upstream), 0.0)
    chord = (upstream - downstream) * laminar_slope
    size = sqrt(select(backwards, coldness_2, coldness_1) * minimum(curve_squared, chord * chord))
    return select(backwards, -size, size)


def mass_flow(
    pressure_1: float,
    pressure_2: float,
    coldness_1: float,
    coldness_2: float,
    conductance: float,
    critical_ratio: float,
    subsonic_scale: float,
    laminar_slope: float,
) -> float:
    """Mass flow from side 1 to side 2 in kg/s: :func:`reduced_flow` times the sonic conductance C times rho0.

    Args:
        pressure_1, pressure_2, coldness_1, coldness_2: :func:`reduced_flow`.
        conductance: sonic conductance C, m3/(s Pa).
        critical_ratio, subsonic_scale, laminar_slope: :func:`orifice_law`.
    """
    return (
        conductance
        * REFERENCE_DENSITY
        * reduced_flow(
            pressure_1, pressure_2, coldness_1, coldness_2, critical_ratio, subsonic_scale, laminar_slope
        )
    )


def enthalpy(flow: float, temperature_1: float, temperature_2: float, heat_capacity: float) -> float:
    """Enthalpy in J that ``flow`` kg carry from side 1 to side 2; from side 2 where ``flow`` is negative.

    Args:
        flow: air that flows in the step, kg.
        temperature_1: temperature of the air on side 1, K.
        temperature_2: temperature of the air on side 2, K.
        heat_capacity: cp, J/(kg K).
    """
    return flow * heat_capacity * select(flow < 0.0, temperature_2, temperature_1)


def air_changes(
    pressure: float,
    temperature: float,
    mass: float,
    gained: float,
    energy: float,
    volume: float,
    growth: float,
    wall_temperature: float,
    exchange: float,
    gas_constant: float,
    heat_capacity: float,
) -> tuple[float, float]:
    """Changes of temperature in K and of absolute pressure in Pa within a step.

    With R (m T) the change of p V, both follow from the energy that the air gains:

        dT = (E - p dV - cv T dm + G (T_wall - T)) / (m cv + G)
        dp = (R (m dT + T dm) - p dV) / V

    Args:
        pressure: at the beginning of the step, absolute, Pa.
        temperature: T at the beginning of the step, K.
        mass: m at the end of the step, kg.
        gained: dm, air that flows in, kg.
        energy: E, enthalpy that flows in, J.
        volume: V at the end of the step, m3.
        growth: dV, m3.
        wall_temperature: T_wall, K.
        exchange: G, heat conductance h A times the step, J/K.
        gas_constant: R, J/(kg K).
        heat_capacity: cv, at constant volume, J/(kg K).
    """
    work = pressure * growth
    carried = temperature * gained
    capacity = fma(mass, heat_capacity, exchange)
    inverse = 1.0 / (capacity * volume)
    heated = fma(exchange, wall_temperature - temperature, fma(-heat_capacity, carried, energy - work))
    warming = heated * (volume * inverse)
    rise = fma(gas_constant, fma(mass, warming, carried), -work)
    return warming, rise * (capacity * inverse)


def compressor_running(pressure: float, running: float, cut_in: float, cut_out: float) -> float:
    """Return 1.0 while the compressor runs and 0.0 while it rests.

    It starts below ``cut_in``, stops above ``cut_out`` and keeps its state between them (all Pa, same
    reference).
    """
    return select(pressure < cut_in, 1.0, select(pressure > cut_out, 0.0, running))


def isothermal_pressure(mass: float, stiffness: float) -> float:
    """Absolute pressure in Pa of ``mass`` kg of air: p = m R T / V, with ``stiffness`` R T / V in Pa/kg.

    A vessel of hundreds of litres loses a few per cent of its air in a stop over many seconds: it stays
    at room temperature.
    """
    return mass * stiffness


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


MOST_COMMANDS = 16
"""Brake commands of one stop; chosen: far more than drivers give."""


def demanded_pressure(time: float, start: float, change: float, begins: float, rate: float) -> float:
    """Return the gauge pressure demanded at a time, Pa.

    It is a ramp by ``change`` Pa from ``start`` Pa that begins at ``begins`` s, a dead time after the
    command; ``rate`` is the share of the change that comes per second.

    A UIC distributor and an electropneumatic unit differ here only in their times (UIC 540: 3-5 s in
    positions R and P, 18-30 s in G).
    """
    return start + change * clamp((time - begins) * rate, 0.0, 1.0)


def relay_opening(demanded_pressure: float, pressure: float, gain: float) -> float:
    """Opening of the relay valve: 1 fully open to the reservoir, -1 fully open to atmosphere, 0 lapped.

    Proportional to the pressure still missing, fully open from 1 / ``gain`` Pa on.
    """
    return clamp((demanded_pressure - pressure) * gain, -1.0, 1.0)


FILL = 0
"""Command: brake line connected to the tank (increase the brake force)."""
HOLD = 1
"""Command: tank closed (hold the brake force)."""
VENT = 2
"""Command: tank connected to the atmosphere (reduce the brake force)."""

LONGEST_DELAY_CYCLES = 24
"""Controller cycles that the register remembers, besides the newest command."""
_REGISTER_MASK = (1 << 2 * (LONGEST_DELAY_CYCLES + 2)) - 1


def remember(register: int, command: int) -> int:
    """Shift the newest command into the register."""
    return ((register << 2) | command) & _REGISTER_MASK


def command_before(register: int, cycles: int) -> int:
    """Return the command issued ``cycles`` controller cycles before the newest one."""
    return (register >> (2 * cycles)) & 3


def travel(opening: float, target: float, largest_change: float) -> float:
    """Opening (0 closed, 1 open) after one step towards ``target``, at most ``largest_change`` away."""
    return opening + clamp(target - opening, -largest_change, largest_change)

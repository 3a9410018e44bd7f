"""Air in a vessel that exchanges air with others and heat with its wall: a tank, a cylinder, a pipe.

    d(m cv T)/dt = cp T_in m_in' - cp T_out m_out' - p V' + h A (T_wall - T),     p V = m R T

E. Richer and Y. Hurmuzlu, A high performance pneumatic force actuator system, part I, J. Dyn. Sys. Meas.
Control 122 (2000) 416-425. A flow carries the enthalpy of the side that it comes from. The heat is that of
the temperature at the end of the step (backward Euler), so that any heat conductance h A is stable: none is
adiabatic, a large one isothermal. Both changes are exactly zero at rest.
"""

from uictest.core.physics.arithmetic import fma, select


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

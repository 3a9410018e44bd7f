"""Air tank that stands in for a brake cylinder and its pipe."""

from uictest.physics.arithmetic import fma


def pressure_change(
    pressure: float,
    stiffness: float,
    mass_change: float,
    volume_change: float,
    air: float,
) -> float:
    """Change of absolute pressure in Pa.

        dp = n / V (R T dm - p dV)

    with one polytropic exponent n between isothermal (1) and adiabatic (1.4) for filling, venting and piston
    motion: E. Richer and Y. Hurmuzlu, A high performance pneumatic force actuator system, part I,
    J. Dyn. Sys. Meas. Control 122 (2000) 416-425.

    Args:
        pressure: absolute pressure, Pa.
        stiffness: polytropic exponent over the volume, n / V, 1/m3.
        mass_change: air that has flowed in, kg.
        volume_change: growth of the volume, m3.
        air: specific gas constant times the temperature of the air that flows, R T, J/kg.
    """
    return stiffness * fma(air, mass_change, -pressure * volume_change)

"""Air tank that stands in for a brake cylinder and its pipe."""


def pressure_change(
    pressure: float,
    volume: float,
    mass_change: float,
    volume_change: float,
    polytropic_exponent: float,
    gas_constant: float,
    temperature: float,
) -> float:
    """Change of absolute pressure in Pa.

        dp = n / V (R T dm - p dV)

    with one polytropic exponent n between isothermal (1) and adiabatic (1.4) for filling, venting and piston
    motion: E. Richer and Y. Hurmuzlu, A high performance pneumatic force actuator system, part I,
    J. Dyn. Sys. Meas. Control 122 (2000) 416-425.

    Args:
        pressure: absolute pressure, Pa.
        volume: volume, m3.
        mass_change: air that has flowed in, kg.
        volume_change: growth of the volume, m3.
        polytropic_exponent: n.
        gas_constant: specific gas constant R, J/(kg K).
        temperature: temperature of the air that flows, K.
    """
    heating = gas_constant * temperature * mass_change
    return polytropic_exponent / volume * (heating - pressure * volume_change)

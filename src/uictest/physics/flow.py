"""Mass flow of air through an orifice or valve: ISO 6358-1."""

from uictest.physics.arithmetic import maximum, minimum, select, sqrt

REFERENCE_DENSITY = 1.185
"""Density of air in the reference atmosphere (ANR) of ISO 8778, kg/m3: 293.15 K, 1 bar, 65 % humidity."""
REFERENCE_TEMPERATURE = 293.15
"""Temperature of the reference atmosphere (ANR) of ISO 8778, K."""


def orifice_law(
    critical_ratio: float, laminar_ratio: float, temperature: float
) -> tuple[float, float, float, float, float]:
    """Numbers of :func:`mass_flow` that do not change while the rig runs: divided only once.

    Args:
        critical_ratio: critical pressure ratio b, 0 < b < laminar_ratio.
        laminar_ratio: pressure ratio above which the flow is linear, below 1.
        temperature: temperature T1 of the air upstream, K.

    Returns:
        rho0 sqrt(T0 / T1) in kg/m3, b, 1 / (1 - b), the laminar ratio and 1 / (1 - laminar ratio).
    """
    density = REFERENCE_DENSITY * sqrt(REFERENCE_TEMPERATURE / temperature)
    return density, critical_ratio, 1.0 / (1.0 - critical_ratio), laminar_ratio, 1.0 / (1.0 - laminar_ratio)


def mass_flow(
    pressure_1: float,
    pressure_2: float,
    inverse_upstream: float,
    conductance: float,
    density: float,
    critical_ratio: float,
    subsonic_scale: float,
    laminar_ratio: float,
    laminar_scale: float,
) -> float:
    """Mass flow from side 1 to side 2 in kg/s; negative when side 2 has the higher pressure.

        m' = p1 C rho0 sqrt(T0 / T1)                                        p2 / p1 <= b   (choked)
        m' = p1 C rho0 sqrt(T0 / T1) sqrt(1 - ((p2 / p1 - b) / (1 - b))^2)  otherwise

    Above ``laminar_ratio`` the flow falls linearly to zero at equal pressures: its slope stays finite.

    Args:
        pressure_1: absolute pressure of side 1, Pa.
        pressure_2: absolute pressure of side 2, Pa.
        inverse_upstream: 1 over the higher of the two, 1/Pa.
        conductance: sonic conductance C, m3/(s Pa).
        density, critical_ratio, subsonic_scale, laminar_ratio, laminar_scale: :func:`orifice_law`.
    """
    upstream = maximum(pressure_1, pressure_2)
    downstream = minimum(pressure_1, pressure_2)
    ratio = downstream * inverse_upstream
    direction = select(pressure_2 > pressure_1, -1.0, 1.0)
    subsonic = maximum((minimum(ratio, laminar_ratio) - critical_ratio) * subsonic_scale, 0.0)
    laminar = minimum((upstream - downstream) * inverse_upstream * laminar_scale, 1.0)
    return direction * upstream * conductance * density * sqrt(1.0 - subsonic * subsonic) * laminar

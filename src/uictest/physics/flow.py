"""Mass flow of air through an orifice or valve: ISO 6358-1."""

from uictest.physics.arithmetic import fma, maximum, minimum, select, sqrt

REFERENCE_DENSITY = 1.185
"""Density of air in the reference atmosphere (ANR) of ISO 8778, kg/m3: 293.15 K, 1 bar, 65 % humidity."""
REFERENCE_TEMPERATURE = 293.15
"""Temperature of the reference atmosphere (ANR) of ISO 8778, K."""


def orifice_law(
    critical_ratio: float, laminar_ratio: float, temperature: float
) -> tuple[float, float, float, float]:
    """Numbers of :func:`mass_flow` that do not change while the rig runs: divided only once.

    Args:
        critical_ratio: critical pressure ratio b, 0 < b < laminar_ratio.
        laminar_ratio: pressure ratio l above which the flow is linear, below 1.
        temperature: temperature T1 of the air upstream, K.

    Returns:
        rho0 sqrt(T0 / T1) in kg/m3, b, 1 / (1 - b) and sqrt(1 - ((l - b) / (1 - b))^2) / (1 - l).
    """
    density = REFERENCE_DENSITY * sqrt(REFERENCE_TEMPERATURE / temperature)
    subsonic_scale = 1.0 / (1.0 - critical_ratio)
    where_linear = (laminar_ratio - critical_ratio) * subsonic_scale
    laminar_slope = sqrt(1.0 - where_linear * where_linear) / (1.0 - laminar_ratio)
    return density, critical_ratio, subsonic_scale, laminar_slope


def mass_flow(
    pressure_1: float,
    pressure_2: float,
    conductance: float,
    density: float,
    critical_ratio: float,
    subsonic_scale: float,
    laminar_slope: float,
) -> float:
    """Mass flow from side 1 to side 2 in kg/s; negative when side 2 has the higher pressure.

        m' = C rho0 sqrt(T0 / T1) p1                                            p2 / p1 <= b   (choked)
        m' = C rho0 sqrt(T0 / T1) p1 sqrt(1 - ((p2 / p1 - b) / (1 - b))^2)      otherwise

    Above the laminar ratio the flow falls linearly to zero at equal pressures, along the chord of this
    curve: its slope stays finite. The curve bends down everywhere, so that the smaller of curve and chord
    is the flow; and with p1 under the root nothing is divided.

    Args:
        pressure_1: absolute pressure of side 1, Pa.
        pressure_2: absolute pressure of side 2, Pa.
        conductance: sonic conductance C, m3/(s Pa).
        density, critical_ratio, subsonic_scale, laminar_slope: :func:`orifice_law`.
    """
    upstream = maximum(pressure_1, pressure_2)
    downstream = minimum(pressure_1, pressure_2)
    direction = select(pressure_2 > pressure_1, -1.0, 1.0)
    subsonic = maximum(fma(-critical_ratio, upstream, downstream), 0.0) * subsonic_scale
    curve = sqrt(maximum(fma(-subsonic, subsonic, upstream * upstream), 0.0))
    chord = (upstream - downstream) * laminar_slope
    return direction * (conductance * density) * minimum(curve, chord)

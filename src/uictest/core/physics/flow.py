"""Mass flow of air through an orifice or valve: ISO 6358-1."""

from uictest.core.physics.arithmetic import fma, maximum, minimum, select, sqrt

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
            pressure_1,
            pressure_2,
            coldness_1,
            coldness_2,
            critical_ratio,
            subsonic_scale,
            laminar_slope,
        )
    )

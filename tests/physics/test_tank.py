"""A tank that fills, empties and changes its volume, against closed forms and scipy's integrator."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from uictest.physics.flow import REFERENCE_DENSITY, mass_flow, orifice_law
from uictest.physics.tank import pressure_change

R = 287.05
T = 293.15
AIR = R * T
ATMOSPHERE = 101_325.0
VOLUME = 2e-3
CONDUCTANCE = 1.1e-8
B = 0.35
LAW = orifice_law(critical_ratio=B, laminar_ratio=0.995, temperature=T)


def emptied(start: float, exponent: float, duration: float, step: float) -> np.ndarray:
    """Pressures of a tank that empties into the atmosphere, one per step."""
    pressures = [start]
    for _ in range(round(duration / step)):
        p = pressures[-1]
        lost = step * mass_flow(p, ATMOSPHERE, CONDUCTANCE, *LAW)
        pressures.append(p + pressure_change(p, exponent / VOLUME, -lost, 0.0, AIR))
    return np.array(pressures)


def test_isothermal_blow_down_through_a_choked_orifice_is_exponential() -> None:
    """p(t) = p0 exp(-t C rho0 R T / V) as long as the flow is choked, at the reference temperature."""
    step = 1e-5
    pressures = emptied(10e5, 1.0, 0.5, step)
    choked = pressures > ATMOSPHERE / B
    rate = CONDUCTANCE * REFERENCE_DENSITY * R * T / VOLUME
    time = step * np.arange(pressures.size)
    assert choked.sum() > 1000
    np.testing.assert_allclose(pressures[choked], 10e5 * np.exp(-rate * time[choked]), rtol=1e-5)


def blow_down_error(step: float) -> float:
    """Largest deviation from scipy's solution of the same equation, over the pressure at the start."""

    def slope(_: float, p: np.ndarray) -> list[float]:
        flow = mass_flow(float(p[0]), ATMOSPHERE, CONDUCTANCE, *LAW)
        return [-1.2 / VOLUME * R * T * flow]

    ours = emptied(4.8e5, 1.2, 2.0, step)
    time = step * np.arange(ours.size)
    exact = solve_ivp(slope, (0.0, time[-1]), [4.8e5], t_eval=time, rtol=1e-10, atol=1e-4, method="LSODA")
    return float(np.max(np.abs(ours - exact.y[0])) / 4.8e5)


def test_polytropic_blow_down_follows_scipys_solution() -> None:
    """From choked flow through the subsonic range to the atmosphere, at the rig's step of 0.5 ms."""
    error = blow_down_error(5e-4)
    assert error < 1e-3
    assert blow_down_error(2.5e-4) == pytest.approx(0.5 * error, rel=0.1)


@pytest.mark.parametrize("exponent", [1.0, 1.2, 1.4])
def test_closed_tank_keeps_p_v_to_the_n_while_its_volume_grows(exponent: float) -> None:
    pressure, volume = 4e5, 2.0e-3
    parts = 20_000
    for _ in range(parts):
        growth = 0.2e-3 / parts
        pressure += pressure_change(pressure, exponent / volume, 0.0, growth, AIR)
        volume += growth
    assert pressure * volume**exponent == pytest.approx(4e5 * 2.0e-3**exponent, rel=1e-5)


def test_isothermal_filling_is_the_gas_law() -> None:
    """With n = 1 a kilogram more raises p V by R T, whatever the pressure was."""
    change = pressure_change(3e5, 1.0 / VOLUME, 1e-3, 0.0, AIR)
    assert change * VOLUME == pytest.approx(1e-3 * R * T, rel=1e-14)


def test_adiabatic_filling_is_steeper_by_the_ratio_of_heats() -> None:
    slow = pressure_change(3e5, 1.0 / VOLUME, 1e-3, 0.0, AIR)
    fast = pressure_change(3e5, 1.4 / VOLUME, 1e-3, 0.0, AIR)
    assert fast / slow == pytest.approx(1.4)
    assert math.isfinite(fast)

"""Air in a vessel against closed forms of thermodynamics and scipy's integrator."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.integrate import solve_ivp

from uictest.core.physics.air import (
    REFERENCE_DENSITY,
    REFERENCE_TEMPERATURE,
    air_changes,
    enthalpy,
    mass_flow,
    orifice_law,
)

K = 1.4
R = 287.05
CV = R / (K - 1.0)
CP = K * CV
WALL = 293.15
ATMOSPHERE = 101_325.0
VOLUME = 2e-3
CONDUCTANCE = 1.1e-8
B = 0.35
LAW = orifice_law(critical_ratio=B, laminar_ratio=0.995)
BARE = 2.6
"""Heat conductance of a bare tank of two litres, W/K."""
ISOTHERMAL = 1e9
"""Heat conductance within a step, J/K, beside which the heat capacity of the air is nothing."""

masses = st.floats(1e-4, 0.1)
temperatures = st.floats(150.0, 450.0)
volumes = st.floats(1e-4, 1e-2)
exchanges = st.floats(0.0, 10.0)


@dataclass
class Vessel:
    """Air in a vessel; what it gained since it was filled is summed up beside it."""

    mass: float
    temperature: float = WALL
    volume: float = VOLUME
    heat: float = 0.0
    work: float = 0.0
    carried: float = 0.0

    def __post_init__(self):
        self.pressure = self.mass * R * self.temperature / self.volume

    @property
    def energy(self):
        return self.mass * CV * self.temperature

    def step(self, gained=0.0, source=WALL, *, growth=0.0, exchange=0.0):
        """Gain air (kg) from a source (K), or lose it, and change volume (m3)."""
        carried = enthalpy(gained, source, self.temperature, CP)
        self.mass += gained
        self.volume += growth
        self.work += self.pressure * growth
        warming, rise = air_changes(
            self.pressure,
            self.temperature,
            self.mass,
            gained,
            carried,
            self.volume,
            growth,
            WALL,
            exchange,
            R,
            CV,
        )
        self.temperature += warming
        self.pressure += rise
        self.carried += carried
        self.heat += exchange * (WALL - self.temperature)


def filled(pressure, temperature=WALL):
    return Vessel(pressure * VOLUME / (R * temperature), temperature)


def through_orifice(pressure, temperature, beyond):
    """Flow into a vessel from what lies beyond its orifice at the temperature of the wall, kg/s."""
    cold, cold_wall = REFERENCE_TEMPERATURE / temperature, REFERENCE_TEMPERATURE / WALL
    return mass_flow(beyond, pressure, cold_wall, cold, CONDUCTANCE, *LAW)


def test_closed_adiabatic_tank_keeps_p_v_to_the_ratio_of_heats_while_its_volume_grows():
    vessel = filled(4e5)
    parts = 20_000
    for _ in range(parts):
        vessel.step(growth=0.5 * VOLUME / parts)
    assert vessel.volume == pytest.approx(1.5 * VOLUME)
    assert vessel.pressure * 1.5**K == pytest.approx(4e5, rel=1e-4)
    assert vessel.temperature * 1.5 ** (K - 1.0) == pytest.approx(WALL, rel=1e-4)


@given(st.one_of(st.just(0.0), masses), masses, temperatures, temperatures, st.integers(1, 5))
def test_adiabatic_filling_adds_the_enthalpy_of_the_source(first, more, temperature, source, parts):
    """U = U0 + cp T_in m_in, in however many steps: p rises by k R T_in m_in / V, whatever there was."""
    vessel = Vessel(first, temperature)
    before = vessel.pressure
    for _ in range(parts):
        vessel.step(more / parts, source)
    mixed = (first * temperature + K * more * source) / (first + more)
    assert vessel.temperature == pytest.approx(mixed, rel=1e-12)
    assert vessel.pressure == pytest.approx(before + K * R * source * more / VOLUME, rel=1e-12)


def test_an_evacuated_tank_is_filled_with_air_warmer_by_the_ratio_of_heats():
    """The textbook case: 20 degC outside, 137 degC inside, whatever the size of the tank."""
    vessel = Vessel(0.0)
    vessel.step(1e-2)
    assert vessel.temperature == pytest.approx(1.4 * 293.15, rel=1e-14)


def test_adiabatic_venting_leaves_air_that_expanded_isentropically():
    """p / T^(k / (k - 1)) of the air that stays keeps its value: from 8 to 1 bar it cools to -111 degC."""
    vessel = filled(8e5)
    while vessel.pressure > 1e5:
        vessel.step(-1e-4 * vessel.mass)
    expected = WALL * (vessel.pressure / 8e5) ** ((K - 1.0) / K)
    assert vessel.temperature == pytest.approx(expected, rel=1e-4)
    assert vessel.temperature == pytest.approx(161.9, abs=0.2)


def test_isothermal_blow_down_through_a_choked_orifice_is_exponential():
    """p(t) = p0 exp(-t C rho0 R T / V) as long as the flow is choked, at the reference temperature."""
    step = 1e-5
    vessel = filled(10e5)
    pressures = [vessel.pressure]
    for _ in range(50_000):
        vessel.step(step * through_orifice(vessel.pressure, WALL, ATMOSPHERE), exchange=ISOTHERMAL)
        pressures.append(vessel.pressure)
    choked = np.array(pressures) > ATMOSPHERE / B
    rate = CONDUCTANCE * REFERENCE_DENSITY * R * WALL / VOLUME
    time = step * np.arange(len(pressures))
    assert choked.sum() > 1000
    np.testing.assert_allclose(np.array(pressures)[choked], 10e5 * np.exp(-rate * time[choked]), rtol=1e-5)


@given(masses, masses, st.floats(0.5, 2.0), temperatures)
def test_a_large_exchange_is_isothermal(first, more, stretch, source):
    """p V = m R Tw after any step, whatever flows in and however the volume changes."""
    vessel = Vessel(first)
    vessel.step(more, source, growth=(stretch - 1.0) * VOLUME, exchange=ISOTHERMAL)
    assert vessel.temperature == pytest.approx(WALL, rel=1e-6)
    assert vessel.pressure * stretch * VOLUME == pytest.approx((first + more) * R * WALL, rel=1e-6)


@given(masses, temperatures, exchanges, st.integers(1, 20))
def test_a_closed_tank_cools_towards_its_wall_by_the_same_share_in_every_step(
    mass, temperature, exchange, steps
):
    """Backward Euler of m cv T' = h A (Tw - T): never past the wall, however large the exchange."""
    vessel = Vessel(mass, temperature)
    for _ in range(steps):
        vessel.step(exchange=exchange)
    left = (1.0 + exchange / (mass * CV)) ** -steps
    assert vessel.temperature - WALL == pytest.approx((temperature - WALL) * left, abs=1e-9)


def stepped(vessel, step, duration, beyond):
    """Pressures of a vessel with the exchange of a bare tank, one per step."""
    pressures = [vessel.pressure]
    for _ in range(round(duration / step)):
        gained = step * through_orifice(vessel.pressure, vessel.temperature, beyond)
        vessel.step(gained, exchange=step * BARE)
        pressures.append(vessel.pressure)
    return np.array(pressures)


def integrated(vessel, times, beyond):
    """Masses (kg) and energies (J) of a rigid vessel at times, by scipy, from mass and energy balance."""

    def slope(_, state):
        mass, energy = state.tolist()
        temperature = energy / (mass * CV)
        flow = through_orifice(energy * (K - 1.0) / VOLUME, temperature, beyond)
        carried = CP * (WALL if flow > 0.0 else temperature) * flow
        return [flow, carried + BARE * (WALL - temperature)]

    start = [vessel.mass, vessel.energy]
    span = (times[0], times[-1])
    return solve_ivp(slope, span, start, t_eval=times, rtol=1e-10, atol=1e-14, method="LSODA").y


def blow_down_error(step):
    """Largest deviation from scipy's solution of the same balances, over the pressure at the start."""
    vessel = filled(4.8e5)
    times = step * np.arange(round(2.0 / step) + 1)
    exact = integrated(vessel, times, ATMOSPHERE)[1] * (K - 1.0) / VOLUME
    ours = stepped(vessel, step, 2.0, ATMOSPHERE)
    return float(np.max(np.abs(ours - exact)) / 4.8e5)


def test_blow_down_with_heat_follows_scipys_solution():
    """From choked flow through the subsonic range to the atmosphere, at the rig's step of 0.5 ms."""
    error = blow_down_error(5e-4)
    assert error < 1e-3
    assert blow_down_error(2.5e-4) == pytest.approx(0.5 * error, rel=0.1)


def test_a_tank_that_is_filled_and_closed_warms_and_cools_as_its_balances_say():
    """0.3 s of filling from 4.8 bar as by scipy, then m cv T' = h A (Tw - T): the pressure falls again."""
    step = 2e-4
    vessel = filled(ATMOSPHERE)
    filling = integrated(vessel, np.array([0.0, 0.3]), 4.8e5)[:, -1]
    stepped(vessel, step, 0.3, 4.8e5)
    assert [vessel.mass, vessel.energy] == pytest.approx(filling.tolist(), rel=1e-3)
    assert vessel.temperature > WALL + 20.0
    excess, mass, pressures = vessel.temperature - WALL, vessel.mass, []
    for _ in range(round(2.0 / step)):
        vessel.step(exchange=step * BARE)
        pressures.append(vessel.pressure)
    time = step * np.arange(1, len(pressures) + 1)
    exact = mass * R / VOLUME * (WALL + excess * np.exp(-time * BARE / (mass * CV)))
    np.testing.assert_allclose(pressures, exact, rtol=1e-4)


@given(st.floats(1e4, 1e6), masses, volumes, exchanges)
def test_air_at_rest_does_not_change_by_a_bit(pressure, mass, volume, exchange):
    assert air_changes(pressure, WALL, mass, 0.0, 0.0, volume, 0.0, WALL, exchange, R, CV) == (0.0, 0.0)


@given(st.floats(1e4, 1e6), temperatures, masses, volumes)
def test_closed_adiabatic_air_does_not_change_by_a_bit_at_any_temperature(
    pressure, temperature, mass, volume
):
    assert air_changes(pressure, temperature, mass, 0.0, 0.0, volume, 0.0, WALL, 0.0, R, CV) == (0.0, 0.0)


moves = st.tuples(st.floats(-0.2, 0.2), temperatures, st.floats(-0.05, 0.05), exchanges)


@given(masses, temperatures, st.lists(moves, min_size=1, max_size=20))
def test_nothing_is_lost_of_mass_and_energy_whatever_happens(mass, temperature, history):
    """m cv T after = before + enthalpy + heat - work, and p V = m R T stays true."""
    vessel = Vessel(mass, temperature)
    before, moved = vessel.energy, vessel.energy
    for share, source, growth, exchange in history:
        vessel.step(share * vessel.mass, source, growth=growth * vessel.volume, exchange=exchange)
        moved += exchange * WALL + vessel.energy
    account = before + vessel.carried + vessel.heat - vessel.work
    assert vessel.energy == pytest.approx(account, rel=0.0, abs=1e-13 * moved)
    gas_law = vessel.mass * R * vessel.temperature
    assert vessel.pressure * vessel.volume == pytest.approx(gas_law, rel=0.0, abs=1e-13 * moved)


@pytest.mark.parametrize(("flow", "temperature"), [(1e-3, 250.0), (-1e-3, 400.0)])
def test_a_flow_carries_the_enthalpy_of_the_side_that_it_comes_from(flow, temperature):
    assert enthalpy(flow, 250.0, 400.0, CP) == flow * CP * temperature

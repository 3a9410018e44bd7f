"""Air: ISO 6358 flow through orifices, reservoir and compressor, tanks."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.integrate import solve_ivp

from uictest.core.physics.air import (
    REFERENCE_DENSITY,
    REFERENCE_TEMPERATURE,
    air_changes,
    coldness,
    compressor_running,
    enthalpy,
    isothermal_pressure,
    mass_flow,
    orifice_law,
    reduced_flow,
)

from .vessel import BARE, CP, CV, VOLUME, WALL, K, R, Vessel, filled

ADIABATIC = 1.4
ISENTROPIC_RATIO = (2.0 / (ADIABATIC + 1.0)) ** (ADIABATIC / (ADIABATIC - 1.0))
LAW = orifice_law(critical_ratio=0.35, laminar_ratio=0.995)
pressures = st.floats(1e4, 2e6)
temperatures = st.floats(150.0, 450.0)


def flow(
    pressure_1, pressure_2, temperature_1=REFERENCE_TEMPERATURE, temperature_2=REFERENCE_TEMPERATURE, law=LAW
):
    return mass_flow(pressure_1, pressure_2, coldness(temperature_1), coldness(temperature_2), 1e-8, *law)


def test_ellipse_follows_the_ideal_nozzle_within_one_per_cent():
    assert pytest.approx(0.52828, abs=5e-6) == ISENTROPIC_RATIO
    # Saint-Venant and Wantzel: the flow through an ideal nozzle, over the choked one.
    k = ADIABATIC
    ratios = np.linspace(ISENTROPIC_RATIO, 0.99, 200)
    ideal = np.sqrt(ratios ** (2 / k) - ratios ** ((k + 1) / k))
    choked = math.sqrt(ISENTROPIC_RATIO ** (2 / k) - ISENTROPIC_RATIO ** ((k + 1) / k))
    law = orifice_law(ISENTROPIC_RATIO, 0.999)
    ours = [flow(1e6, r * 1e6, law=law) for r in ratios.tolist()]
    np.testing.assert_allclose(np.array(ours) / flow(1e6, 1e5, law=law), ideal / choked, atol=0.01)


def test_choked_flow_is_the_conductance_at_the_reference_state_whatever_lies_behind():
    """By the definition of sonic conductance: m' = p1 C rho0 at the reference temperature."""
    assert flow(8e5, 1e5) == pytest.approx(8e5 * 1e-8 * REFERENCE_DENSITY, rel=1e-15)
    # ISO 8778: air at 20 degC, 1 bar and 65 % humidity weighs 1.185 kg/m3.
    assert flow(1e5, 0.0) == pytest.approx(1.185e-3, rel=1e-12)
    assert flow(8e5, 0.35 * 8e5 * 0.999) == flow(8e5, 1e3)


@given(pressures, pressures, temperatures, temperatures, temperatures)
def test_warm_air_flows_more_slowly_by_its_root_and_what_is_downstream_does_not_matter(
    a, b, upstream, one, another
):
    """In every range: the law of ISO 6358 has sqrt(T0 / T1) before it."""
    expected = math.sqrt(REFERENCE_TEMPERATURE / upstream) * flow(a, b)
    assert flow(a, b, upstream, upstream) == pytest.approx(expected, rel=1e-14)
    high, low = max(a, b), min(a, b)
    assert flow(high, low, upstream, one) == flow(high, low, upstream, another)
    assert flow(low, high, one, upstream) == flow(low, high, another, upstream)


@given(pressures, pressures, temperatures, temperatures)
def test_flow_turns_when_the_sides_are_exchanged_with_their_air(a, b, temperature_a, temperature_b):
    cold_a, cold_b = coldness(temperature_a), coldness(temperature_b)
    forth, back = reduced_flow(a, b, cold_a, cold_b, *LAW), reduced_flow(b, a, cold_b, cold_a, *LAW)
    assert forth == -back
    assert (forth > 0.0) == (a > b)
    assert flow(a, a) == 0.0


@given(pressures, st.floats(0.0, 0.9999), st.floats(0.0, 0.9999))
def test_flow_never_grows_with_the_pressure_behind_the_orifice(p, a, b):
    low, high = sorted((a, b))
    assert flow(p, low * p) >= flow(p, high * p) * (1.0 - 1e-12)
    assert flow(p, high * p) > 0.0


@given(st.floats(1e5, 1e6), st.floats(1e5, 1e6))
def test_flow_grows_with_the_pressure_ahead_of_the_orifice(a, b):
    low, high = sorted((a, b))
    assert flow(high, 1e5) >= flow(low, 1e5)


def test_flow_has_no_jump_anywhere_and_a_finite_slope_at_equal_pressures():
    """Steps of 1e-5 in the ratio change the flow by less than a thousandth of the choked flow."""
    ratios = np.linspace(0.2, 1.0, 80_001).tolist()
    flows = [flow(1e6, r * 1e6) for r in ratios]
    assert max(abs(a - b) for a, b in pairwise(flows)) < 1e-3 * flow(1e6, 1e3)
    # The subsonic law alone has an infinite slope there; the laminar patch is a straight line.
    slopes = [flow(1e6, (1.0 - x) * 1e6) / x for x in (1e-12, 1e-9, 1e-6, 1e-3)]
    np.testing.assert_allclose(slopes, slopes[-1], rtol=1e-3)


@given(st.floats(0.0, 1.0))
def test_flow_follows_the_curve_up_to_the_laminar_ratio_and_its_chord_beyond(ratio):
    def curve(r):
        return math.sqrt(1.0 - (max(r - 0.35, 0.0) / 0.65) ** 2)

    chord = curve(0.995) * (1.0 - ratio) / 0.005
    expected = curve(ratio) if ratio <= 0.995 else chord
    assert flow(1e6, ratio * 1e6) / flow(1e6, 0.0) == pytest.approx(expected, rel=1e-11, abs=1e-14)


def test_air_at_the_standard_state_weighs_what_tables_say():
    """Dry air at 1.01325 bar and 15 degC: 1.225 kg/m3 (ISO 2533)."""
    assert isothermal_pressure(1.225, 287.05 * 288.15) == pytest.approx(101_325.0, rel=1e-4)


@given(st.floats(7.0, 8.0), st.sampled_from([0.0, 1.0]))
def test_compressor_starts_below_cut_in_stops_above_cut_out_and_goes_on_between(pressure, running):
    assert compressor_running(pressure, running, cut_in=7.0, cut_out=8.0) == running
    assert compressor_running(pressure - 1.1, running, cut_in=7.0, cut_out=8.0) == 1.0
    assert compressor_running(pressure + 1.1, running, cut_in=7.0, cut_out=8.0) == 0.0


ATMOSPHERE = 101_325.0
CONDUCTANCE = 1.1e-8
B = 0.35
ISOTHERMAL = 1e9
"""Heat conductance within a step, J/K, beside which the heat capacity of the air is nothing."""

masses = st.floats(1e-4, 0.1)
volumes = st.floats(1e-4, 1e-2)
exchanges = st.floats(0.0, 10.0)


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


def test_filled_and_vented_tanks_have_the_temperatures_of_the_textbook():
    """The textbook case: 20 degC outside, 137 degC inside, whatever the size of the tank."""
    vessel = Vessel(0.0)
    vessel.step(1e-2)
    assert vessel.temperature == pytest.approx(1.4 * 293.15, rel=1e-14)
    # p / T^(k / (k - 1)) of the air that stays keeps its value: from 8 to 1 bar it cools to -111 degC.
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


@given(st.floats(1e4, 1e6), temperatures, masses, volumes, exchanges)
def test_closed_air_as_warm_as_its_wall_or_without_heat_does_not_change_by_a_bit(
    pressure, temperature, mass, volume, exchange
):
    for warm, share in ((WALL, exchange), (temperature, 0.0)):
        changes = air_changes(pressure, warm, mass, 0.0, 0.0, volume, 0.0, WALL, share, R, CV)
        assert changes == (0.0, 0.0)


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

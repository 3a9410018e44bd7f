"""ISO 6358: choked and subsonic flow of air through an orifice."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.air import (
    REFERENCE_DENSITY,
    REFERENCE_TEMPERATURE,
    coldness,
    mass_flow,
    orifice_law,
    reduced_flow,
)

ADIABATIC = 1.4
ISENTROPIC_RATIO = (2.0 / (ADIABATIC + 1.0)) ** (ADIABATIC / (ADIABATIC - 1.0))
LAW = orifice_law(critical_ratio=0.35, laminar_ratio=0.995)
pressures = st.floats(1e4, 2e6)
temperatures = st.floats(150.0, 450.0)


def flow(
    pressure_1, pressure_2, temperature_1=REFERENCE_TEMPERATURE, temperature_2=REFERENCE_TEMPERATURE, law=LAW
):
    return mass_flow(pressure_1, pressure_2, coldness(temperature_1), coldness(temperature_2), 1e-8, *law)


def test_critical_pressure_ratio_of_an_ideal_nozzle():
    assert pytest.approx(0.52828, abs=5e-6) == ISENTROPIC_RATIO


def test_ellipse_follows_the_isentropic_nozzle_within_one_per_cent():
    """Saint-Venant and Wantzel: the flow through an ideal nozzle, over the choked one."""
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


@given(pressures, pressures, temperatures)
def test_warm_air_flows_more_slowly_by_the_root_of_its_temperature(a, b, warm):
    """In every range: the law of ISO 6358 has sqrt(T0 / T1) before it."""
    expected = math.sqrt(REFERENCE_TEMPERATURE / warm) * flow(a, b)
    assert flow(a, b, warm, warm) == pytest.approx(expected, rel=1e-14)


@given(pressures, pressures, temperatures, temperatures, temperatures)
def test_the_temperature_downstream_does_not_matter(a, b, upstream, one, another):
    high, low = max(a, b), min(a, b)
    assert flow(high, low, upstream, one) == flow(high, low, upstream, another)
    assert flow(low, high, one, upstream) == flow(low, high, another, upstream)


@given(pressures, pressures, temperatures, temperatures)
def test_flow_turns_when_the_sides_are_exchanged_with_their_air(a, b, temperature_a, temperature_b):
    cold_a, cold_b = coldness(temperature_a), coldness(temperature_b)
    forth, back = reduced_flow(a, b, cold_a, cold_b, *LAW), reduced_flow(b, a, cold_b, cold_a, *LAW)
    assert forth == -back
    assert (forth > 0.0) == (a > b)


@given(pressures)
def test_no_flow_between_equal_pressures(p):
    assert flow(p, p) == 0.0


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

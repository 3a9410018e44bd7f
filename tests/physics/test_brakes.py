"""Torque of the disc brake, friction of its pads, temperature of its discs."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from uictest.core.physics.brakes import (
    MODES,
    bulk_change,
    held_mode,
    held_rest,
    mode_after,
    mode_relaxation,
    quotient_factor,
    quotient_scale,
    relaxed_share,
    torque,
)


def test_torque_is_that_of_all_friction_faces_at_the_mean_radius():
    """14 kN on each of the four faces of two wheel discs: 4 x 0.38 x 14 kN x 0.289 m."""
    assert torque(14e3, calipers=2, pads=2, pad_friction=0.38, mean_radius=0.289) == pytest.approx(
        6149.9, rel=1e-5
    )


KMH = 1.0 / 3.6


def composite_block(speed):
    """(v + 150 km/h)/(v + 75 km/h), 1 at 40 km/h."""
    scale = quotient_scale(40.0 * KMH, 150.0 * KMH, 75.0 * KMH)
    return quotient_factor(speed * KMH, 150.0 * KMH, 75.0 * KMH, scale)


def test_the_quotient_of_composite_blocks():
    """2 at standstill and 270/195 at 120 km/h, over 190/115 at the reference."""
    assert composite_block(40.0) == pytest.approx(1.0, rel=1e-15)
    assert composite_block(0.0) == pytest.approx(2.0 * 115.0 / 190.0)
    assert composite_block(120.0) == pytest.approx(270.0 / 195.0 * 115.0 / 190.0)


@given(x=st.floats(0.0, 1e6), same=st.floats(1e-3, 1e6))
def test_a_quotient_of_equal_lines_is_exactly_one(x, same):
    """So that a pad without it has the friction of its table, bit for bit."""
    assert quotient_factor(x, same, same, quotient_scale(0.0, same, same)) == 1.0


@given(x=st.floats(0.0, 1e3), more=st.floats(0.0, 1e3), a=st.floats(1.0, 500.0), b=st.floats(1.0, 500.0))
def test_friction_falls_where_the_numerator_is_the_larger(x, more, a, b):
    first, second = (quotient_factor(at, max(a, b), min(a, b), 1.0) for at in (x, x + more))
    assert second <= first * (1.0 + 1e-12)
    assert 1.0 <= second <= max(a, b) / min(a, b) * (1.0 + 1e-12)


CYCLE = 0.01
CONDUCTIVITY, DENSITY, SPECIFIC_HEAT = 46.0, 7500.0, 490.0
DIFFUSIVITY = CONDUCTIVITY / (DENSITY * SPECIFIC_HEAT)
Array = NDArray[np.float64]


def surface_rise(flux, thickness, cycle=CYCLE):
    """Surface temperature less the initial one after each cycle of a flux in W/m2, nothing cooled."""
    fourier = DIFFUSIVITY * cycle / thickness**2
    held = thickness / CONDUCTIVITY
    relaxations = [mode_relaxation(n, fourier) for n in range(1, MODES + 1)]
    modes, bulk, surface = [0.0] * MODES, 0.0, []
    for q in flux:
        warming = cycle / (DENSITY * SPECIFIC_HEAT * thickness)
        bulk += bulk_change(bulk, 0.0, q, warming, 0.0)
        modes = [
            mode_after(mode, q, held * held_mode(n) * share, share)
            for n, (mode, share) in enumerate(zip(modes, relaxations, strict=True), start=1)
        ]
        surface.append(bulk + math.fsum(modes) + held * held_rest() * q)
    return np.array(surface)


@pytest.mark.parametrize("depths", [2.5, 4.0, 5.5])
@pytest.mark.parametrize("duration", [10.0, 28.0, 45.0])
def test_highest_surface_temperature_of_a_stop_on_a_thick_disc(duration, depths):
    """Half space under a flux that falls linearly to zero: 0.5319 q0 sqrt(t_s)/sqrt(k rho c), half way.

    From 2 q0/sqrt(pi k rho c) sqrt(t) (1 - 2 t/(3 t_s)) at t = t_s/2: 4/(3 sqrt(2 pi)) = 0.5319. Thick is a
    disc of some depths sqrt(alpha t_s), to which the heat gets.
    """
    assert 4.0 / (3.0 * math.sqrt(2.0 * math.pi)) == pytest.approx(0.5319, abs=5e-5)
    time = np.arange(CYCLE, duration, CYCLE)
    start = 4e5
    thickness = depths * math.sqrt(DIFFUSIVITY * duration)
    rise = surface_rise(start * (1.0 - (time - CYCLE / 2.0) / duration), thickness)
    effusivity = math.sqrt(CONDUCTIVITY * DENSITY * SPECIFIC_HEAT)
    assert rise.max() == pytest.approx(0.5319 * start * math.sqrt(duration) / effusivity, rel=0.01)
    assert time[rise.argmax()] == pytest.approx(duration / 2.0, rel=0.02)


def heat_equation(flux_at, thickness, cells=400):
    """Surface temperature of an insulated slab after each cycle: finite volumes, stepped by SciPy."""
    width = thickness / cells
    exchange = DIFFUSIVITY / width**2

    def change(time, temperature):
        flow = exchange * np.diff(temperature)
        rates = np.zeros(cells)
        rates[:-1] += flow
        rates[1:] -= flow
        number = min(int(time / CYCLE), len(flux_at) - 1)
        rates[0] += flux_at[number] / (DENSITY * SPECIFIC_HEAT * width)
        return rates

    bands = np.zeros((cells, cells))
    for k in range(cells):
        bands[k, max(k - 1, 0) : k + 2] = 1.0
    times = CYCLE * np.arange(1, len(flux_at) + 1)
    solution = solve_ivp(
        change,
        (0.0, times[-1]),
        np.zeros(cells),
        method="BDF",
        t_eval=times,
        rtol=1e-6,
        atol=1e-4,
        max_step=0.05,
        jac_sparsity=bands,
    )
    half_a_cell = flux_at * width / 2.0 / CONDUCTIVITY
    return np.asarray(solution.y[0] + half_a_cell)


def test_a_thin_disc_follows_the_heat_equation():
    """A ring of 20 mm in a stop of 8 s: neither a half space nor of one temperature.

    Once the modes that are left out have settled, some 0.1 s after the flux jumped.
    """
    time = np.arange(0.0, 8.0, CYCLE)
    flux = 5e5 * (1.0 - time / 8.0)
    flux[300:420] = 0.0
    ours, reference = surface_rise(flux, thickness=0.02), heat_equation(flux, thickness=0.02)
    settled = np.ones(len(time), dtype=bool)
    for jump in (0, 300, 420):
        settled[jump : jump + 20] = False
    np.testing.assert_allclose(ours[settled], reference[settled], atol=0.01 * reference.max())


def test_under_a_steady_flux_the_surface_leads_the_bulk_by_a_third():
    """T_surface - T = q L/(3 k) once all modes are held."""
    thickness, flux = 0.02, 3e5
    seconds = 40.0
    rise = surface_rise([flux] * round(seconds / CYCLE), thickness)[-1]
    bulk = flux * seconds / (DENSITY * SPECIFIC_HEAT * thickness)
    assert rise - bulk == pytest.approx(flux * thickness / (3.0 * CONDUCTIVITY), rel=1e-4)
    assert math.fsum(map(held_mode, range(1, MODES + 1))) + held_rest() == pytest.approx(1.0 / 3.0)


def test_cycles_of_any_length_give_the_same_temperature():
    """Each mode is solved exactly for a constant flux, however long the interval."""
    fine = surface_rise([2e5] * 400, 0.02, cycle=0.01)[-1]
    assert surface_rise([2e5], 0.02, cycle=4.0)[-1] == pytest.approx(fine, rel=1e-11)


@given(x=st.floats(0.0, 30.0))
def test_share_of_the_way_to_equilibrium(x):
    assert relaxed_share(x) == pytest.approx(-math.expm1(-x), rel=1e-10)


def test_the_series_goes_over_into_the_exponential():
    below, above = relaxed_share(0.01 - 1e-12), relaxed_share(0.01)
    assert above - below == pytest.approx(1e-12 * math.exp(-0.01), rel=0.1)


@given(excess=st.floats(1.0, 800.0), cycles=st.integers(1, 2000))
def test_a_disc_that_rolls_cools_exponentially(excess, cycles):
    """T - T_ambient = (T0 - T_ambient) exp(-h A t/C), in cycles or at once."""
    per_cycle, surroundings = 3e-4, 293.15
    temperature = surroundings + excess
    for _ in range(cycles):
        temperature += bulk_change(temperature, surroundings, 0.0, 1e-5, relaxed_share(per_cycle))
    assert temperature - surroundings == pytest.approx(excess * math.exp(-per_cycle * cycles), rel=1e-9)


def test_a_dragging_disc_comes_to_the_temperature_at_which_the_air_takes_all():
    """P = h A (T - T_ambient)."""
    capacity, conductance, power, interval = 1e5, 200.0, 30e3, 10.0
    share = relaxed_share(conductance * interval / capacity)
    warming = share / (conductance * interval)
    temperature = 300.0
    for _ in range(2000):
        temperature += bulk_change(temperature, 300.0, power * interval, warming, share)
    assert temperature == pytest.approx(300.0 + power / conductance)

"""Rail: friction along the track and in time, how sliding cleans it, and Polach's (2005) creep force."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.integrate import solve_ivp

from uictest.core.physics.rail import (
    cleaned_friction,
    cleaned_share,
    contact_stiffness,
    creep_force,
    friction_limit,
    interpolated,
    share_left_behind,
)

places = st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20, unique=True).map(sorted)


@given(places, st.floats(-2e3, 2e3))
def test_between_points_it_is_numpys_linear_interpolation(x, at):
    values = np.random.default_rng(len(x)).uniform(0.02, 0.6, len(x))
    expected = np.interp(at, x, values)
    assert interpolated(at, x, values, len(x)) == pytest.approx(expected, rel=1e-9)


def test_two_points_at_one_place_make_a_step_also_at_the_end_and_none_count_beyond():
    """The later of the two holds at the place itself."""
    x, y = [0.0, 150.0, 150.0, 300.0], [0.25, 0.25, 0.08, 0.08]
    assert interpolated(np.nextafter(150.0, 0.0), x, y, 4) == 0.25
    assert interpolated(150.0, x, y, 4) == 0.08
    assert interpolated(150.0, [0.0, 150.0, 150.0], [0.3, 0.3, 0.1], 3) == 0.1
    # The rows of the two laws of a rail have one length; the shorter law ends earlier.
    assert interpolated(9.0, [0.0, 1.0, 0.0, 0.0], [0.3, 0.2, 0.0, 0.0], 2) == 0.2


shares = st.floats(0.0, 1.0)
losses = st.floats(0.0, 1e5)
lengths = st.floats(1e-6, 50.0)


@given(shares, losses, lengths, st.floats(1e2, 1e6), st.floats(0.05, 10.0))
def test_the_share_solves_its_differential_equation(share, loss_per_metre, distance, energy, reach):
    expected = solve_ivp(
        lambda x, c: (1.0 - np.exp(-loss_per_metre / energy) - c) / reach,
        *((0.0, distance), [share]),
        method="LSODA",
        rtol=1e-9,
        atol=1e-12,
    ).y[0, -1]
    loss = loss_per_metre * distance
    assert cleaned_share(share, loss, distance, 1.0 / energy, 1.0 / reach) == pytest.approx(
        expected, rel=1e-6, abs=1e-8
    )


@given(losses, st.floats(1e2, 1e6))
def test_after_many_reaches_of_constant_sliding_the_share_has_settled(loss, energy):
    reach = 0.5
    share = cleaned_share(0.0, 40.0 * reach * loss, 40.0 * reach, 1.0 / energy, 1.0 / reach)
    assert share == pytest.approx(1.0 - np.exp(-loss / energy), rel=1e-9, abs=1e-12)


@given(shares, losses, lengths, lengths)
def test_a_stretch_in_two_parts_is_the_whole(share, loss, first, second):
    whole = cleaned_share(share, loss * (first + second), first + second, 1.0 / 5300.0, 2.0)
    half_way = cleaned_share(share, loss * first, first, 1.0 / 5300.0, 2.0)
    assert cleaned_share(half_way, loss * second, second, 1.0 / 5300.0, 2.0) == pytest.approx(
        whole, rel=1e-9, abs=1e-12
    )


@given(shares, lengths, st.floats(-1e3, 0.0))
def test_a_rolling_wheel_and_a_loss_below_zero_by_rounding_clean_nothing(share, distance, loss):
    assert cleaned_share(0.0, 0.0, distance, 1.0 / 5300.0, 2.0) == 0.0
    assert cleaned_share(0.0, 1e6, distance, 0.0, 2.0) == 0.0
    rolling = cleaned_share(share, 0.0, distance, 1.0 / 5300.0, 2.0)
    assert cleaned_share(share, loss, distance, 1.0 / 5300.0, 2.0) == rolling


@given(shares, shares, shares)
def test_each_wheelset_adds_to_what_it_finds(share, arrived, carry_over):
    """Of what is not clean on arrival, a wheelset cleans its share."""
    left = share_left_behind(share, arrived, carry_over)
    assert max(share, carry_over * arrived) - 1e-12 <= left <= 1.0
    assert left == pytest.approx(carry_over * arrived + (1.0 - carry_over * arrived) * share, abs=1e-12)


@given(st.floats(0.001, 1.0), shares, st.floats(0.001, 1.0))
def test_cleaning_goes_from_the_friction_found_up_to_that_of_a_clean_rail(friction, share, recovered):
    met = cleaned_friction(friction, share, recovered)
    clean = max(friction, recovered)
    assert met == pytest.approx(friction + share * (clean - friction), rel=1e-12)
    assert friction <= met <= clean * (1.0 + 1e-15)
    assert cleaned_friction(friction, 0.0, recovered) == friction


# mu0, A, B, kA, kS of Polach (2005).
DRY = (0.55, 0.40, 0.60, 1.00, 0.40)
WET = (0.30, 0.40, 0.20, 0.30, 0.10)
LOAD = 55e3
SHEAR_MODULUS, SEMI_AXIS_A, SEMI_AXIS_B, C11 = 8.1e10, 6e-3, 5e-3, 4.3
STIFFNESS = 0.25 * SHEAR_MODULUS * math.pi * SEMI_AXIS_A * SEMI_AXIS_B * C11
conditions = st.sampled_from([DRY, WET, (0.09, *WET[1:]), (0.03, *WET[1:])])
speeds = st.floats(0.01, 80.0)
loads = st.floats(2e4, 1.2e5)


def polach(w, v, load, law):
    mu0, a, b, ka, ks = law
    mu = mu0 * ((1 - a) * np.exp(-b * w) + a)
    eps = STIFFNESS * (w / v) / (load * mu)
    return 2 * load * mu / np.pi * (ka * eps / (1 + (ka * eps) ** 2) + np.arctan(ks * eps))


def force(w, v, law, load=LOAD):
    return creep_force(w, v, load, STIFFNESS, *law)[0]


@pytest.mark.parametrize("law", [DRY, WET])
@pytest.mark.parametrize("v", [0.1, 3.0, 33.0])
def test_force_is_polachs_over_all_slips(v, law):
    w = np.concatenate([np.geomspace(1e-9, 1.0, 300) * v, [0.0]])
    ours = [force(slip, v, law) for slip in w.tolist()]
    np.testing.assert_allclose(ours, polach(w, v, LOAD, law), rtol=1e-12)


@pytest.mark.parametrize("law", [DRY, WET])
def test_slope_at_zero_creep_and_friction_from_mu0_to_the_share_a(law):
    """dF/ds = (kA + kS)/2 G a b c11, with s = w / v."""
    expected = (law[3] + law[4]) / 2 * SHEAR_MODULUS * SEMI_AXIS_A * SEMI_AXIS_B * C11
    v = 20.0
    assert force(1e-9 * v, v, law) / 1e-9 == pytest.approx(expected, rel=1e-6)
    assert creep_force(0.0, v, LOAD, STIFFNESS, *law)[1] * v == pytest.approx(expected, rel=1e-12)
    mu0, ratio, decay = law[:3]
    at_rest, fast = (friction_limit(w, LOAD, mu0, ratio, decay)[0] for w in (0.0, 200.0))
    assert at_rest == pytest.approx(LOAD * mu0, rel=1e-15)
    assert fast == pytest.approx(LOAD * ratio * mu0, rel=1e-12)


def test_force_at_eps_4_467_on_a_wet_rail():
    """0.573 of the friction limit; a widespread wrong form, kA eps / (1 + kA eps^2), gives 0.390."""
    mu0, _, _, ka, ks = WET
    v = 20.0
    w = 4.467 * LOAD * mu0 / STIFFNESS * v
    constant_friction = (mu0, 1.0, 0.0, ka, ks)
    assert force(w, v, constant_friction) / (LOAD * mu0) == pytest.approx(0.573, abs=5e-4)


@given(st.floats(1e-6, 20.0))
def test_without_reductions_it_is_polach_1999(w):
    """F = (2 Q mu / pi) [eps / (1 + eps^2) + arctan(eps)]."""
    v, mu = 20.0, 0.3
    eps = STIFFNESS * w / v / (LOAD * mu)
    expected = 2 * LOAD * mu / math.pi * (eps / (1 + eps**2) + math.atan(eps))
    assert force(w, v, (mu, 1.0, 0.0, 1.0, 1.0)) == pytest.approx(expected, rel=1e-12)


@given(st.floats(0.0, 80.0), speeds, loads, conditions)
def test_force_never_exceeds_the_friction_limit(w, v, load, law):
    limit, _ = friction_limit(w, load, *law[:3])
    assert 0.0 <= force(w, v, law, load) <= limit * (1.0 + 1e-12)


@given(st.floats(1e-4, 1.0), st.floats(1.0, 60.0), conditions)
def test_slope_is_the_derivative_of_the_force(share, v, law):
    w = share * v
    h = 1e-4 * w
    central = (force(w + h, v, law) - force(w - h, v, law)) / (2 * h)
    slope = creep_force(w, v, LOAD, STIFFNESS, *law)[1]
    assert slope == pytest.approx(central, rel=1e-4, abs=1e-6 * force(w, v, law) / w)


@given(loads)
def test_contact_area_grows_with_the_load_as_hertz_says(load):
    """Both semi-axes grow with the cube root of the load."""
    assert contact_stiffness(STIFFNESS, load / LOAD) == pytest.approx(
        STIFFNESS * (load / LOAD) ** (2 / 3), rel=1e-11
    )

"""Friction along the track and in time, and how sliding cleans a rail."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.integrate import solve_ivp

from uictest.core.physics.rail import cleaned_friction, cleaned_share, interpolated, share_left_behind

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


@given(lengths)
def test_a_rolling_wheel_cleans_nothing(distance):
    assert cleaned_share(0.0, 0.0, distance, 1.0 / 5300.0, 2.0) == 0.0
    assert cleaned_share(0.0, 1e6, distance, 0.0, 2.0) == 0.0


@given(shares, lengths, st.floats(-1e3, 0.0))
def test_a_loss_below_zero_by_rounding_cleans_nothing(share, distance, loss):
    rolling = cleaned_share(share, 0.0, distance, 1.0 / 5300.0, 2.0)
    assert cleaned_share(share, loss, distance, 1.0 / 5300.0, 2.0) == rolling


@given(shares, shares, shares)
def test_each_wheelset_adds_to_what_it_finds(share, arrived, carry_over):
    """Of what is not clean on arrival, a wheelset cleans its share."""
    left = share_left_behind(share, arrived, carry_over)
    assert max(share, carry_over * arrived) - 1e-12 <= left <= 1.0
    assert left == pytest.approx(carry_over * arrived + (1.0 - carry_over * arrived) * share, abs=1e-12)


@given(st.floats(0.001, 1.0), shares, st.floats(0.001, 1.0))
def test_cleaning_never_lowers_friction_and_never_exceeds_a_clean_rail(friction, share, recovered):
    met = cleaned_friction(friction, share, recovered)
    assert friction <= met <= max(friction, recovered) * (1.0 + 1e-15)
    assert cleaned_friction(friction, 0.0, recovered) == friction


def test_a_clean_rail_has_the_recovered_friction():
    assert cleaned_friction(0.08, 1.0, 0.28) == pytest.approx(0.28)
    assert cleaned_friction(0.08, 0.5, 0.28) == pytest.approx(0.18)
    assert cleaned_friction(0.4, 0.5, 0.28) == 0.4

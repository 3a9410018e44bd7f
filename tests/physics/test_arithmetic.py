"""Our exponential, arctangent and power of two thirds against the C library, within their stated errors."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.arithmetic import (
    arctan_within_octant,
    clamp,
    exp,
    floor,
    fma,
    maximum,
    minimum,
    octant,
    power_two_thirds,
    select,
)

from ..conftest import fma_as_written

finite = st.floats(-1e12, 1e12)
signs = st.sampled_from([-1.0, 1.0])
nearly_one = st.builds(lambda sign, places: 1.0 + sign * 2.0**-places, signs, st.integers(1, 60))


def arctan(y, x=1.0):
    angle, opposite, adjacent = octant(y, x)
    return angle + arctan_within_octant(opposite / adjacent)


@given(st.floats(-36.0, 0.0))
def test_exponential_is_within_1e_13(x):
    assert exp(x) == pytest.approx(math.exp(x), rel=1e-13, abs=0.0)


def test_exponential_is_within_1e_13_on_a_dense_grid_and_exact_at_zero():
    x = np.linspace(-36.0, 0.0, 20_001)
    np.testing.assert_allclose([exp(value) for value in x.tolist()], np.exp(x), rtol=1e-13, atol=0.0)
    assert exp(0.0) == 1.0


@given(st.floats(max_value=-36.0))
def test_exponential_of_a_very_negative_number_is_that_of_minus_thirty_six(x):
    assert exp(x) == exp(-36.0) > 0.0


def test_arctangent_is_within_1e_15_over_all_magnitudes_and_exact_at_zero_and_a_quarter_turn():
    x = np.concatenate([np.linspace(0.0, 6.0, 20_001), np.geomspace(1e-150, 1e150, 5_001)])
    np.testing.assert_allclose([arctan(value) for value in x.tolist()], np.arctan(x), rtol=1e-15, atol=0.0)
    assert arctan(0.0) == 0.0
    assert arctan(1e20) == math.pi / 2


@pytest.mark.parametrize("border", [math.sqrt(2.0) - 1.0, 1.0 + math.sqrt(2.0)])
def test_arctangent_does_not_fall_where_its_approximations_meet(border):
    below = math.nextafter(border, 0.0)
    above = math.nextafter(border, 10.0)
    assert arctan(below) <= arctan(border) <= arctan(above)


@given(st.floats(0.0, 1e9), st.floats(1e-3, 1e9))
def test_rest_of_an_arctangent_is_at_most_an_eighth_of_a_half_turn(y, x):
    angle, opposite, adjacent = octant(y, x)
    assert angle in (0.0, math.pi / 4, math.pi / 2)
    assert adjacent > 0.0
    assert abs(opposite / adjacent) <= math.tan(math.pi / 8) * (1.0 + 1e-15)
    assert arctan(y, x) == pytest.approx(math.atan2(y, x), rel=2e-15, abs=0.0)


@pytest.fixture(autouse=True, scope="module")
def as_written():
    with fma_as_written():
        yield


def rounded_once(a, b, c):
    return float(Fraction(a) * Fraction(b) + Fraction(c))


@given(*[st.floats(1e-100, 1e100)] * 3, signs, st.integers(-3, 3))
def test_product_and_sum_are_rounded_once(a, b, c, sign, nearly):
    for term in (sign * c, -(a * b) * (1.0 + nearly * 2.0**-52)):
        assert fma(a, b, term) == rounded_once(a, b, term)


@given(nearly_one, nearly_one, nearly_one, signs, st.integers(0, 110))
def test_half_a_last_digit_is_rounded_by_what_is_left(a, b, c, sign, places):
    b *= sign * 2.0**-places
    assert fma(a, b, c) == rounded_once(a, b, c)


@pytest.mark.parametrize(
    ("a", "b", "c", "expected"),
    [
        (1.0 + 2.0**-30, 1.0 - 2.0**-30, -1.0, -(2.0**-60)),
        (-0.0, 1.0, -0.0, -0.0),
        (-0.0, 1.0, 0.0, 0.0),
        (1e-200, 1e-200, 1.0, 1.0),
        (2.0, 3.0, math.inf, math.inf),
        (math.inf, -1.0, 0.0, -math.inf),
        (math.inf, 1.0, -math.inf, math.nan),
        (1e200, 1e200, 0.0, math.inf),
    ],
)
def test_what_rounding_the_product_would_lose_zeros_and_what_is_not_finite(a, b, c, expected):
    assert np.float64(fma(a, b, c)).tobytes() == np.float64(expected).tobytes() or math.isnan(expected)


@given(st.floats(-1e15, 1e15))
def test_floor_is_the_c_librarys(x):
    assert floor(x) == math.floor(x)


def test_power_of_two_thirds_is_within_1e_12():
    x = np.linspace(0.2, 2.5, 20_001)
    ours = [power_two_thirds(value) for value in x.tolist()]
    np.testing.assert_allclose(ours, np.cbrt(x) ** 2, rtol=1e-12, atol=0.0)


@given(finite, finite, finite)
def test_order_and_choice(x, a, b):
    """A number that cannot be ordered gives way to the second."""
    assert (minimum(a, b), maximum(a, b)) == (min(a, b), max(a, b))
    assert (minimum(math.nan, a), maximum(math.nan, a)) == (a, a)
    low, high = sorted((a, b))
    assert clamp(x, low, high) == np.clip(x, low, high)
    assert (select(True, a, b), select(False, a, b)) == (a, b)

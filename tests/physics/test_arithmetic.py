"""Our exponential, arctangent and power of two thirds against the C library, within their stated errors."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uictest.physics.arithmetic import arctan, clamp, exp, maximum, minimum, power_two_thirds, select

finite = st.floats(-1e12, 1e12)


@given(st.floats(-40.0, 0.0))
def test_exponential_is_within_1e_13(x: float) -> None:
    assert exp(x) == pytest.approx(math.exp(x), rel=1e-13, abs=0.0)


def test_exponential_is_within_1e_13_on_a_dense_grid() -> None:
    x = np.linspace(-40.0, 0.0, 20_001)
    np.testing.assert_allclose([exp(value) for value in x.tolist()], np.exp(x), rtol=1e-13, atol=0.0)


def test_exponential_of_zero_is_one() -> None:
    assert exp(0.0) == 1.0


@given(st.floats(max_value=-40.0))
def test_exponential_of_a_very_negative_number_is_that_of_minus_forty(x: float) -> None:
    assert exp(x) == exp(-40.0) > 0.0


def test_arctangent_is_within_1e_15_over_all_magnitudes() -> None:
    x = np.concatenate([np.linspace(0.0, 6.0, 20_001), np.geomspace(1e-300, 1e300, 5_001)])
    np.testing.assert_allclose([arctan(value) for value in x.tolist()], np.arctan(x), rtol=1e-15, atol=0.0)


@pytest.mark.parametrize("border", [0.66, 1.0 + math.sqrt(2.0)])
def test_arctangent_does_not_fall_where_its_approximations_meet(border: float) -> None:
    below = math.nextafter(border, 0.0)
    above = math.nextafter(border, 10.0)
    assert arctan(below) <= arctan(border) <= arctan(above)


def test_arctangent_is_exact_at_zero_and_reaches_a_quarter_turn() -> None:
    assert arctan(0.0) == 0.0
    assert arctan(math.inf) == math.pi / 2


def test_power_of_two_thirds_is_within_1e_12() -> None:
    x = np.linspace(0.2, 2.5, 20_001)
    ours = [power_two_thirds(value) for value in x.tolist()]
    np.testing.assert_allclose(ours, np.cbrt(x) ** 2, rtol=1e-12, atol=0.0)


@given(finite, finite)
def test_smaller_and_larger_of_two_numbers(a: float, b: float) -> None:
    assert (minimum(a, b), maximum(a, b)) == (min(a, b), max(a, b))


def test_a_number_that_cannot_be_ordered_gives_way_to_the_second() -> None:
    assert (minimum(math.nan, 1.0), maximum(math.nan, 1.0)) == (1.0, 1.0)


@given(finite, finite, finite)
def test_clamping_agrees_with_numpy(x: float, a: float, b: float) -> None:
    low, high = sorted((a, b))
    assert clamp(x, low, high) == np.clip(x, low, high)


@given(st.booleans())
def test_selection(condition: bool) -> None:
    assert select(condition, 1.0, 2.0) == (1.0 if condition else 2.0)

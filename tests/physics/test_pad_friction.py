"""Factors of the friction of the pads."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.disc_brake import quotient_factor, quotient_scale

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

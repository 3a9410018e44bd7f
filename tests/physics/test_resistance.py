"""Running resistance and gradient."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.vehicle import gradient_force, running_resistance


@given(st.floats(-80.0, 80.0))
def test_resistance_is_daviss_and_always_against_the_motion(v):
    force = running_resistance(v, 530.0, 7.0, 0.9)
    if v == 0.0:
        assert force == 0.0
    else:
        assert force * v > 0.0
        assert abs(force) == pytest.approx(530.0 + 7.0 * abs(v) + 0.9 * v * v, rel=1e-12)


def test_a_tonne_on_ten_per_mille_pulls_98_newton_back():
    assert gradient_force(1000.0, 0.010, 9.80665) == pytest.approx(98.0665)

"""Geometry, forces, energies and resistance of the planar vehicle."""

import math

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.vehicle import (
    gradient_force,
    kinetic_energy,
    longitudinal,
    running_resistance,
    spring_energy,
    suspension_force,
    vertical,
)

length = st.floats(-15.0, 15.0)


@given(length, length, st.floats(-1.0, 1.0), st.floats(-0.1, 0.1))
def test_points_move_as_on_a_rigid_body_that_lifts_its_nose_a_little(ahead, above, x, z):
    """The linear part of a rotation by a small angle."""
    angle = 1e-6
    turned_x = ahead * math.cos(angle) - above * math.sin(angle)
    turned_z = ahead * math.sin(angle) + above * math.cos(angle)
    assert longitudinal(x, angle, above) == pytest.approx(x + turned_x - ahead, abs=1e-10)
    assert vertical(z, angle, ahead) == pytest.approx(z + turned_z - above, abs=1e-10)


def test_springs_dampers_and_a_car_have_the_forces_and_energies_of_their_laws():
    k, d, h = 5e6, 0.01, 1e-6
    slope = (spring_energy(k, d + h) - spring_energy(k, d - h)) / (2 * h)
    assert suspension_force(k, 0.0, d, 0.0) == pytest.approx(slope, rel=1e-9)
    assert suspension_force(0.0, 2e4, 0.3, 0.5) == 1e4
    # 45 t at 33.3 m/s: 25 MJ.
    assert kinetic_energy(45e3, 120 / 3.6) == pytest.approx(25e6)


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

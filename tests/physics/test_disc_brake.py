"""Torque of the disc brake."""

import pytest

from uictest.core.physics.disc_brake import torque


def test_torque_is_that_of_all_friction_faces_at_the_mean_radius():
    """14 kN on each of the four faces of two wheel discs: 4 x 0.38 x 14 kN x 0.289 m."""
    assert torque(14e3, calipers=2, pads=2, pad_friction=0.38, mean_radius=0.289) == pytest.approx(
        6149.9, rel=1e-5
    )

"""The half-space solver against Kalker's table, the open program CONTACT and limits."""

import math

import numpy as np
import pytest

from validation.half_space import HalfSpaceContact
from validation.sources import locomotive_creep

LOAD = 55e3
MODULUS = 81e9
SMALL = 1e-7


def constant(friction):
    return lambda slip: np.full_like(slip, friction)


def slope(contact):
    """Return Kalker's c11 of a contact: force per creepage over G a b, where nothing slips."""
    force = contact.force(SMALL, 1.0, LOAD, np.ones_like)
    return force / (SMALL * contact.shear_modulus * contact.along * contact.across)


@pytest.mark.parametrize(("poisson", "kalker"), [(0.0, 3.40), (0.25, 4.12), (0.5, 5.20)])
def test_the_slope_is_that_of_kalkers_table_for_a_circle(poisson, kalker):
    # The table counts the lateral tractions as well, which are left out here.
    assert slope(HalfSpaceContact(6e-3, 6e-3, MODULUS, poisson)) == pytest.approx(kalker, rel=0.02)


@pytest.mark.parametrize(
    ("creepage", "adhesion"), [(0.0004, 0.2588), (0.0008, 0.4742), (0.0016, 0.7831), (0.0032, 0.9976)]
)
def test_constant_friction_agrees_with_the_open_program(creepage, adhesion):
    """CONTACT, revision d431cdbd, examples/tractcurv.ref_out, first series: FX/FSTAT/FN."""
    contact = HalfSpaceContact(*locomotive_creep.SEMI_AXES, 82e9, 0.28)
    force = contact.force(creepage, 10.0, 106_700.0, constant(0.33))
    assert force / (0.33 * 106_700.0) == pytest.approx(adhesion, rel=0.005)


@pytest.mark.parametrize(("index", "adhesion"), [(0, 0.1154), (2, 0.3009), (5, 0.3015), (8, 0.1876)])
def test_a_layer_and_falling_friction_agree_with_the_open_program(index, adhesion):
    """Second series of the same file: FX over FN at 10 m/s."""
    assert locomotive_creep.program(10.0)[index] == pytest.approx(adhesion, rel=0.006)


def test_full_slip_transmits_the_friction_of_the_wheels_slip_which_scales_with_load():
    contact = HalfSpaceContact(6e-3, 5e-3, MODULUS, 0.28)
    force = contact.force(0.5, 20.0, LOAD, lambda slip: 0.1 + 0.2 * np.exp(-slip / 5.0))
    assert force / LOAD == pytest.approx(0.1 + 0.2 * math.exp(-2.0), rel=1e-3)
    double, half = (
        contact.force(0.001, 10.0, 2.0 * LOAD, constant(0.15)),
        contact.force(0.001, 10.0, LOAD, constant(0.3)),
    )
    assert double == pytest.approx(half, rel=1e-9)


@pytest.mark.parametrize("creepage", [0.0005, 0.002])
def test_finer_elements_change_little(creepage):
    forces = [
        HalfSpaceContact(6e-3, 5e-3, MODULUS, 0.28, elements=each).force(creepage, 10.0, LOAD, constant(0.3))
        for each in (16, 24, 32)
    ]
    assert forces[1] == pytest.approx(forces[2], rel=0.01)
    assert abs(forces[1] - forces[2]) < abs(forces[0] - forces[2]) < 0.04 * forces[2]

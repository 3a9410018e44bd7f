"""The parametrised transfer function."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.signal import cont2discrete

from uictest.rig.identification.cylinder import assembled
from uictest.rig.identification.output_error import basis, sections

constants = st.floats(0.002, 5.0)


@given(constants, constants, constants, st.tuples(*[st.floats(-2.0, 2.0)] * 3))
def test_every_set_of_parameters_is_stable_with_unity_gain(first, second, third, weights):
    model = assembled(np.log([first, second + third, second * third]), np.array(weights), 0.0005)
    a1, a2, a3 = model.denominator
    jury = (abs(a3) < 1.0, 1.0 - a1 + a2 - a3 > 0.0, abs(a2 - a1 * a3) < 1.0 - a3 * a3)
    assert all(jury)
    assert sum(model.numerator) / (1.0 + sum(model.denominator)) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("poles", [(0.1, 0.5, 0.04), (0.01, 0.02, 0.001), (3.0, 0.4, 0.04)])
def test_the_sections_are_held_at_the_sampling_time(poles):
    time_constant, alpha, beta = poles
    exact = [
        cont2discrete(([1.0], [time_constant, 1.0]), 0.001),
        cont2discrete(([1.0], [beta, alpha, 1.0]), 0.001),
        cont2discrete(([alpha, 0.0], [beta, alpha, 1.0]), 0.001),
    ]
    for (b, a), (b_exact, a_exact, _) in zip(sections(np.log(poles), 0.001), exact, strict=True):
        assert a == pytest.approx(a_exact, abs=1e-12)
        assert b == pytest.approx(np.squeeze(b_exact), abs=1e-12)


def test_the_assembled_function_is_the_weighted_sum_of_the_sections():
    poles, weights = np.log([0.1, 0.5, 0.04]), np.array([0.3, -0.2, 0.5])
    samples = np.concatenate([np.zeros(5), np.linspace(0.0, 1.0, 500), np.full(500, 0.4)])
    expected = samples + basis(samples, sections(poles, 0.001), np.arange(len(samples))) @ weights
    assert assembled(poles, weights, 0.001).output(samples) == pytest.approx(expected, abs=1e-9)


def test_the_band_ends_where_the_gain_has_fallen_by_three_decibels():
    lag = assembled(np.log([0.1, 0.02, 0.0001]), np.array([1.0, 0.0, 0.0]), 0.0005)
    assert lag.band == pytest.approx(1.0 / (2.0 * np.pi * 0.1), rel=0.05)

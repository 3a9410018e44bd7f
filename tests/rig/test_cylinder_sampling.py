"""The cylinder's transfer function at another step."""

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from uictest.rig.highest_creep import resampled_transfer_function

IDENTIFIED = 5e-4
LAGS = np.exp(-IDENTIFIED / np.array([30e-3, 8e-3, 3e-3]))
FILTERS = {
    "three lags": (np.poly(LAGS).sum() * np.array([0.4, 0.3, 0.2, 0.1]), np.poly(LAGS)),
    "oscillating": butter(3, 20.0, fs=1.0 / IDENTIFIED),
}
held = np.repeat(np.random.default_rng(8).normal(2e5, 1e5, 50), 40)


@pytest.mark.parametrize("kind", FILTERS)
@pytest.mark.parametrize("parts", [2, 5])
def test_finer_step_reproduces_the_response(kind, parts):
    """To any input that is held for the step of the identification, at each of its instants."""
    numerator, denominator = FILTERS[kind]
    b, a = resampled_transfer_function(list(numerator), list(denominator[1:]), IDENTIFIED, IDENTIFIED / parts)
    fine = lfilter(b, [1.0, *a], np.repeat(held, parts))
    np.testing.assert_allclose(fine[::parts], lfilter(numerator, denominator, held), rtol=1e-6, atol=1.0)


@pytest.mark.parametrize("kind", FILTERS)
def test_coarser_step_reproduces_the_response(kind):
    """To any input that is held for the coarser step."""
    numerator, denominator = FILTERS[kind]
    b, a = resampled_transfer_function(list(numerator), list(denominator[1:]), IDENTIFIED, 2.0 * IDENTIFIED)
    fine = lfilter(numerator, denominator, held)
    np.testing.assert_allclose(lfilter(b, [1.0, *a], held[::2]), fine[::2], rtol=1e-6, atol=1.0)


@pytest.mark.parametrize("kind", FILTERS)
@pytest.mark.parametrize("share", [0.25, 0.5, 2.0])
def test_constant_pressure_still_comes_out_as_it_went_in(kind, share):
    numerator, denominator = FILTERS[kind]
    b, a = resampled_transfer_function(list(numerator), list(denominator[1:]), IDENTIFIED, share * IDENTIFIED)
    assert sum(b) / (1.0 + sum(a)) == pytest.approx(1.0, rel=1e-6)


def test_coefficients_at_their_own_step_are_left_alone():
    numerator, denominator = [0.1, 0.2, 0.3, 0.4], [-0.1, 0.05, 0.0]
    assert resampled_transfer_function(numerator, denominator, IDENTIFIED, IDENTIFIED) == (
        numerator,
        denominator,
    )

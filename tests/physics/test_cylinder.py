"""The third-order transfer function against scipy.signal and control."""

import control
import numpy as np
import pytest
from scipy.signal import lfilter

from uictest.core.physics.caliper import memory, output

POLES = np.exp(-5e-4 / np.array([30e-3, 8e-3, 3e-3]))
DENOMINATOR = np.poly(POLES)
NUMERATOR = DENOMINATOR.sum() * np.array([0.4, 0.3, 0.2, 0.1])


def filtered(inputs):
    memories = [0.0, 0.0, 0.0, 0.0]
    outputs = []
    for u in inputs.tolist():
        y = output(u, memories[0], NUMERATOR[0])
        for i in range(3):
            memories[i] = memory(u, y, NUMERATOR[i + 1], DENOMINATOR[i + 1], memories[i + 1])
        outputs.append(y)
    return np.array(outputs)


def test_random_and_constant_inputs_are_filtered_as_scipy_does():
    inputs = np.random.default_rng(1).normal(2e5, 1e5, 4000)
    ours = filtered(inputs)
    np.testing.assert_allclose(ours, lfilter(NUMERATOR, DENOMINATOR, inputs), rtol=1e-12, atol=1e-6)
    assert filtered(np.full(4000, 3.8e5))[-1] == pytest.approx(3.8e5, rel=1e-12)


def test_step_response_is_that_of_the_transfer_function_in_control():
    system = control.tf(NUMERATOR, DENOMINATOR, 5e-4)
    response = control.step_response(system, T=5e-4 * np.arange(400))
    np.testing.assert_allclose(filtered(np.ones(400)), np.squeeze(response.outputs), rtol=1e-9, atol=1e-12)
    assert np.all(np.abs(system.poles()) < 1.0)

"""A third-order transfer function, stable and of unity gain at rest by its parametrisation.

    H(s) = 1 + c1 (1/(1 + T s) - 1) + (c2 + c3 alpha s)/(1 + alpha s + beta s^2) - c2,   T, alpha, beta > 0

held at the sampling time (zero-order hold). The section of second order has real or complex poles. For
given poles the output is linear in c1, c2 and c3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uictest.rig.identification.lines import Samples

Poles = NDArray[np.float64]
"""Logarithms of T in s, alpha in s and beta in s^2."""

_GRID = 2.0**-50
"""Coefficients are multiples of this."""


@dataclass(frozen=True)
class TransferFunction:
    """(b0 + b1/z + b2/z2 + b3/z3) / (1 + a1/z + a2/z2 + a3/z3) at a sampling time in s."""

    numerator: tuple[float, float, float, float]
    denominator: tuple[float, float, float]
    sampling_time: float

    def output(self, samples: Samples) -> Samples:
        """The response to ``samples``, at rest at the first of them."""
        from scipy.signal import lfilter

        filtered = lfilter(self.numerator, [1.0, *self.denominator], samples - samples[0])
        return np.asarray(filtered + samples[0])

    @cached_property
    def system(self) -> object:
        """The same as a system of python-control."""
        import control

        return control.TransferFunction(list(self.numerator), [1.0, *self.denominator], self.sampling_time)

    @property
    def poles(self) -> NDArray[np.complex128]:
        """Poles in the z plane, by python-control."""
        import control

        return np.asarray(control.poles(self.system))

    def response(self, frequencies: Samples) -> NDArray[np.complex128]:
        """Complex gain at frequencies in Hz, by python-control."""
        import control

        return np.asarray(control.frequency_response(self.system, 2.0 * np.pi * frequencies).complex)

    @property
    def band(self) -> float:
        """Frequency in Hz up to which the gain stays within 3 dB of one; at most half the sampling rate."""
        frequencies = np.geomspace(1e-3, 0.499 / self.sampling_time, 400)
        outside = np.abs(20.0 * np.log10(np.abs(self.response(frequencies)))) > 3.0
        return float(frequencies[np.argmax(outside)]) if np.any(outside) else 0.5 / self.sampling_time


def sections(poles: Poles, step: float) -> list[tuple[Samples, Samples]]:
    """Numerator and denominator of the three held sections: lag, low pass and band pass."""
    time_constant, alpha, beta = np.exp(poles)
    decay = np.exp(-step / time_constant)
    scale = np.sqrt(beta)
    # State: the low pass and scale x its rate; the input, held, is the third.
    rates = np.array(
        [[0.0, 1.0 / scale, 0.0], [-1.0 / scale, -alpha / beta, 1.0 / scale], [0.0, 0.0, 0.0]], dtype=float
    )
    held = _exponential(rates * step)
    transition, driven = held[:2, :2], held[:2, 2]
    trace = transition[0, 0] + transition[1, 1]
    denominator = np.array([1.0, -trace, np.exp(-step * alpha / beta)])
    later = transition @ driven - trace * driven
    low = np.array([0.0, driven[0], later[0]])
    band = np.array([0.0, driven[1], later[1]]) * (alpha / scale)
    lag = np.array([0.0, 1.0 - decay]), np.array([1.0, -decay])
    return [lag, (low, denominator), (band, denominator)]


def _exponential(matrix: Samples) -> Samples:
    """Matrix exponential of a small matrix: Taylor's series, scaled and squared; scipy's costs far more."""
    squarings = max(int(np.ceil(np.log2(max(np.abs(matrix).sum(axis=1).max(), 1e-300)))) + 2, 0)
    scaled = matrix / 2.0**squarings
    term = total = np.eye(len(matrix))
    for n in range(1, 14):
        term = term @ scaled / n
        total = total + term
    for _ in range(squarings):
        total = total @ total
    return np.asarray(total)


def basis(samples: Samples, poles: Poles, step: float, at: NDArray[np.intp]) -> Samples:
    """Three columns at some of the samples; the output is the input plus their sum weighted by c1, c2, c3."""
    from scipy.signal import lfilter

    lag, low, band = (lfilter(b, a, samples)[at] for b, a in sections(poles, step))
    return np.stack([lag - samples[at], low - samples[at], band], axis=1)


def assembled(poles: Poles, weights: Samples, step: float) -> TransferFunction:
    """The transfer function of these poles and weights, its gain at rest one to the last digit."""
    (b_lag, a_lag), (b_low, a_low), (b_band, _) = sections(poles, step)
    denominator = np.convolve(a_lag, a_low)
    c1, c2, c3 = weights
    numerator = (1.0 - c1 - c2) * denominator
    numerator = numerator + c1 * np.convolve(b_lag, a_low) + np.convolve(a_lag, c2 * b_low + c3 * b_band)
    # The gain at rest is the ratio of two small differences of numbers near three. On this grid their sums
    # are exact, in whatever order they are taken; it moves a pole of 20 s by millionths.
    b0, b1, b2 = (round(float(b) / _GRID) * _GRID for b in numerator[:3])
    a1, a2, a3 = (round(float(a) / _GRID) * _GRID for a in denominator[1:])
    b3 = (1.0 + a1 + a2 + a3) - (b0 + b1 + b2)
    return TransferFunction((b0, b1, b2, b3), (a1, a2, a3), step)

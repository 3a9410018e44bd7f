"""Points of the unit cube and the quantiles of distributions there."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Distribution, Method, Normal
from uictest.plans.scenario.yaml import rounded_text

if TYPE_CHECKING:
    import pyarrow as pa

Points = NDArray[np.float64]
_BLOCK = 1024
"""Points of one random stream: each block has its own generator, so that any point takes few draws."""


def points(method: Method, size: int, dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    """Return the points of a sample with the given numbers (from 0), shape (numbers, dimensions).

    `size` counts points; for `saltelli` each of them makes (dimensions + 2) rows: see :func:`_saltelli`.
    """
    if not numbers.size:
        return np.empty((0, dimensions))
    if method == "saltelli":
        return _saltelli(dimensions, seed, numbers)
    if method == "sobol":
        return _sobol(dimensions, seed, numbers)
    if method == "latin-hypercube":
        return _latin_hypercube(size, dimensions, seed)[numbers]
    return _random(dimensions, seed, numbers)


def _random(dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    blocks, within = numbers // _BLOCK, numbers % _BLOCK
    drawn = np.empty((numbers.size, dimensions))
    for block in np.unique(blocks):
        rows = blocks == block
        generator = np.random.Generator(np.random.Philox(np.random.SeedSequence([seed, int(block)])))
        drawn[rows] = generator.random((_BLOCK, dimensions))[within[rows]]
    return drawn


def _sobol(dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    first, last = int(numbers.min()), int(numbers.max())
    return _sobol_run(dimensions, seed, first, last + 1 - first)[numbers - first]


def _sobol_run(dimensions: int, seed: int, first: int, count: int) -> Points:
    from scipy.stats import qmc

    engine: Any = qmc.Sobol(dimensions, scramble=True, rng=seed)
    if first == 0:
        # scipy warns if the size of the first draw is not a power of two.
        count = 1 << (count - 1).bit_length()
    else:
        engine.fast_forward(first)
    drawn: Points = engine.random(count)
    return drawn


def sobol_blocks(blocks: int, size: int, dimensions: int, seed: int) -> Points:
    """Return blocks of Sobol' points, each scrambled for itself, one after the other.

    Each block is an estimate of its own, so that the spread over the blocks shows the error of their mean.

    Args:
        blocks: number of blocks.
        size: points of a block, a power of two.
        dimensions: of the unit cube.
        seed: of the scrambling; block k has seed + k.

    Returns:
        Shape (blocks * size, dimensions).

    """
    return np.concatenate([_sobol_run(dimensions, seed + k, 0, size) for k in range(blocks)])


@lru_cache(maxsize=1)
def _latin_hypercube(size: int, dimensions: int, seed: int) -> Points:
    """Return the whole design, which has every stratum of every parameter once."""
    from scipy.stats import qmc

    design: Points = qmc.LatinHypercube(dimensions, rng=seed).random(size)
    return design


def _saltelli(dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    """Rows of Saltelli's scheme: per base point one of A, one of B, one of A for each parameter taken from B.

    A and B are the halves of one Sobol sequence in twice the dimensions.
    """
    rows = dimensions + 2
    both = _sobol(2 * dimensions, seed, numbers // rows)
    role = numbers % rows
    drawn = np.where((role == 1)[:, None], both[:, dimensions:], both[:, :dimensions])
    for parameter in range(dimensions):
        swapped = role == parameter + 2
        drawn[swapped, parameter] = both[swapped, dimensions + parameter]
    return drawn


Probabilities = NDArray[np.float64]
Quantile = Callable[[Probabilities], NDArray[np.float64]]


def quantile(distribution: Distribution) -> Quantile:
    """Return the quantile function: probabilities (0 up to 1) to numbers in the distribution's unit.

    The numbers of a choice are the places of its values, from 0.
    """
    if distribution.choice is not None:
        count = len(distribution.choice)
        return lambda probabilities: np.minimum(np.floor(probabilities * count), count - 1.0)
    if distribution.normal is not None:
        return _cut_off_normal(distribution.normal)
    quantities = distribution.uniform or distribution.log_uniform or distribution.triangular
    assert quantities is not None
    numbers = [float(quantity.number) for quantity in quantities]
    if distribution.log_uniform is not None:
        return log_uniform(*numbers)
    return _triangular_quantile(*numbers) if distribution.triangular is not None else uniform(*numbers)


def uniform(low: float, high: float) -> Quantile:
    """Return the quantile function of numbers that are equally likely."""
    return lambda probabilities: np.clip(low + probabilities * (high - low), low, high)


def log_uniform(low: float, high: float) -> Quantile:
    """Return that of numbers whose logarithms are equally likely."""
    return lambda probabilities: np.clip(low * np.exp(probabilities * math.log(high / low)), low, high)


def _triangular_quantile(low: float, mode: float, high: float) -> Quantile:
    span, below = high - low, mode - low

    def at(probabilities: Probabilities) -> NDArray[np.float64]:
        rising = low + np.sqrt(probabilities * span * below)
        falling = high - np.sqrt((1.0 - probabilities) * span * (high - mode))
        return np.clip(np.where(probabilities < below / span, rising, falling), low, high)

    return at


def _cut_off_normal(normal: Normal) -> Quantile:
    mean, deviation, low, high = (
        float(quantity.number) for quantity in (normal.mean, normal.deviation, normal.lower, normal.upper)
    )
    standard = _cut_off_standard_normal((low - mean) / deviation, (high - mean) / deviation)
    return lambda probabilities: np.clip(mean + deviation * standard(probabilities), low, high)


def _cut_off_standard_normal(low: float, high: float) -> Quantile:
    from scipy.special import ndtr, ndtri

    if low >= 0.0:
        return _upper_tail(low, high)
    if high <= 0.0:
        mirrored = _upper_tail(-high, -low)
        return lambda probabilities: -mirrored(1.0 - probabilities)
    first, last = ndtr(low), ndtr(high)
    return lambda probabilities: ndtri(first + probabilities * (last - first))


def _upper_tail(low: float, high: float) -> Quantile:
    """The standard normal above its mean, by the logarithm of the probability to exceed a value.

    The cumulative distribution itself rounds to one from 8.3 deviations on, and its complement to zero from
    38; the logarithm, ln Q(x) = ln(Q(low) + s (Q(high) - Q(low))) at the probability s, does neither.
    """
    from scipy.special import log_ndtr, ndtri_exp

    beyond_low, beyond_high = log_ndtr(-low), log_ndtr(-high)

    def at(probabilities: Probabilities) -> NDArray[np.float64]:
        with np.errstate(divide="ignore"):  # the last value may be infinite: it is cut off
            beyond = beyond_low + np.log1p(probabilities * np.expm1(beyond_high - beyond_low))
        value: NDArray[np.float64] = -ndtri_exp(beyond)
        return value

    return at


_LAST_DIGIT: Final = 9
"""Power of ten between the first of ten digits and the last."""
_WHOLE: Final = 2.0**53
"""Every whole number up to it is a float."""
_NO_TIE: Final = 0.4999
"""A product this near to a whole number is rounded to it, whatever the last bit of the product."""
_PLACES_WITHOUT_EXPONENT: Final = 14
"""Arrow writes ten digits without an exponent from 1e-5 on."""
_POWERS: Final = np.array([float(10**power) for power in range(23)])
"""The powers of ten that are floats without rounding."""


@dataclass(frozen=True)
class RoundedNumbers:
    """Numbers rounded to ten digits, `digits / 10**places`.

    `digits` are whole, NaN where no float holds them.
    """

    numbers: NDArray[np.float64]
    digits: NDArray[np.float64]
    places: NDArray[np.int64]

    @cached_property
    def texts(self) -> pa.Array:
        """The texts of :func:`rounded_text`, Arrow strings without an exponent."""
        import pyarrow as pa
        import pyarrow.compute as pc

        is_exact = ~np.isnan(self.digits)
        texts = _decimal_texts(np.where(is_exact, self.digits, 0.0), self.places)
        if is_exact.all():
            return texts
        by_hand = [rounded_text(number) for number in self.numbers[~is_exact].tolist()]
        return pc.replace_with_mask(texts, pa.array(~is_exact), pa.array(by_hand, pa.string()))

    def in_unit(self, factor: Fraction, offset: Fraction) -> NDArray[np.float64]:
        """Return `factor * number + offset`, exact up to one division."""
        divisor = math.lcm(factor.denominator, offset.denominator)
        scaled = self.digits * int(factor * divisor)
        shift = int(offset * divisor) * _POWERS[self.places]
        divisors = _times_powers(divisor)[self.places]
        results: NDArray[np.float64] = (scaled + shift) / divisors
        is_exact = (abs(scaled) + abs(shift) < _WHOLE) & ~np.isnan(divisors)
        for place in np.flatnonzero(~is_exact).tolist():
            results[place] = float(Fraction(self.texts[place].as_py()) * factor + offset)
        return results


def rounded_numbers(numbers: NDArray[np.float64]) -> RoundedNumbers:
    """Return numbers rounded to ten digits."""
    magnitudes = np.where(numbers == 0.0, 1.0, abs(numbers))
    places = _LAST_DIGIT - np.floor(np.log10(magnitudes)).astype(int)
    has_power = (places >= 0) & (places < _POWERS.size)
    places[~has_power] = 0
    scaled = numbers * _POWERS[places]
    digits = np.rint(scaled)
    is_exact = has_power & (abs(scaled - digits) < _NO_TIE)
    digits[~is_exact] = np.nan
    return RoundedNumbers(numbers, digits, places)


def _decimal_texts(digits: NDArray[np.float64], places: NDArray[np.int64]) -> pa.Array:
    """Return the texts of `digits / 10**places`; zeros that call for an exponent are put in afterwards."""
    import pyarrow as pa
    import pyarrow.compute as pc

    zeros = np.maximum(places - _PLACES_WITHOUT_EXPONENT, 0)
    texts = pa.array(digits / _POWERS[places - zeros]).cast(pa.string())
    for count in np.unique(zeros[zeros > 0]).tolist():
        smaller = pc.replace_substring(texts, ".", "." + count * "0", max_replacements=1)
        texts = pc.if_else(pa.array(zeros == count), smaller, texts)
    return texts


@cache
def _times_powers(divisor: int) -> NDArray[np.float64]:
    """Return a divisor times the powers of ten, NaN where no float holds the product."""
    numbers = [divisor * 10**power for power in range(_POWERS.size)]
    return np.array([float(number) if int(float(number)) == number else math.nan for number in numbers])

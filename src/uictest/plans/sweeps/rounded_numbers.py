"""Numbers rounded to ten digits, column by column: the texts and values that one number has on its own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from uictest.plans.scenario.yaml import rounded_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

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
    """Numbers of ten digits: their texts, and `digits / 10**places`.

    `texts` are Arrow strings without an exponent; `digits` are whole, NaN where no float holds them.
    """

    texts: pa.Array
    digits: NDArray[np.float64]
    places: NDArray[np.int64]

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
    """Return numbers rounded to ten digits, with the texts of :func:`rounded_text`."""
    magnitudes = np.where(numbers == 0.0, 1.0, abs(numbers))
    places = _LAST_DIGIT - np.floor(np.log10(magnitudes)).astype(int)
    has_power = (places >= 0) & (places < _POWERS.size)
    places[~has_power] = 0
    scaled = numbers * _POWERS[places]
    digits = np.rint(scaled)
    is_exact = has_power & (abs(scaled - digits) < _NO_TIE)
    texts = _texts(digits, places)
    if not is_exact.all():
        by_hand = [rounded_text(number) for number in numbers[~is_exact].tolist()]
        texts = pc.replace_with_mask(texts, pa.array(~is_exact), pa.array(by_hand, pa.string()))
        digits[~is_exact] = np.nan
    return RoundedNumbers(texts, digits, places)


def _texts(digits: NDArray[np.float64], places: NDArray[np.int64]) -> pa.Array:
    """Return the texts of `digits / 10**places`; zeros that call for an exponent are put in afterwards."""
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

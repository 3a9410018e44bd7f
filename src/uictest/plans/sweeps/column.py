"""The values of a parameter in several cases, rounded to ten digits."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import parse_quantity, scalar_value
from uictest.plans.sweeps.decimal_quantity import rounded_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Places = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """A value of a parameter: as written, as the scenario holds it, and as case ids show it."""

    text: str
    content: Any
    label: str = ""

    @property
    def number(self) -> float:
        """The value in SI units, NaN where it is not a number."""
        return float(self.content) if _is_number(self.content) else math.nan


@dataclass(frozen=True)
class Column:
    """The values of a parameter in several cases.

    Args:
        written: the values as written, Arrow strings.
        numbers: in SI units, NaN where they are no numbers.
        exact: as a scenario holds them where all are numbers of one type, else None.
        value_at: returns the value of the case at a place.

    """

    written: pa.Array
    numbers: NDArray[np.float64]
    exact: NDArray[Any] | None
    value_at: Callable[[int], ParameterValue]

    @cached_property
    def texts(self) -> list[str]:
        """The values as written."""
        texts: list[str] = self.written.to_pylist()
        return texts

    @cached_property
    def codes(self) -> Places:
        """A number per case, the same where the value is the same."""
        codes: Places = self.written.dictionary_encode().indices.to_numpy().astype(int)
        return codes

    def take(self, places: Places) -> Column:
        """Return the values of some cases."""
        import pyarrow as pa

        return Column(
            self.written.take(pa.array(places)),
            self.numbers[places],
            None if self.exact is None else self.exact[places],
            lambda place: self.value_at(int(places[place])),
        )

    def one_by_one(self) -> Column:
        """Return the same values as such that only cases with the same one are looked at together."""
        return replace(self, exact=None)

    def __getitem__(self, place: int) -> ParameterValue:
        """Return the value of one case."""
        return self.value_at(place)

    def __iter__(self) -> Iterator[ParameterValue]:
        """Return the values of all cases."""
        return map(self.value_at, range(len(self)))

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self.written)


def listed_column(choices: Sequence[ParameterValue]) -> Column:
    """Return the values of a list, one after the other."""
    import numpy as np
    import pyarrow as pa

    contents = [value.content for value in choices]
    types = {type(content) is int for content in contents}
    exact = np.array(contents) if len(types) == 1 and all(map(_is_number, contents)) else None
    numbers = np.array([value.number for value in choices])
    texts = pa.array([value.text for value in choices], pa.string())
    return Column(texts, numbers, exact, choices.__getitem__)


def drawn_column(numbers: NDArray[np.float64], unit: str, kind: str) -> Column:
    """Return drawn numbers, rounded to ten digits, in a unit of a kind.

    A value is that of its text, so that a scenario with that text gives the same case. An empty kind is that
    of plain numbers that no part of the rig reads, which may be whole or not.
    """
    import pyarrow.compute as pc

    from uictest.plans.sweeps.column import rounded_numbers

    rounded = rounded_numbers(numbers)
    written = pc.binary_join_element_wise(rounded.texts, unit, " ") if unit else rounded.texts
    values = rounded.in_unit(*_to_si(kind, unit))

    def value_at(place: int) -> ParameterValue:
        text = written[place].as_py()
        return ParameterValue(text, content_of(text, kind))

    return Column(written, values, values if kind else None, value_at)


def content_of(text: str, kind: str) -> Any:
    """Return what a scenario holds where it says `text`: a quantity of a kind, or a plain number."""
    return parse_quantity(text, kind) if kind else scalar_value(text)


def _is_number(content: Any) -> bool:
    return isinstance(content, float | int) and not isinstance(content, bool)


def _to_si(kind: str, unit: str) -> tuple[Fraction, Fraction]:
    """Return factor and offset from a unit of a kind to SI units."""
    if not (kind and unit):
        return Fraction(1), Fraction(0)
    units = KINDS[kind].units[unit]
    return units.factor, units.offset


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

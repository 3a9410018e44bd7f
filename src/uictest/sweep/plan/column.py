"""The values of a parameter: one of them, and those of several cases."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

from uictest.scenario.yaml import parse_quantity, scalar_value
from uictest.units import KINDS

if TYPE_CHECKING:
    import numpy as np
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
        texts: the values as written.
        numbers: in SI units, NaN where they are no numbers.
        exact: as a scenario holds them where all are numbers of one type, else None.
        value_at: returns the value of the case at a place.

    """

    texts: list[str]
    numbers: NDArray[np.float64]
    exact: NDArray[Any] | None
    value_at: Callable[[int], ParameterValue]

    @cached_property
    def codes(self) -> Places:
        """A number per case, the same where the value is the same."""
        import numpy as np

        codes: Places = np.unique(self.texts, return_inverse=True)[1]
        return codes

    def take(self, places: Places) -> Column:
        """Return the values of some cases."""
        return Column(
            [self.texts[place] for place in places.tolist()],
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
        return len(self.texts)


def listed_column(choices: Sequence[ParameterValue], rows: Places) -> Column:
    """Return values out of a list: `rows` holds which of them each case has."""
    import numpy as np

    texts, contents = [value.text for value in choices], [value.content for value in choices]
    types = {type(content) is int for content in contents}
    exact = np.array(contents)[rows] if len(types) == 1 and all(map(_is_number, contents)) else None
    numbers = np.array([value.number for value in choices])[rows]
    return Column([texts[row] for row in rows.tolist()], numbers, exact, lambda place: choices[rows[place]])


def drawn_column(decimals: Sequence[str], unit: str, kind: str) -> Column:
    """Return drawn numbers, given without an exponent, in a unit of a kind.

    A value is that of its text, so that a scenario with that text gives the same case. An empty kind is that
    of plain numbers that no part of the rig reads, which may be whole or not.
    """
    import numpy as np

    texts = [f"{decimal} {unit}" for decimal in decimals] if unit else list(decimals)
    values = _si_numbers(decimals, kind, unit) if kind else map(float, decimals)
    numbers = np.fromiter(values, float, len(texts))

    def value_at(place: int) -> ParameterValue:
        return ParameterValue(texts[place], content_of(texts[place], kind))

    return Column(texts, numbers, numbers if kind else None, value_at)


def content_of(text: str, kind: str) -> Any:
    """Return what a scenario holds where it says `text`: a quantity of a kind, or a plain number."""
    return parse_quantity(text, kind) if kind else scalar_value(text)


def _is_number(content: Any) -> bool:
    return isinstance(content, float | int) and not isinstance(content, bool)


def _si_numbers(decimals: Sequence[str], kind: str, unit: str) -> Iterator[float]:
    """Yield numbers in SI units with the bits of :func:`parse_quantity`: exact up to one division."""
    units = KINDS[kind].units
    factor, offset = (units[unit].factor, units[unit].offset) if unit else (Fraction(1), Fraction(0))
    divisor = math.lcm(factor.denominator, offset.denominator)
    scale, shift = int(factor * divisor), int(offset * divisor)
    for decimal in decimals:
        whole, _, fraction = decimal.partition(".")
        power = 10 ** len(fraction)
        yield (int(whole + fraction) * scale + shift * power) / (divisor * power)

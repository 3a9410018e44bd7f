"""The values of a parameter: one of them, and those of several cases."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import Quantity, parse_quantity, scalar_value

if TYPE_CHECKING:
    import numpy as np
    import pyarrow as pa
    from numpy.typing import NDArray

    Places = NDArray[np.int64]


class ParameterValue(NamedTuple):
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
        write: returns the values as written, Arrow strings.
        numbers: in SI units, NaN where they are no numbers.
        exact: as a scenario holds them where all are numbers of one type, else None.
        value_at: returns the value of the case at a place.

    """

    write: Callable[[], pa.Array]
    numbers: NDArray[np.float64]
    exact: NDArray[Any] | None
    value_at: Callable[[int], ParameterValue]

    @cached_property
    def written(self) -> pa.Array:
        """The values as written; cases are simulated without them."""
        return self.write()

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
            lambda: self.written.take(pa.array(places)),
            self.numbers[places],
            None if self.exact is None else self.exact[places],
            lambda place: self.value_at(int(places[place])),
        )

    def __getitem__(self, place: int) -> ParameterValue:
        """Return the value of one case."""
        return self.value_at(place)

    def __iter__(self) -> Iterator[ParameterValue]:
        """Return the values of all cases."""
        return map(self.value_at, range(len(self)))

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self.numbers)


def listed_column(choices: Sequence[ParameterValue]) -> Column:
    """Return the values of a list, one after the other."""
    import numpy as np
    import pyarrow as pa

    contents = [value.content for value in choices]
    types = {type(content) is int for content in contents}
    exact = np.array(contents) if len(types) == 1 and all(map(_is_number, contents)) else None
    numbers = np.array([value.number for value in choices])
    texts = [value.text for value in choices]
    return Column(lambda: pa.array(texts, pa.string()), numbers, exact, choices.__getitem__)


def drawn_column(numbers: NDArray[np.float64], unit: str, kind: str) -> Column:
    """Return drawn numbers, rounded to ten digits, in a unit of a kind.

    A value is that of its text, so that a scenario with that text gives the same case. An empty kind is that
    of plain numbers that no part of the rig reads, which may be whole or not.
    """
    from uictest.plans.sweeps.sampling import rounded_numbers

    rounded = rounded_numbers(numbers)
    si = KINDS[kind].units[unit] if kind and unit else None
    values = rounded.in_unit(*((Fraction(1), Fraction(0)) if si is None else (si.factor, si.offset)))

    def write() -> pa.Array:
        import pyarrow.compute as pc

        return pc.binary_join_element_wise(rounded.texts, unit, " ") if unit else rounded.texts

    def value_at(place: int) -> ParameterValue:
        text = column.written[place].as_py()
        if not kind:
            return ParameterValue(text, scalar_value(text))
        return ParameterValue(text, Quantity(values[place], text, KINDS[kind].canonical))

    column = Column(write, values, values if kind else None, value_at)
    return column


def content_of(text: str, kind: str) -> Any:
    """Return what a scenario holds where it says `text`: a quantity of a kind, or a plain number."""
    return parse_quantity(text, kind) if kind else scalar_value(text)


def kind_of(example: Any, unit: str) -> str:
    """Return a kind of quantity in which the unit means the same as for the example, empty for a number."""
    if not isinstance(example, Quantity):
        return ""
    kinds = (kind for kind in KINDS.values() if kind.canonical == example.unit)
    return next(kind.name for kind in kinds if (unit in kind.units if unit else kind.bare))


def _is_number(content: Any) -> bool:
    return isinstance(content, float | int) and not isinstance(content, bool)

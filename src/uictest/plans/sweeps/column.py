"""The values of a parameter: one of them, those of several cases, and those of a plausible range."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from uictest.core.units import KINDS
from uictest.plans.scenario import Scenario, mark_of
from uictest.plans.scenario.yaml import (
    Key,
    Part,
    Prior,
    Quantity,
    Source,
    dotted,
    parse_decimal_quantity,
    parse_quantity,
    quantities_in,
    scalar_value,
)

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
        is_number = isinstance(self.content, float | int) and not isinstance(self.content, bool)
        return float(self.content) if is_number else math.nan


@dataclass(frozen=True)
class Column:
    """The values of a parameter in several cases.

    Args:
        write: returns the values as written, Arrow strings.
        numbers: in SI units, NaN where they are no numbers.
        value_at: returns the value of the case at a place.

    """

    write: Callable[[], pa.Array]
    numbers: NDArray[np.float64]
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

    def take(self, places: Places) -> Column:
        """Return the values of some cases."""
        import pyarrow as pa

        return Column(
            lambda: self.written.take(pa.array(places)),
            self.numbers[places],
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

    numbers = np.array([value.number for value in choices])
    texts = [value.text for value in choices]
    return Column(lambda: pa.array(texts, pa.string()), numbers, choices.__getitem__)


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

    column = Column(write, values, value_at)
    return column


def content_of(text: str, kind: str) -> Any:
    """Return the value of `text` in a scenario: a quantity of a kind, or a plain number."""
    return parse_quantity(text, kind) if kind else scalar_value(text)


def kind_of(example: Any, unit: str) -> str:
    """Return a kind of quantity in which the unit means the same as for the example, empty for a number."""
    if not isinstance(example, Quantity):
        return ""
    kinds = (kind for kind in KINDS.values() if kind.canonical == example.unit)
    return next(kind.name for kind in kinds if (unit in kind.units if unit else kind.bare))


_REASONS: Final[Mapping[Prior, str]] = {
    "uniform": "No value in the range is preferred",
    "log-uniform": "The order of magnitude is known: half and twice a value are as likely",
}
"""Reason for the prior of a number without a source: it is set in a scenario."""


@dataclass(frozen=True)
class RangedNumber:
    """A number with a plausible range.

    Args:
        key: where it stands in a scenario, dotted.
        value: its nominal value; `value.range` holds the ends.
        mark: of its source: stated, published, identified, chosen, or user.
        reason: text of the source of its range, which says why it has its prior, too.

    """

    key: str
    value: Quantity
    mark: str
    reason: str

    @property
    def ends(self) -> tuple[Quantity, Quantity]:
        """The lowest and the highest plausible value."""
        assert self.value.range is not None  # made by :func:`ranged_numbers`
        return self.value.range

    @property
    def is_logarithmic(self) -> bool:
        """Whether draws are even in the logarithm of the value, and not in the value."""
        return self.value.prior == "log-uniform"

    @cached_property
    def nominal_place(self) -> float:
        """The place of the nominal value in the range, from 0 to 1."""
        low, high = self._numbers
        value = float(parse_decimal_quantity(self.value.text).number)
        if self.is_logarithmic:
            return math.log(value / low) / math.log(high / low)
        return (value - low) / (high - low)

    def at(self, places: NDArray[np.float64]) -> Column:
        """Return the values at places of the range, from 0 (lowest) to 1, and NaN for the nominal value.

        A value between is rounded to ten digits and is that of its text: a scenario that has the text has the
        value.
        """
        import numpy as np

        numbers = self._numbers_at(np.where(np.isnan(places), 0.5, places))
        drawn = drawn_column(numbers, self._unit, kind_of(self.value, self._unit))
        low, high = (ParameterValue(end.text, end) for end in self.ends)
        known = {0.0: low, 1.0: high}
        if not (np.isnan(places) | np.isin(places, (0.0, 1.0))).any():
            return drawn
        nominal = ParameterValue(self.value.text, self.value)
        return listed_column(
            [
                nominal if math.isnan(place) else known.get(place) or drawn[k]
                for k, place in enumerate(places.tolist())
            ]
        )

    def rounded_text(self, place: float, *, up: bool) -> str:
        """Return the value at a place of the range, rounded up or down to about a hundredth of the range.

        It stays on its side of the nominal value.
        """
        import numpy as np

        if place in (0.0, 1.0):
            return self.ends[int(place)].text
        if place == self.nominal_place:
            return self.value.text
        [number] = self._numbers_at(np.array([place])).tolist()
        low, high = self._numbers
        size = min(number, high - low) if self.is_logarithmic else high - low
        step = Decimal(10) ** (math.floor(math.log10(size)) - 2)
        rounded = (Decimal(number) / step).to_integral_value(ROUND_CEILING if up else ROUND_FLOOR) * step
        nominal = float(parse_decimal_quantity(self.value.text).number)
        low, high = (low, nominal) if place < self.nominal_place else (nominal, high)
        return f"{min(max(float(rounded), low), high):.10g} {self._unit}".rstrip()

    def _numbers_at(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        from uictest.plans.sweeps.sampling import log_uniform, uniform  # numpy, which checking does not need

        return (log_uniform if self.is_logarithmic else uniform)(*self._numbers)(places)

    @cached_property
    def _unit(self) -> str:
        return parse_decimal_quantity(self.value.text).unit

    @cached_property
    def _numbers(self) -> tuple[float, float]:
        low, high = (float(parse_decimal_quantity(end.text).number) for end in self.ends)
        return low, high


def ranged_numbers(scenario: Scenario) -> list[RangedNumber]:
    """Return every number of a scenario that states a range and that its stop depends on.

    The controller has none: it is what is tested. Nor have criteria, whose definitions have ranges of their
    own, and the definitions of measures.
    """
    numbers = []
    sections = "vehicle", "initial_speed", "brake", "until", "drag", "rail", "sanders", "rig", "coupler"
    for section in sections:
        for key, quantity in quantities_in(getattr(scenario, section), (section,)):
            if quantity.range is not None and _is_used(scenario, key):
                sources = _sources_at(scenario, key)
                stated = sources.get(quantity.range[0].source)
                reason = _REASONS[quantity.prior] if stated is None else stated.text
                numbers.append(RangedNumber(dotted(key), quantity, mark_of(quantity, sources), reason))
    return numbers


def numbers_without_range(scenario: Scenario) -> list[str]:
    """Return the key of the friction of the rail, and of further equipment's numbers, if without a range.

    A scenario writes them itself, and no part of the library with a reason why a number has none. Friction
    scatters from test to test: where nobody says how much, it is the same in every draw.
    """
    rail = scenario.rail
    of_rail = (("rail", "condition", "friction"), rail.condition.friction)
    place, friction = of_rail if rail.friction is None else (("rail", "friction"), rail.friction)
    frictions = [each for key, each in quantities_in(friction, place) if key[-1] == "friction"]
    varied = any(each.range is not None for each in frictions)
    equipment = (("brake", "dynamic"), scenario.brake.dynamic), (("brake", "track"), scenario.brake.track)
    others = (("sanders",), scenario.sanders), (("coupler",), scenario.coupler)
    unranged = [
        dotted(key)
        for section, value in (*equipment, *others)
        for key, quantity in quantities_in(value, section)
        if quantity.range is None
    ]
    return unranged if varied else [dotted(place), *unranged]


def _sources_at(scenario: Scenario, key: Key) -> Mapping[str, Source]:
    found: Any = scenario
    sources: Mapping[str, Source] = {}
    for element in key:
        inside: Any = found if isinstance(found, tuple | dict) else vars(found)
        found = inside[element]
        sources = found.sources if isinstance(found, Part) else sources
    return sources


def _is_used(scenario: Scenario, key: Key) -> bool:
    """Return whether a stop depends on the number of a part, which the scenario may replace or leave out."""
    match key:
        case ("rail", "condition", ("friction" | "cleaning" | "variation") as name, *_):
            return getattr(scenario.rail, name) is None
        case ("rail", "sand", *_):
            return bool(scenario.sanders)
        case ("brake", "system", "positions", position, *_):
            return any(position == used for _, _, used in scenario.brake.commands)
        case ("brake", "system", "disc", "thermal", *_):
            return scenario.brake.models_disc_temperature
    return True

"""Numbers of a scenario that nobody measured for this train, with their plausible ranges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

from uictest.plans.scenario import Scenario, mark_of
from uictest.plans.scenario.yaml import (
    Key,
    Part,
    Prior,
    Quantity,
    Source,
    dotted,
    parse_decimal_quantity,
    quantities_in,
)
from uictest.plans.sweeps.column import Column, ParameterValue, drawn_column, kind_of, listed_column

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_REASONS: Final[Mapping[Prior, str]] = {
    "uniform": "No value in the range is preferred",
    "log-uniform": "The order of magnitude is known: half and twice a value are as likely",
}
"""Why a number has its prior where no source says so: it stands in a scenario."""


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

        drawn = self._drawn(np.where(np.isnan(places), 0.5, places))
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

    def _drawn(self, places: NDArray[np.float64]) -> Column:
        return drawn_column(self._numbers_at(places), self._unit, kind_of(self.value, self._unit))

    def _numbers_at(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the numbers at places of the range, in the unit that the file has."""
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
    """Return the sources of the part that a number stands in; none for one of the scenario itself."""
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

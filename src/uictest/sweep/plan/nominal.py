"""Compare the scenario's own value of a drawn parameter with the range that it is drawn from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from uictest.scenario.yaml import Quantity, parse_quantity
from uictest.sweep.plan.plan import ParameterDraw, Plan, saltelli_sample
from uictest.sweep.plan.scenario_values import value_at


@dataclass(frozen=True, slots=True)
class DrawnRange:
    """The bounds of a distribution, as written, and the value of the scenario itself."""

    key: str
    low: Quantity
    high: Quantity
    nominal: Quantity

    @property
    def contains_nominal(self) -> bool:
        """Whether the scenario's own value can be drawn."""
        return self.low <= self.nominal <= self.high

    def __str__(self) -> str:
        """Return one sentence."""
        lies = "lies inside" if self.contains_nominal else "lies OUTSIDE"
        return (
            f"{self.key}: the scenario's own {self.nominal.text} {lies} the range"
            f" {_shown(self.low)} .. {_shown(self.high)}"
        )


def drawn_ranges(plan: Plan) -> Iterator[DrawnRange]:
    """Yield the ranges of a sample for sensitivities; a choice from a list has none."""
    sample = saltelli_sample(plan)
    for key, draw in zip(sample.keys, sample.draws, strict=True) if sample else ():
        nominal = value_at(plan.base.scenario, key)
        if not draw.choices and isinstance(nominal, Quantity):
            yield DrawnRange(key, *_bounds(draw), nominal)


def _shown(quantity: Quantity) -> str:
    number, _, unit = quantity.text.partition(" ")
    return f"{float(number):g} {unit}".rstrip()


def _bounds(draw: ParameterDraw) -> tuple[Quantity, Quantity]:
    low, high = (parse_quantity(str(bound), draw.kind) for bound in draw.distribution.bounds)
    return low, high

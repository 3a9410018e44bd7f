"""Where the scenario's own value of a drawn parameter lies in the range that it is drawn from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from uictest.scenario.yaml import Quantity, parse_quantity
from uictest.sweep.plan.axes import ends_of
from uictest.sweep.plan.plan import Draw, Plan, saltelli_sample
from uictest.sweep.plan.variation import value_at


@dataclass(frozen=True, slots=True)
class DrawnRange:
    """The ends of a distribution, as written, and the value that the scenario has without the sweep."""

    key: str
    low: Quantity
    high: Quantity
    nominal: Quantity

    @property
    def contains_nominal(self) -> bool:
        """Whether the scenario's own value can be drawn."""
        return self.low <= self.nominal <= self.high

    def __str__(self) -> str:
        """Return a sentence for people."""
        lies = "lies inside" if self.contains_nominal else "lies OUTSIDE"
        return (
            f"{self.key}: the scenario's own {self.nominal.text} {lies} the range"
            f" {_shown(self.low)} .. {_shown(self.high)}"
        )


def drawn_ranges(plan: Plan) -> Iterator[DrawnRange]:
    """Yield the ranges of a sample for sensitivities; values that are chosen from a list have none."""
    sample = saltelli_sample(plan)
    for key, draw in zip(sample.keys, sample.draws, strict=True) if sample else ():
        nominal = value_at(plan.base.scenario, key)
        if not draw.choices and isinstance(nominal, Quantity):
            yield DrawnRange(key, *_ends(draw), nominal)


def _shown(quantity: Quantity) -> str:
    number, _, unit = quantity.text.partition(" ")
    return f"{float(number):g} {unit}".rstrip()


def _ends(draw: Draw) -> tuple[Quantity, Quantity]:
    low, high = (parse_quantity(str(end), draw.kind) for end in ends_of(draw.distribution))
    return low, high

"""Which cases of a sweep are meant, and how they are cut into parts."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.campaign import parse
from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.simulating import Device

_SMALLEST: Final = 16
_CUTS: Final[dict[str, tuple[int, int]]] = {"cpu": (256, 32), "cuda": (65_536, 8)}
"""Most cases in a part and parts wanted, by device: a GPU is busy only with many cases at once."""
_AT_ONCE: Final = 4096


@dataclass(frozen=True)
class Selection:
    """The selected cases of a plan in order; `chosen` is None where all are."""

    plan: Plan
    chosen: NDArray[np.int64] | None = None
    device: Device = "cpu"

    @property
    def size(self) -> int:
        """How many cases."""
        return self.plan.size if self.chosen is None else int(self.chosen.size)

    @property
    def part_size(self) -> int:
        """Cases in a part: about a second of work, and the same on every machine."""
        largest, parts = _CUTS[self.device]
        return min(largest, max(_SMALLEST, self.size // parts))

    @property
    def parts(self) -> int:
        """How many parts."""
        return -(-self.size // self.part_size)

    def part(self, number: int) -> NDArray[np.int64]:
        """Return the indices of the cases in a part."""
        first = number * self.part_size
        return self.stretch(first, min(first + self.part_size, self.size))

    def stretch(self, first: int, end: int) -> NDArray[np.int64]:
        """Return the indices of the cases from place `first` to before place `end`."""
        return np.arange(first, end) if self.chosen is None else self.chosen[first:end]


def select(plan: Plan, expression: str | None, device: Device = "cpu") -> Selection:
    """Return the cases whose id, sweep file or tag an expression holds for. Raises ExpressionError."""
    if expression is None:
        return Selection(plan, device=device)
    holds = parse(expression)
    about = [name.casefold() for name in (PurePath(plan.file).name, *plan.base.scenario.tags)]
    chosen: list[NDArray[np.int64]] = []
    for first in range(0, plan.size, _AT_ONCE):
        indices = np.arange(first, min(first + _AT_ONCE, plan.size))
        names = [name.casefold() for name in plan.ids(indices)]
        kept = [
            holds(lambda word, name=name: any(word.casefold() in each for each in (name, *about)))  # type: ignore[misc]
            for name in names
        ]
        chosen.append(indices[np.array(kept)])
    return Selection(plan, np.concatenate(chosen), device)

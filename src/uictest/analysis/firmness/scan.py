"""Where a verdict turns between the nominal value of a number and an end of its range."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

_POINTS: Final = 8
"""Places of a first scan; chosen."""


@dataclass(frozen=True, slots=True)
class Scan:
    """The share of seeds under which a verdict stands, at places from the nominal value to an end."""

    standing: dict[float, float]
    end: float

    def grid(self) -> list[float]:
        """Return evenly spaced places up to the end, without the nominal one."""
        [start] = self.standing
        points: list[float] = np.linspace(start, self.end, _POINTS + 1)[1:].tolist()
        return points

    @property
    def _from_nominal(self) -> list[float]:
        return sorted(self.standing, reverse=self.end == 0.0)

    @property
    def _change(self) -> tuple[float, float] | None:
        """The neighbouring places between which most seeds turn; None without a single such change."""
        changes = [
            (one, other)
            for one, other in pairwise(self._from_nominal)
            if (self.standing[one] > 0.5) != (self.standing[other] > 0.5)
        ]
        return changes[0] if len(changes) == 1 else None

    @property
    def middle(self) -> float | None:
        """The middle of that change."""
        return None if self._change is None else 0.5 * sum(self._change)

    @property
    def turning_value(self) -> float | None:
        """The first place at which the verdict is turned under most seeds; None without a single change."""
        return None if self._change is None else self._change[1]

    @property
    def values(self) -> tuple[float | None, float, float | None]:
        """The turning value; the last place at which all seeds stand; the first from which on none does."""
        places = self._from_nominal
        unsettled = next((k for k, each in enumerate(places) if self.standing[each] < 1.0), len(places))
        standing = max((k for k, each in enumerate(places) if self.standing[each] > 0.0), default=-1)
        none_stands = places[standing + 1] if standing + 1 < len(places) else None
        return self.turning_value, places[max(unsettled - 1, 0)], none_stands

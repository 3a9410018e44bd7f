"""A public source, the numbers of it that are compared, and what the comparison says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev
from typing import Literal

from studies.stop_runner import StopRunner

Kind = Literal["measured", "tabulated", "computed", "second-hand"]
"""What a source is: a measurement, a design table, another theory computed here, or an abstract alone."""
Result = Literal["holds", "misses"]

TOLERANCE = 5.0
"""Largest difference that holds, %: chosen, the same for all sources."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """A number of the source beside ours, both in the same unit.

    Args:
        quantity: what it is.
        unit: its unit; empty for a pure number.
        source: the source's number, or the least and the greatest that it states.
        here: ours; None where nothing of the kind is modelled.
        fitted: whether something was set so that ours comes near; else it is predicted.
        digits: digits shown behind the decimal point.
    """

    quantity: str
    unit: str
    source: float | tuple[float, float]
    here: float | None
    fitted: bool = False
    digits: int = 0

    @property
    def difference(self) -> float | None:
        """Difference in % of the source's number, of a range in % of the end that is passed."""
        if self.here is None:
            return None
        low, high = self.source if isinstance(self.source, tuple) else (self.source, self.source)
        nearest = min(max(self.here, low), high)
        return (self.here / nearest - 1.0) * 100.0

    @property
    def result(self) -> Result:
        """`holds` if ours lies in the range or near the number; what is not modelled misses."""
        allowed = 0.0 if isinstance(self.source, tuple) else TOLERANCE
        return "holds" if self.difference is not None and abs(self.difference) <= allowed else "misses"


@dataclass(frozen=True, slots=True)
class Agreement:
    """Bias (mean), spread (standard deviation) and worst of the differences of some comparisons, all in %.

    Args:
        count: number of comparisons.
        missed: number of those that miss.
        bias, spread: None where a source states ranges, which have no mean difference.
        worst: the comparison that differs most; None where there is no difference at all.
    """

    count: int
    missed: int
    bias: float | None
    spread: float | None
    worst: Comparison | None


def agreement(comparisons: Sequence[Comparison]) -> Agreement:
    """Return how comparisons agree; those that are not modelled count as missed and have no difference."""
    known = [(each.difference, each) for each in comparisons if each.difference is not None]
    differences = [difference for difference, _ in known]
    ranges = any(isinstance(each.source, tuple) for each in comparisons)
    return Agreement(
        count=len(comparisons),
        missed=sum(each.result == "misses" for each in comparisons),
        bias=fmean(differences) if known and not ranges else None,
        spread=stdev(differences) if len(known) > 1 and not ranges else None,
        worst=max(known, key=lambda each: abs(each[0]))[1] if known else None,
    )


@dataclass(frozen=True, slots=True)
class Findings:
    """The comparisons with a source, and sentences on them."""

    comparisons: Sequence[Comparison]
    notes: Sequence[str] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """A public source.

    Args:
        name: of its page.
        title: one line for people.
        place: publication and place.
        kind: what it is.
        fitted: what was set by it, in words.
        shows: what one may conclude.
        does_not_show: what one may not.
        run: function that compares.
    """

    name: str
    title: str
    place: str
    kind: Kind
    fitted: str
    shows: str
    does_not_show: str
    run: Callable[[StopRunner], Findings]


@dataclass(frozen=True, slots=True)
class Validation:
    """A source and what the comparison with it found."""

    source: Source
    findings: Findings

    @property
    def predicted(self) -> Agreement:
        """Agreement of what nothing was fitted to."""
        return agreement([each for each in self.findings.comparisons if not each.fitted])

    @property
    def fitted(self) -> int:
        """Number of comparisons that something was fitted to."""
        return sum(each.fitted for each in self.findings.comparisons)

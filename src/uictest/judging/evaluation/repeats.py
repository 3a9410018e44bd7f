"""The stops of a case that repeats its stop under further seeds, and what they come to."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from statistics import median, quantiles
from typing import Annotated, Any, Final, Literal

from pydantic import Field, SerializerFunctionWrapHandler, WrapSerializer

from uictest.core import statistics as proportions
from uictest.judging.evaluation.json_values import (
    BuiltWhenUsed,
    CaseMeasures,
    CaseWheelsetMeasures,
    OptionalNumber,
    Outcome,
    absent_if_empty,
    ignored,
    json_form,
    required,
)
from uictest.judging.evaluation.outcome import WrittenRailValidity, decided_by, is_expected
from uictest.judging.evaluation.verdict import Verdict, WrittenVerdict
from uictest.plans.scenario import Expectation

Rule = Literal["all", "median", "at_least"]
"""What the outcome of a repeated case is: that of all its stops, that at the median of each value, or that of
a share of its stops."""


@dataclass(frozen=True, slots=True)
class RepeatedStop:
    """One stop of a repeated case: how it came out under its seed, and its measures as those of a case.

    Verdicts are without definitions. `measures` is None and `wheelsets` empty when the simulation failed.
    """

    seed: int
    outcome: Outcome
    reason: str = ""
    criteria: tuple[WrittenVerdict, ...] = ()
    measures: CaseMeasures | None = None
    wheelsets: tuple[CaseWheelsetMeasures, ...] = ()
    rail: WrittenRailValidity | None = None

    @property
    def decided(self) -> tuple[Verdict, ...]:
        """The verdicts that decide the outcome, see :func:`decided_by`."""
        return decided_by(self.criteria, self.rail)

    def verdict(self, criterion: str) -> Verdict | None:
        """Return the verdict of a criterion on this stop; None where there is none."""
        return next((verdict for verdict in self.criteria if verdict.id == criterion), None)

    def as_expected(self, expect: Expectation) -> bool:
        """Return whether the stop came out as expected."""
        return is_expected(self.outcome, self.decided, expect)


_WrittenStop = Annotated[RepeatedStop, required("criteria", "measures", "wheelsets"), absent_if_empty("rail")]


@dataclass(frozen=True, slots=True)
class Spread:
    """Median and spread of the values that stops have: lowest, quartiles and highest; `count` values."""

    count: int
    lowest: float
    lower_quartile: float
    median: float
    upper_quartile: float
    highest: float


@dataclass(frozen=True, slots=True)
class Repeats:
    """The stops of a repeated case in the order of their seeds, and the rule for the outcome of the case.

    `required_share` is the least share of stops that the rule `at_least` asks for, from 0 to 1; None for
    another rule.
    """

    rule: Rule
    stops: Annotated[tuple[_WrittenStop, ...], Field(min_length=1)]
    required_share: OptionalNumber = None

    @property
    def passed(self) -> int:
        """The number of stops that came out as `pass`."""
        return sum(stop.outcome == "pass" for stop in self.stops)

    @property
    def needed(self) -> int | None:
        """How many stops must come out as expected; None where the verdicts at the median decide."""
        return None if self.rule == "median" else stops_needed(self.required_share, len(self.stops))

    @property
    def none_judged(self) -> bool:
        """Whether every stop was skipped: then there is no share of stops that pass."""
        return all(stop.outcome == "skipped" for stop in self.stops)

    @property
    def share(self) -> float:
        """The share of stops that came out as `pass`; NaN where none was judged."""
        return math.nan if self.none_judged else self.passed / len(self.stops)

    @property
    def interval(self) -> tuple[float, float]:
        """The interval of that share with a confidence of 95 %; NaN where none was judged."""
        if self.none_judged:
            return math.nan, math.nan
        return proportions.proportion_interval(self.passed, len(self.stops))

    @property
    def turns(self) -> bool:
        """Whether the stops did not all come out alike."""
        return len({stop.outcome for stop in self.stops}) > 1

    def as_expected(self, expect: Expectation) -> int:
        """Return the number of stops that came out as expected."""
        return sum(stop.as_expected(expect) for stop in self.stops)

    def seeds(self, outcome: Outcome) -> list[int]:
        """Return the seeds of the stops with this outcome."""
        return [stop.seed for stop in self.stops if stop.outcome == outcome]

    def values(self, measure: str, wheelset: int | None = None) -> list[float]:
        """Return a measure of each stop, or of one of its wheelsets (1 leads), in the order of the seeds.

        Stops that ended in an error are left out.
        """
        if wheelset is not None:
            return [stop.wheelsets[wheelset - 1][measure] for stop in self.stops if stop.wheelsets]
        return [stop.measures[measure] for stop in self.stops if stop.measures is not None]


_SEEDS_LISTED: Final = 6
"""Seeds, or ranges of them, that a reason names at most; chosen."""


def seeds_text(seeds: Sequence[int]) -> str:
    """Return rising seeds for a reader, e.g. `seed 3`, `seeds 0, 2, 4..9`; of many the first ones."""
    ranges = list(_consecutive_ranges(seeds))
    listed = ", ".join(_range_text(*seed_range) for seed_range in ranges[:_SEEDS_LISTED])
    not_listed = sum(last - first + 1 for first, last in ranges[_SEEDS_LISTED:])
    named = f"seed {listed}" if len(seeds) == 1 else f"seeds {listed}"
    return f"{named} and {not_listed} more" if not_listed else named


def _consecutive_ranges(seeds: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last seed of each range of consecutive seeds."""
    for _, neighbours in groupby(enumerate(seeds), lambda pair: pair[1] - pair[0]):
        consecutive = [seed for _, seed in neighbours]
        yield consecutive[0], consecutive[-1]


def _range_text(first: int, last: int) -> str:
    if last - first > 1:
        return f"{first}..{last}"
    return str(first) if first == last else f"{first}, {last}"


def stops_needed(share: float | None, stops: int) -> int:
    """Return the least number of stops that makes up a share of `stops`; None: all of them."""
    # Not 10 of 10 stops where 0.9 times 10 is a little above 9 in binary.
    return math.ceil((1.0 if share is None else share) * stops - 1e-9)


def spread_of(values: Iterable[float]) -> Spread | None:
    """Return median and spread of the numbers among values; None where all are NaN.

    Quartiles are those of the values taken as a whole (R's type 7).
    """
    numbers = sorted(value for value in values if value == value)
    if not numbers:
        return None
    if len(numbers) == 1:
        return Spread(1, *(numbers * 5))
    quartiles = quantiles(numbers, n=4, method="inclusive")
    return Spread(len(numbers), numbers[0], quartiles[0], median(numbers), quartiles[2], numbers[-1])


def column_medians(rows: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Return the median of each column over rows: over those that have a number there, NaN where none has."""
    columns = {name: spread_of(row[name] for row in rows) for name in (rows[0] if rows else {})}
    return {name: float("nan") if spread is None else spread.median for name, spread in columns.items()}


def _with_derived(repeats: Repeats, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form: dict[str, Any] = write(repeats)
    stops = form.pop("stops")
    share = {} if repeats.required_share is None else {"required_share": form["required_share"]}
    derived = {"passed": repeats.passed, "share": repeats.share, "interval": repeats.interval}
    return {"rule": repeats.rule, **share, **json_form(derived), "stops": stops}


WrittenRepeats = Annotated[
    Repeats,
    BuiltWhenUsed(Annotated[Repeats, WrapSerializer(_with_derived), ignored("passed", "share", "interval")]),
]
"""In JSON the number of stops that passed, their share and its interval precede the stops, for readers
that need no more."""

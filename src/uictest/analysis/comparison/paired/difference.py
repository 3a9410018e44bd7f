"""The difference of two variants, stop by stop under the same noise."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Final

from uictest.analysis.comparison.paired.drawn_stops import Draw, Figures, quantity_unit
from uictest.core.series_measures import Estimate, mean_of, median_of
from uictest.judging import evaluation

CONFIDENCE: Final = 0.95
"""Confidence of every interval."""

FEWEST_PAIRS: Final = 2
"""Pairs without which there is no interval of a mean."""

Stops = Mapping[Draw, Figures]


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """By how much a quantity of the second variant exceeds that of the first, over pairs of stops.

    Args:
        quantity: a column of stops, or `largest_` and a column of wheelsets.
        unit: of all numbers.
        first, second: medians of both sides over the pairs.
        mean: of the differences, with its interval by Student's t.
        median: of the differences, with its interval by order statistics.
        larger, smaller: pairs in which the second is larger, or smaller.
        missing: pairs left out because one stop has no such number.

    """

    quantity: str
    unit: str
    first: float
    second: float
    mean: Estimate
    median: Estimate
    larger: int
    smaller: int
    missing: int

    @property
    def pairs(self) -> int:
        """The number of pairs."""
        return self.mean.stops

    @property
    def is_zero(self) -> bool:
        """Whether both sides are the same in every pair."""
        return self.larger == self.smaller == 0


@dataclass(frozen=True, slots=True)
class PairedGroup:
    """The pairs of one case, or of the stops of a series from one speed.

    `draws` counts the draws of noise: fewer than `pairs` where stops under other conditions met the same one.
    Stops on random rails meet the same one under the same seed, whatever else differs.
    `unpaired` counts the stops of the first and of the second side without a partner.
    """

    name: str
    seeds: tuple[int, ...]
    pairs: int
    draws: int
    unpaired: tuple[int, int]
    differences: tuple[PairedDifference, ...]


def paired_group(name: str, first: Stops, second: Stops) -> PairedGroup:
    """Return the differences of all stops that pair. Raises ValueError, with the reason, where too few do."""
    common = [draw for draw in first if draw in second and draw.noise_key and draw.seed is not None]
    if len(common) < FEWEST_PAIRS:
        raise ValueError(_why_too_few(first, second, len(common)))
    random_rail = any(draw.random_rail for draw in (*first, *second))
    return PairedGroup(
        name,
        tuple(sorted({draw.seed for draw in common if draw.seed is not None})),
        len(common),
        len({draw.seed if random_rail else (draw.noise_key, draw.seed) for draw in common}),
        (len(first) - len(common), len(second) - len(common)),
        tuple(_differences([(first[draw], second[draw]) for draw in common])),
    )


def _differences(pairs: Sequence[tuple[Figures, Figures]]) -> Iterator[PairedDifference]:
    for quantity in pairs[0][0]:
        values = [(one[quantity], other.get(quantity, math.nan)) for one, other in pairs]
        known = [pair for pair in values if all(map(math.isfinite, pair))]
        if len(known) >= FEWEST_PAIRS:
            yield _difference(quantity, known, len(values) - len(known))


def _difference(quantity: str, values: Sequence[tuple[float, float]], missing: int) -> PairedDifference:
    differences = [second - first for first, second in values]
    first, second = (median(side) for side in zip(*values, strict=True))
    return PairedDifference(
        quantity,
        quantity_unit(quantity),
        first,
        second,
        _mean(differences),
        median_of(differences, CONFIDENCE),
        sum(each > 0.0 for each in differences),
        sum(each < 0.0 for each in differences),
        missing,
    )


def _mean(differences: Sequence[float]) -> Estimate:
    """Return the mean of differences, without an interval where all are alike: t would feign certainty."""
    mean = mean_of(differences, CONFIDENCE)
    if mean.smallest < mean.largest:
        return mean
    return dataclasses.replace(mean, low=math.nan, high=math.nan)


def _why_too_few(first: Stops, second: Stops, common: int) -> str:
    for side, stops in (("first", first), ("second", second)):
        if not stops:
            return f"no stop of the {side} side has measures"
        if not any(draw.noise_key for draw in stops):
            return f"the noise of the {side} side is not known: its stops are recorded"
    met = ({(draw.conditions, draw.noise_key) for draw in stops} for stops in (first, second))
    if not set.intersection(*met):
        return (
            "the stops met other noise: initial speed, pressure, wheel load, a wheelset's radius, brake force"
            " or pads, or the friction of the rail differ"
        )
    seeds = [_seeds_text(stops) for stops in (first, second)]
    if not common:
        return f"no seed is on both sides: {seeds[0]}; {seeds[1]}"
    return f"{common} pair, {FEWEST_PAIRS} are needed: {seeds[0]}; {seeds[1]}"


def _seeds_text(stops: Stops) -> str:
    seeds = {draw.seed for draw in stops if draw.seed is not None}
    return evaluation.seeds_text(sorted(seeds)) if seeds else "no known seed"

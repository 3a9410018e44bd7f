"""Stops under the same noise on two sides: their groups, paired differences, and the variants of a run."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from statistics import fmean
from typing import Any, Final, Literal, NamedTuple

from uictest.analysis.comparison.tolerance import Tolerances
from uictest.core.measures import column_unit, measure_of_column
from uictest.core.series_measures import Estimate, mean_of, median_of
from uictest.judging import evaluation
from uictest.judging.evaluation import CaseResult, RepeatedStop, json_form
from uictest.judging.series import SeriesResult, SpeedResult
from uictest.plans.scenario.yaml import nearest
from uictest.report import RunContent, measure_heading

LARGEST: Final = "largest_"
"""Before the name of a column of wheelsets: its largest value of the four."""

_BALANCES: Final = frozenset({"energy_residual", "air_residual", "air_energy_residual"})
"""Columns that check the simulation and say nothing of the stop."""

_SPREADS: Final = ("rail.variation.spread", "rail.condition.variation.spread")
"""Keys of the spread of a random rail; the first replaces the second."""

Figures = Mapping[str, float]
"""Quantities of one stop -> number in the unit of the column, NaN where there is none."""


@dataclass(frozen=True, slots=True)
class Draw:
    """What two stops must share to be a pair.

    `conditions` tells the stops of a series apart; it is empty for the stops of one case. `noise_key` is
    empty where it is not known. `random_rail` says whether friction varies at random, by the seed alone.
    """

    conditions: str
    noise_key: str
    seed: int | None
    random_rail: bool = field(default=False, compare=False)


def drawn_stops(case: evaluation.CaseResult, conditions: str = "") -> Iterator[tuple[Draw, Figures]]:
    """Yield the stops of a case that have measures: a case without repeats is one stop."""
    random_rail = _has_random_rail(case)
    stops: Sequence[CaseResult | RepeatedStop] = [case] if case.repeats is None else case.repeats.stops
    for stop in stops:
        if stop.measures is not None:
            seed = _seed_of(stop) if isinstance(stop, CaseResult) else stop.seed
            figures = _figures(stop.measures, stop.wheelsets)
            yield Draw(conditions, case.noise_key, seed, random_rail), figures


def _has_random_rail(case: evaluation.CaseResult) -> bool:
    spreads = {
        each.key: each.value
        for part in case.parts.values()
        for each in part.parameters
        if each.key in _SPREADS
    }
    return next((bool(spreads[key]) for key in _SPREADS if key in spreads), False)


def quantity_unit(quantity: str) -> str:
    """Return the unit of a quantity of stops."""
    return column_unit(quantity.removeprefix(LARGEST))


def _seed_of(case: evaluation.CaseResult) -> int | None:
    """Return the seed of a case with one stop; None where its parameters are not known."""
    part = case.parts.get("scenario")
    values = [each.value for each in part.parameters if each.key == "seed"] if part else []
    return int(values[0]) if values else None


def _figures(measures: Mapping[str, float], wheelsets: tuple[Mapping[str, float], ...]) -> Figures:
    of_stop = {name: value for name, value in measures.items() if name not in _BALANCES}
    columns = wheelsets[0] if wheelsets else ()
    return of_stop | {f"{LARGEST}{name}": _largest([each[name] for each in wheelsets]) for name in columns}


def _largest(values: list[float]) -> float:
    return math.nan if any(map(math.isnan, values)) else max(values)


CONFIDENCE: Final = 0.95
"""Confidence of every interval."""

FEWEST_PAIRS: Final = 2
"""Pairs without which there is no interval of a mean."""

Stops = Mapping[Draw, Figures]


Standing = Literal["better", "worse", "different", "no difference shown", "not comparable"]
"""How the second side stands against the first; `different` by a measure of which neither way is better."""

SINGLE_STOP: Final = 0.01
"""Share by which numbers of single stops must differ, chosen: stops under other seeds scatter by less."""


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """By how much a quantity of the second variant exceeds that of the first, over pairs of stops.

    Args:
        quantity: a column of stops, or `largest_` and a column of wheelsets.
        unit: unit of all numbers.
        first, second: means of both sides over the pairs.
        mean: mean of the differences, with its interval by Student's t; a single pair has none.
        median: median of the differences, with its interval by order statistics.
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

    @property
    def title(self) -> str:
        """The quantity in words."""
        column = self.quantity.removeprefix(LARGEST)
        heading = measure_heading(column).words
        return f"{heading}, largest of wheelsets" if column != self.quantity else heading

    def standing(self, tolerances: Tolerances) -> Standing:
        """Return how the second side stands by the direction of the measure.

        A difference is shown where it exceeds its tolerance and its interval leaves out 0; of single stops,
        where it exceeds `SINGLE_STOP`, too.
        """
        column, difference = self.quantity.removeprefix(LARGEST), self.mean
        measure = measure_of_column(column, of_wheelsets=column != self.quantity)
        extent = max(abs(self.first), abs(self.second))
        allowed = tolerances.of(column).allowed(extent)
        if self.pairs < FEWEST_PAIRS:
            allowed = max(allowed, SINGLE_STOP * extent)
        is_shown = abs(difference.value) > allowed and not difference.low <= 0.0 <= difference.high
        if not is_shown:
            return "no difference shown"
        if measure is None or measure.better == "neither":
            return "different"
        return "better" if (measure.better == "larger") == (difference.value > 0.0) else "worse"


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
    """Return the differences of all stops that pair. Raises ValueError, with the reason, where too few do.

    Two stops that are all there is are compared whatever noise they met.
    """
    if len(first) == len(second) == 1:
        (one,), (other,) = first.values(), second.values()
        return PairedGroup(name, (), 1, 1, (0, 0), tuple(_paired_differences([(one, other)])))
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
        tuple(_paired_differences([(first[draw], second[draw]) for draw in common])),
    )


def _paired_differences(pairs: Sequence[tuple[Figures, Figures]]) -> Iterator[PairedDifference]:
    for quantity in pairs[0][0]:
        values = [(first[quantity], second.get(quantity, math.nan)) for first, second in pairs]
        finite_pairs = [pair for pair in values if all(map(math.isfinite, pair))]
        if len(finite_pairs) >= min(FEWEST_PAIRS, len(pairs)):
            yield _paired_difference(quantity, finite_pairs, len(values) - len(finite_pairs))


def _paired_difference(
    quantity: str, values: Sequence[tuple[float, float]], missing: int
) -> PairedDifference:
    differences = [second - first for first, second in values]
    first, second = (fmean(side) for side in zip(*values, strict=True))
    mean = mean_of(differences, CONFIDENCE)
    return PairedDifference(
        quantity,
        quantity_unit(quantity),
        first,
        second,
        # Student's t of differences that are all alike would feign certainty.
        mean if mean.smallest < mean.largest else dataclasses.replace(mean, low=math.nan, high=math.nan),
        median_of(differences, CONFIDENCE),
        sum(each > 0.0 for each in differences),
        sum(each < 0.0 for each in differences),
        missing,
    )


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


class GroupKey(NamedTuple):
    """What the stops of one group have in common; `speed_kmh` is None for cases, `rail` as in a series."""

    name: str
    parameters: frozenset[tuple[str, str]]
    speed_kmh: float | None = None
    rail: str = ""


@dataclass(frozen=True, slots=True)
class Group:
    """The stops of a group; `name` is for readers.

    `cases` are those that the stops are of, by their seed where a matrix varies it; `series` is their series.
    `example` is one of the cases with the parameters alone that the whole group has.
    """

    name: str
    stops: dict[Draw, Figures] = field(default_factory=dict)
    cases: dict[str, CaseResult] = field(default_factory=dict)
    series: SeriesResult | None = None
    example: CaseResult | None = None


def groups_of(side: RunContent, varied: Collection[str]) -> dict[GroupKey, Group]:
    """Return the groups of a side; `varied` are the keys in which the variants differ.

    Cases that differ in nothing but these and their seed are one group, and so are the wet stops of a series
    from one speed that count.
    """
    groups: dict[GroupKey, Group] = {}
    for case in side.results:
        key = _group_key(case, {*varied, "seed"})
        shared = {name: value for name, value in case.parameters.items() if (name, value) in key.parameters}
        example = dataclasses.replace(case, parameters=shared)
        group = groups.setdefault(key, Group(_group_name(case, key), example=example))
        group.stops.update(drawn_stops(case))
        group.cases[case.parameters.get("seed", "")] = case
    for series in side.series:
        key = _group_key(series, varied)
        for speed in series.speeds:
            name = f"{_group_name(series, key)}, wet stops from {speed.place}"
            speed_key = key._replace(speed_kmh=speed.speed_kmh, rail=speed.rail)
            groups[speed_key] = Group(name, _wet_stops(series, speed), series=series)
    return groups


def _wet_stops(series: SeriesResult, speed: SpeedResult) -> dict[Draw, Figures]:
    """Return the wet stops from a speed, and on its rail, that count."""
    not_counted = {(stop.case, stop.seed) for stop in series.not_counted}
    return {
        draw: figures
        for each in series.cases
        if (each.role, each.speed_kmh) == ("wet", speed.speed_kmh) and speed.rail in ("", each.rail)
        for draw, figures in drawn_stops(each.case, each.case.id.removeprefix(f"{series.id}."))
        # A stop that is not repeated stands there without its seed.
        if not_counted.isdisjoint({(each.case.id, draw.seed), (each.case.id, None)})
    }


def _group_key(item: CaseResult | SeriesResult, left_out: Collection[str]) -> GroupKey:
    parameters = ((key, value) for key, value in item.parameters.items() if key not in left_out)
    return GroupKey(item.id.partition("[")[0], frozenset(parameters))


def _group_name(item: CaseResult | SeriesResult, key: GroupKey) -> str:
    """Return the id with the values alone that the whole group has."""
    shared_values = [
        f"{name}={value}" for name, value in item.parameters.items() if (name, value) in key.parameters
    ]
    return f"{key.name}[{','.join(shared_values)}]" if shared_values else key.name


@dataclass(frozen=True, slots=True)
class NotPaired:
    """A group whose stops do not pair, and why."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True)
class PairedComparison:
    """All paired differences of the second side from the first."""

    first: str
    second: str
    groups: tuple[PairedGroup, ...]
    not_paired: tuple[NotPaired, ...] = ()


@dataclass(frozen=True, slots=True)
class MatchedGroup:
    """A group as both sides have it, None where one has none, and its pairs, or why there are none."""

    sides: tuple[Group | None, Group | None]
    pairs: PairedGroup | NotPaired

    @property
    def known(self) -> Group:
        """The group of the first side, else of the second."""
        return next(side for side in self.sides if side is not None)

    @property
    def common_cases(self) -> list[tuple[CaseResult, CaseResult]]:
        """The cases that both sides have, by their seed."""
        first, second = (side.cases if side is not None else {} for side in self.sides)
        return [(first[seed], second[seed]) for seed in first if seed in second]


def match_groups(first: RunContent, second: RunContent, varied: Collection[str] = ()) -> list[MatchedGroup]:
    """Return the groups of both sides, their stops paired by the random seeds common to both.

    `varied` are the keys in which the sides differ.
    """
    ours, theirs = (groups_of(side, varied) for side in (first, second))
    return [
        _matched(ours.get(key), theirs.get(key), first.name, second.name)
        for key in dict.fromkeys([*ours, *theirs])
    ]


def _matched(ours: Group | None, theirs: Group | None, first: str, second: str) -> MatchedGroup:
    pairs: PairedGroup | NotPaired
    if ours is not None and theirs is not None:
        try:
            pairs = paired_group(ours.name, ours.stops, theirs.stops)
        except ValueError as error:
            pairs = NotPaired(ours.name, str(error))
    else:
        known, side = (ours, first) if ours is not None else (theirs, second)
        pairs = NotPaired(known.name if known else "", f"only {side} has it")
    return MatchedGroup((ours, theirs), pairs)


def paired_comparison(first: str, second: str, matched: Sequence[MatchedGroup]) -> PairedComparison:
    """Return the pairs of all groups under the names of both sides."""
    pairs = [each.pairs for each in matched]
    return PairedComparison(
        first,
        second,
        tuple(each for each in pairs if isinstance(each, PairedGroup)),
        tuple(each for each in pairs if isinstance(each, NotPaired)),
    )


def paired_form(compared: PairedComparison) -> dict[str, Any]:
    """Return the JSON form; what has no number is null."""
    form: dict[str, Any] = json_form(dataclasses.asdict(compared))
    for group, of_group in zip(compared.groups, form["groups"], strict=True):
        for each, of_difference in zip(group.differences, of_group["differences"], strict=True):
            of_difference["pairs"] = each.pairs
    return form


Variant = tuple[tuple[str, str], ...]
"""Keys and values, as written."""


def variants_of(run: RunContent, keys: Sequence[str]) -> list[RunContent]:
    """Return the variants of a run as runs of their own, as the keys tell them apart.

    Cases and series without any of the keys are left out. Raises ValueError where there are no two variants,
    for a key that none of them has and for one that is given twice.
    """
    parameters: list[Mapping[str, str]] = [case.parameters for case in run.results]
    parameters += [series.parameters for series in run.series]
    known_keys = list(dict.fromkeys(key for of_item in parameters for key in of_item))
    for key in keys:
        if keys.count(key) > 1:
            raise ValueError(f"{key!r} is given {keys.count(key)} times; give every key once")
        if key not in known_keys:
            guess = nearest(key, known_keys)
            hint = f"did you mean {guess!r}? " if guess else ""
            listed = ", ".join(known_keys) or "nothing"
            raise ValueError(f"no case or series has a value of {key!r}; {hint}they differ in: {listed}")
    variants = list(dict.fromkeys(variant for values in parameters if (variant := _variant(values, keys))))
    if len(variants) < 2:
        raise ValueError(f"there is one variant only, {_variant_name(variants[0])}")
    return [
        dataclasses.replace(
            run,
            name=_variant_name(variant),
            results=[case for case in run.results if _variant(case.parameters, keys) == variant],
            series=[series for series in run.series if _variant(series.parameters, keys) == variant],
        )
        for variant in variants
    ]


def _variant(parameters: Mapping[str, str], keys: Sequence[str]) -> Variant:
    return tuple((key, parameters[key]) for key in keys if key in parameters)


def _variant_name(variant: Variant) -> str:
    return ", ".join(f"{key}={value}" for key, value in variant)

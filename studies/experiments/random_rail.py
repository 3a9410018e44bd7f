"""Spread of the braking distance on rails that vary at random, beside a formula and sensor noise."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import fmean, median, stdev
from typing import TYPE_CHECKING, Any

from studies.drawing import BLUE, MUTED, WIDTH
from studies.quantity import NOT_ASKED, OwnBand, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, measured
from studies.study import Study, StudyFindings, Table
from uictest import CaseResult
from uictest.units import PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEEDS = range(192)
SPREAD = 0.2
"""Of friction, over its mean; chosen."""
LENGTHS = (10, 50, 100)
"""Correlation lengths, m; chosen."""
_OF_A_TEST = 12
"""Wet stops of one test of K_wet, as in the shipped series."""
_CLEANING = "{energy: 5300 J/m, recovered_friction: 0.28, reach: 0.5 m, carry_over: 0.5}"
LOCKED = "locked"
RAILS = {
    "slip-120": {"rail.friction": "0.09"},
    "cleaned-rail-120": {"rail.friction": "0.08", "rail.cleaning": _CLEANING},
    LOCKED: {
        "rail.condition": "{extends: wet, friction_ratio: 1}",
        "rail.friction": "0.09",
        "rig.wsp": "bypassed",
    },
}
"""Changes of the slip test: two as they ship, and one whose wheels lock and whose friction does not fall."""
_NO_FIGURE = "no public figure"
_AS_FORMULA = OwnBand(lower=0.8, upper=1.2, reason="ours: 15 % of chance, 5 % of resistance and build-up")


@dataclass(frozen=True, slots=True)
class VariedStops:
    """The stops on one rail, one per seed.

    Attributes:
        rail: name in `RAILS`.
        length: correlation length, m; 0 where the rail does not vary and only the sensors' noise does.
    """

    rail: str
    length: int
    stops: Sequence[CaseResult]

    @property
    def distances(self) -> list[float]:
        """Braking distances, m."""
        return [measured(stop, "braking_distance_m") for stop in self.stops]

    @property
    def spread(self) -> float:
        """Standard deviation of the distance over its mean, %."""
        distances = self.distances
        return stdev(distances) / fmean(distances) / PERCENT


Rails = Mapping[tuple[str, int], VariedStops]
"""By name and correlation length."""


def formula(length: float, distance: float) -> float:
    """Return the spread of the mean friction over a distance, %: to first order that of the distance."""
    share = length / distance
    return SPREAD * math.sqrt(2.0 * share * (1.0 - share * (1.0 - math.exp(-1.0 / share)))) / PERCENT


def _quantities() -> Iterator[StudyQuantity]:
    shown: dict[str, Any] = {"paper": _NO_FIGURE, "status": "predicted"}
    for rail in RAILS:
        yield StudyQuantity(f"{rail}_noise", f"spread of the distance, {rail}, noise alone", "%", **shown)
        for length in LENGTHS:
            title = f"{rail}, {length} m"
            yield StudyQuantity(f"{rail}_{length}", f"spread of the distance, {title}", "%", **shown)
            band = _AS_FORMULA if rail == LOCKED else None
            yield StudyQuantity(
                f"{rail}_{length}_ratio",
                f"the same over that of the formula, {title}",
                "",
                NOT_ASKED,
                status="predicted",
                band=band,
                digits=2,
            )
    for rail in (rail for rail in RAILS if rail != LOCKED):
        for length in (0, *LENGTHS):
            title = f"K_wet of {_OF_A_TEST} stops, {rail}, {_named(length)}"
            yield StudyQuantity(_k_key(rail, length), title, "", **shown, digits=3)


def _named(length: int) -> str:
    return f"{length} m" if length else "noise alone"


def _k_key(rail: str, length: int) -> str:
    return f"{rail}_k_wet_{length}"


def run(stop_runner: StopRunner) -> StudyFindings:
    """Stop on every rail under every seed."""
    (dry,) = stop_runner.repeated(stop_runner.cases("dry-120", {"rig.compensation": "thermal"}), [0])
    dry_distance = measured(dry.stops[0], "braking_distance_m")
    rails = varied_stops(stop_runner)
    return StudyFindings(
        dict(_values(rails, dry_distance)),
        tables={"stops": _stop_table(rails), "verdicts": _verdict_table(rails)},
        drawings={"random-rail": partial(draw, list(rails.values()))},
        notes=tuple(_notes(rails)),
    )


def varied_stops(stop_runner: StopRunner) -> Rails:
    """Return the stops on every rail, with every correlation length and none."""
    cases = {
        (rail, length): stop_runner.cases(
            "slip-120", {"rig.compensation": "thermal", **changes, "rail.variation": _variation(length)}
        )[0]
        for rail, changes in RAILS.items()
        for length in (0, *LENGTHS)
    }
    repeats = stop_runner.repeated(list(cases.values()), SEEDS)
    return {point: VariedStops(*point, of_case.stops) for point, of_case in zip(cases, repeats, strict=True)}


def _variation(length: int) -> str:
    """Return the variation of a rail whose left and right are alike: a wheelset meets the whole spread."""
    varied = f"spread: {SPREAD if length else 0.0:.0%}, correlation_length: {length or 1} m"
    return f"{{{varied}, left_right_correlation: 1}}"


def _values(rails: Rails, dry: float) -> Iterator[tuple[str, StudyValue]]:
    for (rail, length), stops in rails.items():
        key = f"{rail}_{length}" if length else f"{rail}_noise"
        yield key, StudyValue(stops.spread)
        if length:
            expected = formula(length, median(rails[rail, 0].distances))
            yield f"{key}_ratio", StudyValue(stops.spread / expected)
        yield _k_key(rail, length), spread(list(_k_wet(stops.distances, dry)))


def _k_wet(distances: Sequence[float], dry: float) -> Iterator[float]:
    """Yield K of each test: its mean extension over the dry stop, of the braking distance."""
    for first in range(0, len(distances) - _OF_A_TEST + 1, _OF_A_TEST):
        yield dry / fmean(distances[first : first + _OF_A_TEST])


def _notes(rails: Rails) -> Iterator[str]:
    yield (
        f"Each spread is that of {len(SEEDS)} stops. Friction varies by {SPREAD:.0%} (log-normal, left and "
        "right alike); every number of it is chosen, and no public figure of the spread of wet stops exists "
        "to judge any of these values by. On one length of track distances tell spread and correlation "
        "length only together."
    )
    yield (
        "The formula is the spread of the mean friction over the distance. It is an oracle where the WSP is "
        "bypassed and friction does not fall with slip: there friction alone decides. "
        "K_wet: median and range of tests of twelve stops, from braking distances, each over the dry stop."
    )
    for (rail, length), stops in rails.items():
        if length and rail != LOCKED:
            turned = [
                f"{name} {_share(rails[rail, 0], name):.0%} -> {_share(stops, name):.0%}"
                for name in _criteria(stops)
                if _share(rails[rail, 0], name) != _share(stops, name)
            ]
            yield f"Shares that pass on {rail} at {length} m: {', '.join(turned) or 'as with noise alone'}."


def _criteria(stops: VariedStops) -> list[str]:
    return [verdict.id for verdict in stops.stops[0].criteria if verdict.status != "not_applicable"]


def _share(stops: VariedStops, criterion: str, status: str = "pass") -> float:
    found = [verdict.status for stop in stops.stops for verdict in stop.criteria if verdict.id == criterion]
    return sum(each == status for each in found) / len(found)


def _stop_table(rails: Rails) -> Table:
    rows = [(stops, *row) for stops in rails.values() for row in zip(SEEDS, stops.stops, strict=True)]
    return {
        "rail": [stops.rail for stops, *_ in rows],
        "correlation_length_m": [stops.length for stops, *_ in rows],
        "seed": [seed for _, seed, _ in rows],
        "distance_m": [round(measured(stop, "braking_distance_m"), 2) for *_, stop in rows],
        "outcome": [stop.outcome for *_, stop in rows],
    }


def _verdict_table(rails: Rails) -> Table:
    rows = [(stops, criterion) for stops in rails.values() for criterion in _criteria(stops)]
    return {
        "rail": [stops.rail for stops, _ in rows],
        "correlation_length_m": [stops.length for stops, _ in rows],
        "criterion": [criterion for _, criterion in rows],
        "pass_percent": [round(_share(*row) / PERCENT, 1) for row in rows],
        "fail_percent": [round(_share(*row, "fail") / PERCENT, 1) for row in rows],
    }


def draw(rails: Sequence[VariedStops], figure: Figure) -> None:
    """Draw every distance over its rail, with mean and standard deviation."""
    figure.set_size_inches(WIDTH, 2.6)
    names = list(dict.fromkeys(stops.rail for stops in rails))
    panels = figure.subplots(1, len(names), squeeze=False)[0]
    for axes, name in zip(panels, names, strict=True):
        own = [stops for stops in rails if stops.rail == name]
        for place, stops in enumerate(own):
            distances = stops.distances
            across = [place + 0.5 * (k / len(distances) - 0.5) for k in range(len(distances))]
            axes.plot(across, distances, ".", color=MUTED, markersize=2.0)
            axes.errorbar(place, fmean(distances), stdev(distances), color=BLUE, capsize=3.0, marker="o")
        axes.set_xticks(range(len(own)), ["noise", *(str(stops.length) for stops in own[1:])])
        axes.set_xlabel("correlation length, m")
        axes.set_title(name)
    panels[0].set_ylabel("braking distance, m")


STUDY = Study(
    "random-rail",
    "Spread of the distance from 120 km/h on rails that vary at random",
    "",
    tuple(_quantities()),
    run,
    position=115,
)

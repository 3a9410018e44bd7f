"""Both shipped controllers on every shipped rail law, and what a rail keeps from stop to stop."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import TYPE_CHECKING, Any

from studies.drawing import BLUE, GREEN, INK, MUTED, ORANGE, PINK, WIDTH
from studies.quantity import NOT_ASKED, SourceBand, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, measured
from studies.study import Study, StudyFindings, Table
from studies.used_rail import STOPS, Used, used_rail, used_table
from uictest import CaseResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FOUND = "wet"
LAWS = (FOUND, "wet-varied", "wet-cleaning", "wet-curves", "leaf-layer", "leaf-film")
"""Rails of the library; the first keeps its friction, the second one at each place."""
USED = ("wet-cleaning", "wet-curves", "leaf-layer", "leaf-film")
"""Those that sliding cleans."""
CONTROLLERS = ("threshold", "slip-band")
FRICTIONS = (0.04, 0.06, 0.10)
SPEEDS = (60, 100, 140)
"""km/h. No law and no controller was set at any of these frictions and speeds."""
SEEDS = range(8)
"""A condition counts for a controller where all of them agree: chance does that once in 128."""
AFTER = (1, 2, 5)
USED_FRICTION, USED_SPEED = 0.05, 100
"""Of the stops on one rail: the friction is that of `leaf-layer`."""
ULTRA_LOW = 0.05
_LEAVES = "not asked; Lewis et al. (2023): ultra-low (at most 0.05), low over a number of brakings"
_LEAF_BAND = "Lewis et al. 2023, ultra-low as in Buckley-Johnstone et al. 2020"
_LEAF_MISS = (
    "Friction rises in proportion to the worn share of the layer, so that the first tenth that is worn "
    "counts as much as the last; the law of leaf-film counts what is left of it."
)
_SHORTER = "not asked; Allotta et al. (2014): sliding cleans the rail, and stops become shorter"
_LONGER = (
    "On the half-clean rail the first wheelset hardly slides, and so leaves less clean rail to the others "
    "than on a rail as found, where it slides deep."
)


@dataclass(frozen=True, slots=True)
class Condition:
    """A friction and a speed under one law, with both controllers under the same seeds.

    Attributes:
        law: name of the rail.
        friction: as found.
        speed: initial speed, km/h.
        stops: by controller, one per seed.
    """

    law: str
    friction: float
    speed: int
    stops: Mapping[str, Sequence[CaseResult]]

    def ratios(self, measure: str) -> list[float]:
        """Return a measure with slip-band over that with threshold, for every seed."""
        first, second = (
            [measured(stop, measure) for stop in self.stops[controller]] for controller in CONTROLLERS
        )
        return [b / a for a, b in zip(first, second, strict=True)]

    def better(self, measure: str) -> str:
        """Return the controller with less of a measure under every seed; empty where seeds disagree."""
        ratios = self.ratios(measure)
        lower = all(ratio < 1.0 for ratio in ratios)
        return CONTROLLERS[lower] if lower or all(ratio > 1.0 for ratio in ratios) else ""


_FEWER = {"braking_distance_m": "shorter", "air_consumed_nl": "with less air"}


def _quantities() -> Iterator[StudyQuantity]:
    shown: dict[str, Any] = {"paper": NOT_ASKED, "status": "predicted"}
    count = f"of {len(FRICTIONS) * len(SPEEDS)}"
    for law in LAWS:
        for measure, words in _FEWER.items():
            key = _key(law, measure)
            title = f"{key.rpartition('_')[2]}, slip-band over threshold, {law}"
            yield StudyQuantity(f"{key}_ratio", title, "", **shown, digits=2)
            for controller in CONTROLLERS:
                title = f"conditions in which {controller} stops {words}, {law}"
                yield StudyQuantity(f"{key}_{controller}", title, count, **shown, digits=0)
    for law in USED:
        for stops in AFTER:
            title = f"friction that the rail gives after {stops} {'stop' if stops == 1 else 'stops'}, {law}"
            yield StudyQuantity(f"{_word(law)}_friction_{stops}", title, "", **shown, digits=3)
        for controller in CONTROLLERS:
            longer = (law, controller) == ("wet-curves", "slip-band")
            yield StudyQuantity(
                f"{_word(law)}_last_{controller}",
                f"distance of stop {STOPS} over that of stop 1, {law}, {controller}",
                "",
                _SHORTER,
                status="predicted",
                band=SourceBand(
                    upper=1.0,
                    below=True,
                    reason="Allotta et al. 2014, direction",
                    declared_miss=_LONGER if longer else "",
                ),
                digits=2,
            )
    for law, stop in _LEAF_STOPS:
        set_by, misses = stop == 1, law == "leaf-layer" and stop > 1
        yield StudyQuantity(
            f"{_word(law)}_adhesion_{stop}",
            f"mean deceleration of stop {stop}, {law}",
            "g",
            _LEAVES,
            status="by construction" if set_by else "predicted",
            band=SourceBand(upper=ULTRA_LOW, reason=_LEAF_BAND, declared_miss=_LEAF_MISS if misses else ""),
            digits=3,
        )


_LEAF_STOPS = [(law, stop) for law in ("leaf-layer", "leaf-film") for stop in (1, *(n + 1 for n in AFTER))]


def _word(law: str) -> str:
    return law.replace("-", "_")


def _key(law: str, measure: str) -> str:
    return f"{_word(law)}_{'air' if measure == 'air_consumed_nl' else 'distance'}"


def run(stop_runner: StopRunner) -> StudyFindings:
    """Stop under every law with both controllers, and again and again on one rail."""
    conditions = list(_conditions(stop_runner))
    used = {
        (law, controller): [
            used_rail(stop_runner, "slip-120", _changes(law, controller, USED_FRICTION, USED_SPEED), seed)
            for seed in SEEDS
        ]
        for law in USED
        for controller in CONTROLLERS
    }
    return StudyFindings(
        dict(_values(conditions, used)),
        tables={"conditions": _table(conditions), "used-rail": used_table(used, SEEDS)},
        drawings={"rail-laws": partial(draw, conditions, used)},
        notes=tuple(_notes(conditions)),
    )


def _changes(law: str, controller: str, friction: float, speed: int) -> dict[str, str]:
    return {
        "rig.compensation": "thermal",
        "simulation.maximum_duration": "400 s",
        "rail.condition": law,
        "rail.friction": f"{friction}",
        "initial_speed": f"{speed} km/h",
        "controller": controller,
    }


def _conditions(stop_runner: StopRunner) -> Iterator[Condition]:
    points = [(law, friction, speed) for law in LAWS for friction in FRICTIONS for speed in SPEEDS]
    cases = [
        stop_runner.cases("slip-120", _changes(law, controller, friction, speed))[0]
        for controller in CONTROLLERS
        for law, friction, speed in points
    ]
    repeats = [of_case.stops for of_case in stop_runner.repeated(cases, SEEDS)]
    for k, point in enumerate(points):
        yield Condition(*point, dict(zip(CONTROLLERS, repeats[k :: len(points)], strict=True)))


def _values(conditions: Sequence[Condition], used: Used) -> Iterator[tuple[str, StudyValue]]:
    for law in LAWS:
        own = [each for each in conditions if each.law == law]
        for measure in _FEWER:
            key = _key(law, measure)
            yield f"{key}_ratio", spread([median(each.ratios(measure)) for each in own])
            better = [each.better(measure) for each in own]
            for controller in CONTROLLERS:
                yield f"{key}_{controller}", StudyValue(float(better.count(controller)))
    for law in USED:
        for stops in AFTER:
            found = [rail.found[stops] for rail in used[law, CONTROLLERS[0]]]
            yield f"{_word(law)}_friction_{stops}", spread(found)
        for controller in CONTROLLERS:
            ratios = [rail.distances[-1] / rail.distances[0] for rail in used[law, controller]]
            yield f"{_word(law)}_last_{controller}", spread(ratios)
    for law, stop in _LEAF_STOPS:
        found = [rail.adhesions[stop - 1] for rail in used[law, CONTROLLERS[0]]]
        yield f"{_word(law)}_adhesion_{stop}", spread(found)


def turned(conditions: Sequence[Condition], law: str) -> list[Condition]:
    """Return the conditions in which the other controller stops shorter than on a rail as found."""
    better = {(each.law, each.friction, each.speed): each.better("braking_distance_m") for each in conditions}
    return [
        each
        for each in conditions
        if each.law == law
        and {better[law, each.friction, each.speed], better[FOUND, each.friction, each.speed]}
        == set(CONTROLLERS)
    ]


def _notes(conditions: Sequence[Condition]) -> Iterator[str]:
    count = len(FRICTIONS) * len(SPEEDS)
    yield (
        f"Each condition is {len(SEEDS)} stops with either controller, under the same seeds; it counts for a "
        "controller where all of them agree. Ratios: median of the seeds, then median and range over "
        f"{count} conditions: frictions {', '.join(f'{each:g}' for each in FRICTIONS)}, speeds "
        f"{', '.join(map(str, SPEEDS))} km/h. Nothing was fitted there: wet-curves was set at 0.08, 120 km/h."
    )
    turns = {law: len(turned(conditions, law)) for law in LAWS[1:]}
    listed = ", ".join(f"{law} {number}" for law, number in turns.items())
    yield f"Conditions of {count} in which the better controller is not the one of {FOUND}: {listed}."
    yield (
        f"Stops on one rail: from {USED_SPEED} km/h, friction {USED_FRICTION:g} as found, threshold; the "
        "table has slip-band as well. Each meets the contact loss of all before it, spread evenly along the "
        "track. The other rails keep nothing. Median and range of the seeds, which change the sensors' noise "
        "alone. How much a rail keeps is chosen for every law, of leaves so that some ten stops wear them."
    )


def _table(conditions: Sequence[Condition]) -> Table:
    def medians(measure: str, controller: str) -> list[float]:
        return [
            round(median(measured(stop, measure) for stop in each.stops[controller]), 2)
            for each in conditions
        ]

    ratios = [each.ratios("braking_distance_m") for each in conditions]
    return {
        "law": [each.law for each in conditions],
        "friction": [each.friction for each in conditions],
        "speed_kmh": [each.speed for each in conditions],
        **{
            f"{name}_{_word(controller)}_{unit}": medians(measure, controller)
            for name, measure, unit in (
                ("distance", "braking_distance_m", "m"),
                ("air", "air_consumed_nl", "nl"),
            )
            for controller in CONTROLLERS
        },
        "ratio": [round(median(each), 4) for each in ratios],
        "ratio_low": [round(min(each), 4) for each in ratios],
        "ratio_high": [round(max(each), 4) for each in ratios],
        "shorter": [each.better("braking_distance_m") or "open" for each in conditions],
        "less_air": [each.better("air_consumed_nl") or "open" for each in conditions],
    }


def draw(conditions: Sequence[Condition], used: Used, figure: Figure) -> None:
    """Draw the ratio of both distances for every law, and the friction from stop to stop."""
    figure.set_size_inches(WIDTH, 2.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    _draw_ratios(left, conditions)
    for law, colour in zip(USED, (BLUE, ORANGE, GREEN, PINK), strict=True):
        found = [
            median(each) for each in zip(*(rail.found for rail in used[law, CONTROLLERS[0]]), strict=True)
        ]
        right.plot(range(1, STOPS + 1), found, "o-", color=colour, label=law, markersize=3.0)
    right.set_xlabel("stop on the same rail, -")
    right.set_ylabel("friction found, -")
    right.legend()


def _draw_ratios(axes: Axes, conditions: Sequence[Condition]) -> None:
    axes.axhline(1.0, color=INK, linewidth=0.8)
    for friction, colour in zip(FRICTIONS, (PINK, BLUE, MUTED), strict=True):
        own = [each for each in conditions if each.friction == friction]
        places = [LAWS.index(each.law) + 0.12 * (SPEEDS.index(each.speed) - 1) for each in own]
        ratios = [median(each.ratios("braking_distance_m")) for each in own]
        axes.plot(places, ratios, "o", color=colour, markersize=3.5, label=f"{friction:g}")
    axes.set_xticks(range(len(LAWS)), LAWS)
    axes.set_ylabel("distance, slip-band over threshold, -")
    axes.legend(title="friction as found")


STUDY = Study(
    "rail-laws",
    "Both shipped controllers under every shipped law of the rail",
    "",
    tuple(_quantities()),
    run,
    position=116,
)

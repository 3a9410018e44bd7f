"""Check the order of the valve actuations at points around the calibrated slide test."""

from __future__ import annotations

from functools import partial
from statistics import median

from uictest import rig
from uictest.studies.figures.robustness import draw
from uictest.studies.neighbourhood import FOUR_CALIPER, SEEDS, WITHOUT_CALIPER, Point, neighbourhood
from uictest.studies.quantity import StudyQuantity, StudyValue, spread
from uictest.studies.stop_runner import StopRunner
from uictest.studies.study import Study, StudyFindings, Table

SHOWN = (FOUR_CALIPER, "full", "none")
_APART = 1.3
"""Ratio to the actuations with a caliper above which those without compensation are clearly different."""

QUANTITIES = (
    StudyQuantity(
        "in_order",
        "points at which full is near the caliper and none clearly apart",
        "of 9",
        "11 / 11 / 21 in one stop",
        lower=9.0,
        digits=0,
        reason="ours",
    ),
    StudyQuantity(
        "full_over_caliper",
        "actuations with full compensation over those with a caliper",
        "",
        "1.0 in one stop",
        lower=0.75,
        upper=1.25,
        digits=2,
        reason="ours",
    ),
    StudyQuantity(
        "none_over_caliper",
        "actuations without compensation over those with a caliper",
        "",
        "1.9 in one stop",
        lower=_APART,
        digits=2,
        reason="ours",
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Count actuations of modules 2 to 4 with a caliper each, with full compensation and with none."""
    points = neighbourhood(stop_runner)
    counts = {
        point.title: {name: [actuations(stop) for stop in point.stops[name]] for name in SHOWN}
        for point in points
    }
    medians = [{name: median(values) for name, values in by_rig.items()} for by_rig in counts.values()]
    return StudyFindings(
        {
            "in_order": StudyValue(float(sum(map(_in_order, medians)))),
            "full_over_caliper": spread([_ratio(by_rig["full"], by_rig[FOUR_CALIPER]) for by_rig in medians]),
            "none_over_caliper": spread([_ratio(by_rig["none"], by_rig[FOUR_CALIPER]) for by_rig in medians]),
        },
        tables={"actuations": _table(points)},
        drawings={"robustness": partial(draw, counts)},
        notes=(
            (
                "Actuations per wheelset, mean of modules 2 to 4. Each point of friction and command stands "
                f"for the median of {len(SEEDS)} stops that differ in the noise of the sensors; the ratios "
                "are the median and the range over the points."
            ),
            (
                "A point is in order where full lies nearer to the caliper than none does, and none has at "
                f"least {_APART} times the actuations of the caliper."
            ),
        ),
    )


def actuations(stop: rig.SimulatedStop) -> float:
    """Return the valve actuations per wheelset, mean of modules 2 to 4."""
    counts = [float(stop.wheelset_measures[n - 1].valve_actuations) for n in WITHOUT_CALIPER]
    return sum(counts) / len(counts)


def _in_order(medians: dict[str, float]) -> bool:
    caliper, full, none = (medians[name] for name in SHOWN)
    return caliper > 0.0 and abs(full - caliper) < abs(none - caliper) and none >= _APART * caliper


def _ratio(value: float, reference: float) -> float:
    return value / reference if reference else float("nan")


def _table(points: list[Point]) -> Table:
    rows = [
        (point.friction, point.command, name, seed, stop)
        for point in points
        for name in SHOWN
        for seed, stop in zip(SEEDS, point.stops[name], strict=True)
    ]
    columns: dict[str, list[object]] = {
        "friction": [row[0] for row in rows],
        "command": [row[1] for row in rows],
        "rig": [row[2] for row in rows],
        "seed": [row[3] for row in rows],
    }
    for n in (1, 2, 3, 4):
        columns[f"actuations_{n}"] = [int(row[4].wheelset_measures[n - 1].valve_actuations) for row in rows]
    return columns


STUDY = Study(
    "robustness",
    "Valve actuations over friction, command and sensor noise",
    "one stop: 11 actuations with the caliper, 21 without models, 11 with both",
    QUANTITIES,
    run,
    position=100,
)

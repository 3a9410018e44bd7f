"""One caliper and three tanks against four calipers: how much every measure of a stop differs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from statistics import median

from studies.figures.rig_equivalence import draw_train, draw_wheelsets
from studies.model_errors import UNITS_OF_ERRORS, replay_errors
from studies.neighbourhood import (
    FOUR_CALIPER,
    SEEDS,
    SETTINGS,
    WITHOUT_CALIPER,
    Point,
    neighbourhood,
)
from studies.quantity import NOT_ASKED, Status, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, measured, seeded
from studies.study import Study, StudyFindings, Table
from uictest import CaseResult
from uictest.units import PERCENT

RIGS = (*SETTINGS, FOUR_CALIPER)
"""The settings of the rig with one caliper, and the rig with four, whose spread is that of chance."""
REPLAYED_SEEDS = range(2)
"""Seeds of the stops whose commands are replayed on the bench."""
TRAIN = 0
"""Number of the wheelset for a measure of the train."""


@dataclass(frozen=True, slots=True)
class ComparedMeasure:
    """A measure that is compared: its name, title and unit, and whether each wheelset has its own."""

    key: str
    title: str
    unit: str
    of_wheelsets: bool = False
    digits: int = 1


COMPARED_MEASURES = (
    ComparedMeasure("braking_distance", "braking distance", "m"),
    ComparedMeasure("braking_time", "braking time", "s", digits=2),
    ComparedMeasure("air_consumed", "air taken", "NL"),
    ComparedMeasure("maximum_slide", "largest slide", "percentage points", of_wheelsets=True),
    ComparedMeasure("valve_actuations", "valve actuations", "", of_wheelsets=True),
)
_SUFFIXES = {"braking_distance": "m", "braking_time": "s", "air_consumed": "nl"}
"""Unit in the name of a measure of the train in results."""
ERRORS = (
    ComparedMeasure("pressure_error", "pressure error", UNITS_OF_ERRORS["pressure_error"], of_wheelsets=True),
    ComparedMeasure("force_error", "force error", UNITS_OF_ERRORS["force_error"], of_wheelsets=True),
)


@dataclass(frozen=True, slots=True)
class RigDifference:
    """The values of repeats on one rig at one point, less the median on the rig with four calipers."""

    rig: str
    friction: str
    command: str
    measure: str
    wheelset: int
    reference: float
    values: Sequence[float]


def _quantities() -> Iterator[StudyQuantity]:
    for measure in COMPARED_MEASURES:
        for rig_name in RIGS:
            title = f"{measure.title}, {rig_name}"
            yield StudyQuantity(
                f"{measure.key}_{rig_name}",
                title,
                measure.unit,
                NOT_ASKED,
                status="predicted",
                digits=measure.digits,
            )
    for error in ERRORS:
        for setting in SETTINGS:
            # Hardware was chosen while the errors of `thermal` were watched.
            status: Status = "selected" if setting == "thermal" else "predicted"
            yield StudyQuantity(
                f"{error.key}_{setting}", f"{error.title}, {setting}", error.unit, NOT_ASKED, status=status
            )


def run(stop_runner: StopRunner) -> StudyFindings:
    """Compare the rigs at every point, then the models along the commands of the rig with four calipers."""
    points = neighbourhood(stop_runner)
    rig_differences = [difference for point in points for difference in differences_at(point)]
    rig_differences += [error for point in points for error in errors_at(stop_runner, point)]
    return StudyFindings(
        {
            f"{measure.key}_{rig_name}": overall(rig_differences, measure.key, rig_name)
            for measure in COMPARED_MEASURES
            for rig_name in RIGS
        }
        | {
            f"{error.key}_{name}": overall(rig_differences, error.key, name)
            for error in ERRORS
            for name in SETTINGS
        },
        tables={"differences": _table(rig_differences)},
        drawings={
            "rig-equivalence": partial(draw_train, rig_differences, (*COMPARED_MEASURES, *ERRORS)),
            "rig-equivalence-wheelsets": partial(
                draw_wheelsets,
                rig_differences,
                [each for each in (*COMPARED_MEASURES, *ERRORS) if each.of_wheelsets],
            ),
        },
        notes=_notes(len(points)),
    )


def _notes(points: int) -> tuple[str, ...]:
    differences = (
        "Differences from the median of the rig with four calipers at the same friction and command; median "
        f"and range over {points} points, {len(SEEDS)} seeds of the sensors' noise and all wheelsets. "
        f"The lines '{FOUR_CALIPER}' hold that rig against itself: what lies within their range is chance."
    )
    errors = (
        "Pressure and force errors are the largest of a stop, without the feedback of the cycling: the valve "
        f"commands of the rig with four calipers ({len(REPLAYED_SEEDS)} seeds) are given to a module with a "
        "caliper and to a tank."
    )
    return differences, errors


def differences_at(point: Point) -> Iterator[RigDifference]:
    """Yield the differences of all rigs at one point."""
    for measure in COMPARED_MEASURES:
        for wheelset in (1, 2, 3, 4) if measure.of_wheelsets else (TRAIN,):
            reference = median(_values(point.stops[FOUR_CALIPER], measure, wheelset))
            for rig_name in RIGS:
                values = [value - reference for value in _values(point.stops[rig_name], measure, wheelset)]
                yield RigDifference(
                    rig_name, point.friction, point.command, measure.key, wheelset, reference, values
                )


def errors_at(stop_runner: StopRunner, point: Point) -> Iterator[RigDifference]:
    """Yield pressure and force errors at one point along the commands of the rig with four calipers."""
    cases = [seeded(point.case, seed) for seed in REPLAYED_SEEDS]
    replays = replay_errors(stop_runner, cases, WITHOUT_CALIPER)
    for error, setting, wheelset in product(ERRORS, SETTINGS, WITHOUT_CALIPER):
        values = [getattr(each.errors[setting], error.key) for each in replays if each.wheelset == wheelset]
        yield RigDifference(setting, point.friction, point.command, error.key, wheelset, 0.0, values)


def overall(rig_differences: Sequence[RigDifference], measure: str, rig_name: str) -> StudyValue:
    """Return median and range over points, repeats and wheelsets."""
    return spread(
        [
            value
            for each in rig_differences
            if (each.measure, each.rig) == (measure, rig_name)
            for value in each.values
        ]
    )


def _values(stops: Sequence[CaseResult], measure: ComparedMeasure, wheelset: int) -> list[float]:
    return [_value(stop, measure.key, wheelset) for stop in stops]


def _value(stop: CaseResult, key: str, wheelset: int) -> float:
    if wheelset != TRAIN:
        value = float(stop.wheelsets[wheelset - 1][key])
        return value / PERCENT if key == "maximum_slide" else value
    return measured(stop, f"{key}_{_SUFFIXES[key]}")


def _table(rig_differences: Sequence[RigDifference]) -> Table:
    spreads = [spread(each.values) for each in rig_differences]
    return {
        "rig": [each.rig for each in rig_differences],
        "friction": [each.friction for each in rig_differences],
        "command": [each.command for each in rig_differences],
        "measure": [each.measure for each in rig_differences],
        "wheelset": ["train" if each.wheelset == TRAIN else each.wheelset for each in rig_differences],
        "reference": [each.reference for each in rig_differences],
        "difference_median": [each.value for each in spreads],
        "difference_low": [each.low for each in spreads],
        "difference_high": [each.high for each in spreads],
        "repeats": [len(each.values) for each in rig_differences],
    }


STUDY = Study(
    "rig-equivalence",
    "One caliper and three tanks against four calipers",
    "",
    tuple(_quantities()),
    run,
    position=110,
)

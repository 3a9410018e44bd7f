"""One caliper and three tanks against four calipers: how much every measure of a stop differs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np

from studies.drawing import MUTED, SETTING_COLOURS, WIDTH
from studies.model_errors import UNITS_OF_ERRORS, replay_errors
from studies.neighbourhood import FOUR_CALIPER, SEEDS, SETTINGS, WITHOUT_CALIPER, Point, neighbourhood
from studies.quantity import NOT_ASKED, Status, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, measured, seeded
from studies.study import Study, StudyFindings, Table
from uictest import CaseResult
from uictest.units import PERCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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


_COLUMNS = 4
_RIG_TITLES = {"four-caliper": "four calipers"}
_EXPLANATION = """Difference from the rig with
four calipers; last line:
that rig against itself.

Tick: median of all
Dot: median of one point
Bar: eight tenths of all
Line: least to greatest

Pressure and force:
largest error of a stop"""
_ROW = 0.14
_MOST = (0.1, 0.9)
"""Quantiles between which the bar is thick; it is thin from the minimum to the maximum."""
_NOTE: Any = {"ha": "center", "color": MUTED, "fontsize": 7.0}


def draw_train(
    differences: Sequence[RigDifference], measures: Sequence[ComparedMeasure], figure: Figure
) -> None:
    """Draw a panel for each measure; repeats and wheelsets of all points together."""
    figure.set_size_inches(WIDTH, 4.3)
    rows = -(-len(measures) // _COLUMNS)
    panels = figure.subplots(rows, _COLUMNS, sharey=True, squeeze=False)
    for axes, measure in zip(panels.flat, measures, strict=False):
        _draw_measure(axes, [each for each in differences if each.measure == measure.key], measure)
    for axes in list(panels.flat)[len(measures) :]:
        axes.set_axis_off()
    panels[-1][-1].text(0.0, 1.0, _EXPLANATION, transform=panels[-1][-1].transAxes, va="top", color=MUTED)
    first = panels[0][0]
    first.set_yticks(range(len(SETTING_COLOURS)), [_RIG_TITLES.get(name, name) for name in SETTING_COLOURS])
    first.invert_yaxis()


def _draw_measure(axes: Axes, differences: Sequence[RigDifference], measure: ComparedMeasure) -> None:
    axes.axvline(0.0, color=MUTED, linewidth=0.8)
    for row, (rig, colour) in enumerate(SETTING_COLOURS.items()):
        of_rig = [each for each in differences if each.rig == rig]
        values = [value for each in of_rig for value in each.values]
        if not values:
            continue
        axes.plot([min(values), max(values)], [row, row], color=colour, alpha=0.4, linewidth=1.0)
        axes.plot(np.quantile(values, _MOST), [row, row], color=colour, alpha=0.3, linewidth=4.5)
        medians = [median(each.values) for each in of_rig]
        axes.plot(medians, [row] * len(medians), "o", color=colour, alpha=0.4, markersize=2.8, mew=0.0)
        axes.plot([median(values)] * 2, [row - 0.32, row + 0.32], color=colour, linewidth=2.0)
    axes.grid(visible=False, axis="y")
    axes.set(title=measure.title, xlabel=measure.unit or "number")
    axes.tick_params(axis="y", length=0)


def draw_wheelsets(
    differences: Sequence[RigDifference], measures: Sequence[ComparedMeasure], figure: Figure
) -> None:
    """Draw a panel for each measure of wheelsets: a group of settings for each wheelset."""
    figure.set_size_inches(WIDTH, 4.6)
    panels = figure.subplots(2, 2, squeeze=False)
    for axes, measure in zip(panels.flat, measures, strict=True):
        of = [each for each in differences if each.measure == measure.key]
        axes.axhline(0.0, color=MUTED, linewidth=0.8)
        for k, (rig, colour) in enumerate(SETTING_COLOURS.items()):
            shift = (k - (len(SETTING_COLOURS) - 1) / 2.0) * _ROW
            _draw_rig(axes, [each for each in of if each.rig == rig], shift, colour)
        axes.set_xticks(range(1, 5), [f"wheelset {n}" for n in range(1, 5)])
        axes.set_xlim(0.5, 4.5)
        axes.grid(visible=False, axis="x")
        axes.set(title=measure.title, ylabel=measure.unit or "number")
    for axes in panels[1]:
        axes.set_ylim(bottom=0.0)
        axes.annotate("has the\ncaliper", (1.0, 0.05), xycoords=("data", "axes fraction"), **_NOTE)
    handles = [
        panels[0][0].plot([], [], color=colour, linewidth=3.0, label=_RIG_TITLES.get(rig, rig))[0]
        for rig, colour in SETTING_COLOURS.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))


def _draw_rig(axes: Axes, differences: Sequence[RigDifference], shift: float, colour: str) -> None:
    for wheelset in sorted({each.wheelset for each in differences}):
        values = [value for each in differences if each.wheelset == wheelset for value in each.values]
        across = wheelset + shift
        axes.plot([across, across], [min(values), max(values)], color=colour, alpha=0.4, linewidth=1.0)
        axes.plot([across, across], np.quantile(values, _MOST), color=colour, alpha=0.35, linewidth=3.5)
        middle = median(values)
        axes.plot([across - 0.05, across + 0.05], [middle, middle], color=colour, linewidth=2.0)


STUDY = Study(
    "rig-equivalence",
    "One caliper and three tanks against four calipers",
    "",
    tuple(_quantities()),
    run,
    position=110,
)

"""Errors of every setting of the compensation over friction, brake position, wheelset and seed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import product
from statistics import median

from uictest.studies.figures.compensation_domain import draw
from uictest.studies.judged_conditions import JudgedConditions, judged_cases, judged_conditions
from uictest.studies.model_errors import ReplayErrors, replay_errors
from uictest.studies.neighbourhood import SETTINGS
from uictest.studies.quantity import NOT_ASKED, StudyQuantity, StudyValue
from uictest.studies.stop_runner import StopRunner, constant_friction
from uictest.studies.study import Study, StudyFindings, Table

TITLES = {
    "pressure_error": "pressure error",
    "true_pressure_error": "error against the true pressure",
    "force_error": "force error",
}
STATISTICS: dict[str, Callable[[Sequence[float]], float]] = {"median": median, "worst": max}
_PAPER = {
    "pressure_error_worst_none": "7 %",
    "pressure_error_worst_full": "below 2 %",
    "pressure_error_worst_thermal": "below 2 % by its filter",
    "force_error_worst_full": "within +-8 %",
    "force_error_worst_thermal": "within +-8 % by its models",
}
_BOUNDS = {
    "pressure_error_median_thermal": 1.0,
    "pressure_error_worst_thermal": 2.0,
    "force_error_worst_thermal": 8.0,
}
"""Bounds that an error must stay below, %."""


def _quantities() -> Iterator[StudyQuantity]:
    for error, setting, statistic in product(TITLES, SETTINGS, STATISTICS):
        key = f"{error}_{statistic}_{setting}"
        yield StudyQuantity(
            key,
            f"{TITLES[error]}, {setting}, {statistic}",
            "%",
            _PAPER.get(key, NOT_ASKED),
            upper=_BOUNDS.get(key),
            below=True,
            digits=2,
            reason="ours, of the paper's claim" if key in _BOUNDS else "",
        )


def run(stop_runner: StopRunner) -> StudyFindings:
    """Replay the valve commands of every judged stop, and compare all settings with the caliper."""
    conditions = judged_conditions()
    replays = replay_errors(stop_runner, judged_cases(stop_runner, conditions), conditions.wheelsets)
    return StudyFindings(
        {
            f"{error}_{name}_{setting}": StudyValue(statistic(errors_of(replays, error, setting)))
            for error, setting in product(TITLES, SETTINGS)
            for name, statistic in STATISTICS.items()
        },
        tables={"errors": _table(replays)},
        drawings={"compensation-domain": partial(draw, replays)},
        notes=tuple(_notes(conditions, replays)),
    )


def errors_of(replays: Sequence[ReplayErrors], error: str, setting: str) -> list[float]:
    """Return the largest error of every replay under one setting, %; `error` is a key of `TITLES`."""
    return [getattr(each.errors[setting], error) for each in replays]


def _notes(conditions: JudgedConditions, replays: Sequence[ReplayErrors]) -> Iterator[str]:
    counts = [f"{len(values)} {name}" for name, values in conditions]
    yield (
        f"{len(replays)} replays: {', '.join(counts)}. Neither training nor calibration has used them. Each "
        "gives its largest error, of pressure in % of the position's maximum pressure, of force in % of the "
        "largest force; median and worst are of all replays. Pressure errors compare what both sensors read, "
        "as in the paper; against the true pressure, errors that the sensors share count as well."
    )
    for setting in ("full", "thermal"):
        errors = errors_of(replays, "pressure_error", setting)
        worst = replays[errors.index(max(errors))]
        yield (
            f"The worst pressure error of {setting} lies at friction {constant_friction(worst.case):g}, "
            f"position {worst.case.scenario.brake.position}, wheelset {worst.wheelset}."
        )


def _table(replays: Sequence[ReplayErrors]) -> Table:
    rows = list(product(replays, SETTINGS))
    stops = [replay.case.scenario for replay, _ in rows]
    return {
        "friction": [constant_friction(replay.case) for replay, _ in rows],
        "position": [stop.brake.position for stop in stops],
        "wheelset": [replay.wheelset for replay, _ in rows],
        "seed": [stop.seed for stop in stops],
        "setting": [setting for _, setting in rows],
        "pressure_error_percent": [replay.errors[setting].pressure_error for replay, setting in rows],
        "true_pressure_error_percent": [
            replay.errors[setting].true_pressure_error for replay, setting in rows
        ],
        "force_error_percent": [replay.errors[setting].force_error for replay, setting in rows],
    }


STUDY = Study(
    "compensation-domain",
    "Pressure and force errors of every compensation over friction, position and wheelset",
    "the largest pressure error falls from 7 % to below 2 %, the force lies within +-8 %; one number each",
    tuple(_quantities()),
    run,
    position=103,
)

"""Known verdicts: a record made by hand, judged like any recording.

The train runs at 120 km/h, brakes with 1 m/s2 from the brake command on, and stops after v0^2/(2 a). One
wheelset stands still for 0.75 s.
"""

from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.recorded import field_data
from uictest.selftest.known_stops import Answer, Check, KnownStops

_SPEED: Final = 120.0 * KILOMETRE_PER_HOUR
_DECELERATION: Final = 1.0
"""m/s2."""
_LOCK: Final = (10.0, 10.5, 11.25, 11.75)
"""When the third wheelset begins to lose its speed, stands still, begins to turn and rolls again, s."""
_SCENARIO: Final = Path(__file__).parent / "record" / "record.yaml"
_AT_ZERO: Final = field_data.Preparation.model_validate({"trigger_time": "0 s"})
"""The brake command is given at the time 0."""
_VERDICTS: Final = {
    "distance-met": "pass",
    "distance-missed": "fail",
    "lock-met": "pass",
    "lock-missed": "fail",
    "lock-of-most": "pass",
    "reservoir": "inconclusive",
    "simulation": "not_applicable",
    "wet": "not_applicable",
}
"""Criterion of `record/criteria.yaml` -> its verdict."""


def judging_checks() -> Iterator[Check]:
    """Yield a check of every verdict, of two figures and of the outcome."""
    of_record = "of a record made by hand: {}"
    distance, mean = of_record.format("v0^2/(2 a)"), of_record.format("v0^2/(2 s)")
    yield Check("record-distance", "judging", f"braking distance {distance}", _distance, 1e-6, "m")
    yield Check("record-deceleration", "judging", f"deceleration {mean}", _deceleration, 1e-6, "m/s2")
    for criterion, status in _VERDICTS.items():
        what = f"verdict {of_record.format(criterion)}"
        yield Check(f"verdict-{criterion}", "judging", what, partial(_verdict, criterion, status))
    yield Check("record-outcome", "judging", f"outcome {of_record.format('two limits missed')}", _outcome)


def _distance(stops: KnownStops) -> Answer:
    return Answer(_SPEED**2 / (2.0 * _DECELERATION), _figure("braking_distance_m"))


def _deceleration(stops: KnownStops) -> Answer:
    return Answer(_DECELERATION, _figure("mean_deceleration_mps2"))


def _figure(column: str) -> float:
    measures = _judged().measures
    assert measures is not None
    return measures[column]


def _verdict(criterion: str, status: str, stops: KnownStops) -> Answer:
    verdict = next(each for each in _judged().criteria if each.id == criterion)
    return Answer(status, verdict.status, verdict.reason)


def _outcome(stops: KnownStops) -> Answer:
    return Answer("fail", _judged().outcome, _judged().reason)


@cache
def _judged() -> evaluation.CaseResult:
    (case,) = scenario.load([_SCENARIO])
    stop = field_data.prepare(_channels(), {}, _AT_ZERO)
    result, _ = field_data.judge_recording(case, stop)
    return result


def _channels() -> dict[str, field_data.RawChannel]:
    """Return speeds from a second before the brake command until a second after the stop, at 100 Hz."""
    time = np.arange(-100, 100 * round(_SPEED / _DECELERATION) + 100) / 100.0
    speed = np.clip(_SPEED - _DECELERATION * time, 0.0, _SPEED)
    locked = speed * np.interp(time, _LOCK, (1.0, 0.0, 0.0, 1.0))
    samples: dict[str, Any] = {"speed": speed}
    samples |= {f"wheel_speed_{number}": locked if number == 3 else speed for number in (1, 2, 3, 4)}
    return {name: field_data.RawChannel(name, name, time, values) for name, values in samples.items()}

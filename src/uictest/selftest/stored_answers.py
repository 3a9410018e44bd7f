"""Stored answers: the bits of known stops, the verdicts on a known record, and the data files that ship."""

from collections.abc import Iterator, Mapping
from functools import cache, partial
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.recorded import field_data
from uictest.selftest.known_stops import (
    Answer,
    Check,
    KnownStops,
    Numbers,
    c_stop,
    data_digests,
    digest_of,
    inputs_digest,
    numbers_of_stop,
    python_stop,
    stored_data_digests,
    stored_inputs,
    stored_numbers,
    stored_numbers_from_outside,
)

_MOST_NAMED: Final = 3
_DIGITS: Final = 12
"""Of a SHA-256 that are shown."""


def stop_checks(stops: KnownStops) -> Iterator[Check]:
    """Yield two checks of every known stop: what the rig is given, and every number that comes out."""
    for name, case in stops.cases.items():
        title = case.scenario.title
        yield Check(
            f"inputs-of-{name}", "numerics", f"SHA-256 of the inputs of {name}", partial(_inputs, name)
        )
        yield Check(name, "numerics", f"SHA-256 of all measures: {title}", partial(_alone, name))
    yield Check("lanes", "lanes", "SHA-256 of all stops, side by side in SIMD lanes", _in_lanes)


def controller_checks() -> Iterator[Check]:
    """Yield the checks of a stop whose controller runs in a child process."""
    what = "SHA-256 of all measures: controller in {} in a child process"
    yield Check("python-controller", "controllers", what.format("Python"), _from_python)
    yield Check("c-controller", "controllers", what.format("C"), _from_c)


def _inputs(name: str, stops: KnownStops) -> Answer:
    expected, found = stored_inputs(name), inputs_digest(stops.cases[name])
    words = (
        "" if found == expected else "parts of the library, or their assembly, are not those of this version"
    )
    return Answer(expected[:_DIGITS], found[:_DIGITS], words)


def _alone(name: str, stops: KnownStops) -> Answer:
    return answer_of(stored_numbers(name), numbers_of_stop(stops.stop(name)))


def _in_lanes(stops: KnownStops) -> Answer:
    expected = {f"{stop}.{name}": text for stop in stops.cases for name, text in stored_numbers(stop).items()}
    found = stops.in_lanes()
    return answer_of(
        expected, {f"{stop}.{name}": text for stop in found for name, text in found[stop].items()}
    )


def _from_python(stops: KnownStops) -> Answer:
    return answer_of(stored_numbers_from_outside(), numbers_of_stop(python_stop()))


def _from_c(stops: KnownStops) -> Answer:
    return answer_of(stored_numbers_from_outside(), numbers_of_stop(c_stop()))


def answer_of(expected: Numbers, found: Numbers) -> Answer:
    """Return the digests of numbers, and in words which differ."""
    names = dict.fromkeys((*expected, *found))
    different = [name for name in names if expected.get(name) != found.get(name)]
    named = "; ".join(
        f"{name}: expected {expected.get(name, 'no such number')}, found {found.get(name, 'no such number')}"
        for name in islice(different, _MOST_NAMED)
    )
    words = f"{len(different)} of {len(names)} numbers differ: {named}" if different else ""
    return Answer(digest_of(expected)[:_DIGITS], digest_of(found)[:_DIGITS], words)


_MOST_FILES_NAMED: Final = 5


def data_checks() -> Iterator[Check]:
    """Yield the check of the shipped data, which a working tree has as an installed package does."""
    what = "files of the library, known stops and templates that are not those of this version"
    yield Check("shipped-data", "environment", what, _shipped_data, unit="files", origin="installed files")


def _shipped_data(stops: KnownStops) -> Answer:
    differ = list(different_files(stored_data_digests(), data_digests()))
    more = len(differ) - _MOST_FILES_NAMED
    rest = f" and {more} more" if more > 0 else ""
    return Answer(0.0, float(len(differ)), ", ".join(differ[:_MOST_FILES_NAMED]) + rest)


def different_files(stored: Mapping[str, str], found: Mapping[str, str]) -> Iterator[str]:
    """Yield the files that differ, and how."""
    for name in sorted({*stored, *found}):
        if name not in found:
            yield f"{name} is missing"
        elif name not in stored:
            yield f"{name} is not part of it"
        elif stored[name] != found[name]:
            yield f"{name} was changed"


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
    yield Check(
        "record-distance",
        "judging",
        f"braking distance {distance}",
        _distance,
        1e-6,
        "m",
        origin="closed form",
    )
    yield Check(
        "record-deceleration",
        "judging",
        f"deceleration {mean}",
        _deceleration,
        1e-6,
        "m/s2",
        origin="closed form",
    )
    for criterion, status in _VERDICTS.items():
        what = f"verdict {of_record.format(criterion)}"
        yield Check(
            f"verdict-{criterion}",
            "judging",
            what,
            partial(_verdict, criterion, status),
            origin="made by hand",
        )
    yield Check(
        "record-outcome",
        "judging",
        f"outcome {of_record.format('two limits missed')}",
        _outcome,
        origin="made by hand",
    )


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

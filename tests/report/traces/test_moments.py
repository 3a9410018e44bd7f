from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import AppliedDefinition, Verdict
from uictest.report.traces.moments import TRAIN, Moments, moments_of

MakeVerdict = Callable[..., Verdict]
MakeRecording = Callable[..., Recording]


def _verdict(make: MakeVerdict, measure: str, **definitions: float) -> Verdict:
    applied = tuple(AppliedDefinition(name, value, "", "chosen") for name, value in definitions.items())
    return make(id="it", measure=measure, definitions=applied)


def test_a_lock_of_a_few_samples_is_found_however_long_the_record_is(
    make_verdict: MakeVerdict, make_recording: MakeRecording
) -> None:
    record = make_recording(340_001)
    record["wheel_speed_2"][200_000:200_003] = 0.0
    lock = _verdict(make_verdict, "longest_lock", moving_speed=2.0, locked_speed=0.1)
    [(wheelset, intervals)] = moments_of([lock], record.channels)["it"].intervals.items()
    assert wheelset == 2
    assert intervals == [(pytest.approx(19.9999), pytest.approx(20.0002))]


def test_the_largest_slide_counts_above_the_cutoff_only(
    make_verdict: MakeVerdict, make_recording: MakeRecording
) -> None:
    record = make_recording()
    record["slide_1"][(record["time"] > 30.0)] = 0.9
    slide = _verdict(make_verdict, "maximum_slide_above_cutoff", low_speed_cutoff=30 / 3.6)
    moments = moments_of([slide], record.channels)["it"]
    time, value = moments.extremes[1]
    assert 5.0 < time < 15.0
    assert value == pytest.approx(40.0)
    assert moments.until == pytest.approx(25.0, abs=0.011)


def test_the_lowest_pressure_is_that_of_the_train_in_bar(
    make_verdict: MakeVerdict, make_recording: MakeRecording
) -> None:
    lowest = _verdict(make_verdict, "reservoir_minimum_pressure")
    moments = moments_of([lowest], make_recording().channels)["it"]
    assert moments.extremes == {TRAIN: (34.0, pytest.approx(7.66))}


def test_what_is_not_defined_or_not_recorded_has_no_moments(make_verdict: MakeVerdict) -> None:
    time = np.linspace(0.0, 1.0, 11)
    lock, distance = _verdict(make_verdict, "longest_lock"), _verdict(make_verdict, "braking_distance")
    assert moments_of([lock, distance], {"time": time, "speed": 1.0 - time}) == {"it": Moments()}
    assert moments_of([lock], {"time": time}) == {}

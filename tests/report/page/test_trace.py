from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from uictest.recording import Recording
from uictest.report.page.trace import SAMPLES, deceleration, trace_of

MakeRecording = Callable[..., Recording]


def test_series_are_in_the_units_an_engineer_reads(make_recording: MakeRecording) -> None:
    trace = trace_of(make_recording(sliding_time="5.01"))
    assert trace.series["speed"][0] == pytest.approx(120.0)
    assert trace.series["slide_1"].max() == pytest.approx(40.0)
    assert trace.series["tank_pressure_4"].max() == pytest.approx(3.8)
    assert trace.series["clamping_force_2"].max() == pytest.approx(14.0)
    assert trace.sliding_time == 5.01


@pytest.mark.parametrize("samples", [2, SAMPLES, SAMPLES + 1, 10 * SAMPLES + 7])
def test_no_more_samples_are_kept_than_a_screen_can_show(make_recording: MakeRecording, samples: int) -> None:
    trace = trace_of(make_recording(samples))
    assert len(trace.time) <= SAMPLES
    assert all(len(series) == len(trace.time) for series in trace.series.values())


def test_a_recording_of_few_channels_is_drawn_as_far_as_it_goes() -> None:
    time = np.array([0.0, 1.0, 2.0])
    trace = trace_of(Recording({"time": time, "slide_3": time / 10}, {"time": "s", "slide_3": "1"}))
    assert list(trace.series) == ["slide_3"]
    assert trace.sliding_time is None


def test_the_deceleration_of_a_constant_brake_is_constant_to_the_ends_of_the_record() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    assert deceleration(time, 30.0 - 0.5 * 9.80665 * time) == pytest.approx(0.5)


def test_what_was_not_measured_leaves_no_deceleration() -> None:
    time = np.linspace(0.0, 10.0, 101)
    speed = np.where(time < 5.0, 30.0 - time, np.nan)
    assert np.isnan(deceleration(time, speed)[-1])

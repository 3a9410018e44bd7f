"""Measures of the train against plain numpy on the same samples."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    begin_slow_times,
    begin_train,
    begin_window,
    note_standstill,
)
from uictest.core.measures.records import WINDOW_SECONDS
from uictest.core.measures.train import observe_reservoir_margin


def begun(held_before):
    train = np.full(STOP_MEASURES.itemsize // 8, held_before).view(STOP_MEASURES)
    begin_train(train[0], 0.5, 1.0, 30.0, 7e5, 3.8e5, 0.0)
    begin_window(train[0])
    begin_slow_times(train[0], np.zeros(4, WHEELSET_MEASURES).view(np.recarray))
    return train.view(np.float64)


def test_measures_begin_alike_whatever_the_record_held():
    np.testing.assert_array_equal(begun(7.0), begun(0.0))


def sliding(samples):
    """Where which wheelset slides: by more than 5 % and 0.3 m/s while the train moves."""
    slip = samples.speed[:, None] - samples.wheel_speed
    moving = samples.speed[:, None] > 2.8
    return moving & (slip / samples.speed[:, None] > 0.05) & (slip > 0.3)


def test_first_sliding_who_slides_first_and_the_speeds_after_it(samples, stop):
    slides = sliding(samples)
    first = int(np.argmax(slides.any(axis=1)))
    assert stop[0].sliding_time == samples.time[first]
    assert stop[0].sliding_wheelset == 1 + np.argmax(slides[first])
    at = stop[0].sliding_time + np.arange(WINDOW_SECONDS + 1)
    np.testing.assert_allclose(
        stop[0].speed_after_sliding, np.interp(at, samples.time, samples.speed), rtol=1e-12
    )


def test_speed_after_sliding_is_nan_where_the_record_ends_earlier(samples, measured):
    short = replace(samples, **{name: column[:700] for name, column in vars(samples).items()})
    train = measured(short)[0]
    reached = train.sliding_time + np.arange(WINDOW_SECONDS + 1) <= short.time[-1] + 1e-9
    np.testing.assert_array_equal(np.isfinite(train.speed_after_sliding), reached)
    assert 0 < reached.sum() < reached.size


def test_window_does_not_depend_on_when_the_samples_fall(samples, measured):
    """Every third sample gives the same speeds, within what is linear between samples."""
    sparse = replace(samples, **{name: column[::3] for name, column in vars(samples).items()})
    train = measured(sparse)[0]
    at = train.sliding_time + np.arange(WINDOW_SECONDS + 1)
    np.testing.assert_allclose(
        train.speed_after_sliding, np.interp(at, samples.time, samples.speed), atol=1e-3
    )


def test_extremes_last_sample_and_count_of_a_train_that_never_stopped(samples, stop):
    deceleration = -np.diff(samples.speed) / np.diff(samples.time)
    share = 0.01 / (0.01 + 0.5)
    filtered = lfilter([share], [1.0, share - 1.0], deceleration)
    moving = samples.speed[1:] >= 2.8
    developed = moving & (samples.time[1:] >= 2.0)
    assert stop[0].maximum_deceleration == pytest.approx(filtered[moving].max(), rel=1e-9)
    assert stop[0].minimum_deceleration == pytest.approx(filtered[developed].min(), rel=1e-9)
    assert stop[0].reservoir_minimum_pressure == samples.reservoir_pressure.min()
    train = stop[0]
    last = (train.end_time, train.end_distance, train.end_speed, train.samples)
    assert last == (samples.time[-1], samples.distance[-1], samples.speed[-1], samples.time.size)
    assert stop[0].stopped == 0.0
    assert np.isnan([stop[0].braking_time, stop[0].braking_distance]).all()


def test_margin_of_the_reservoir_is_its_smallest_over_the_cylinders():
    train = np.zeros(1, STOP_MEASURES)[0]
    begin_train(train, 0.0, 0.0, 30.0, 8e5, 3.8e5, 0.0)
    for reservoir, cylinder in ((8e5, 0.0), (7.2e5, 3.8e5), (np.nan, 3.8e5), (7.0e5, 1.0e5)):
        observe_reservoir_margin(train, reservoir, cylinder)
    assert train.reservoir_margin == pytest.approx(3.4e5)


def test_standstill_ends_the_stop(stop):
    train = stop[0].copy()
    note_standstill(train, True, 27.5, 410.0)
    assert (train.stopped, train.braking_time, train.braking_distance) == (1.0, 27.5, 410.0)
    assert (train.end_time, train.end_distance, train.end_speed) == (27.5, 410.0, 0.0)

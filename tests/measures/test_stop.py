"""Measures of the train and of its wheelsets against plain numpy on the same samples."""

from dataclasses import replace
from itertools import groupby

import numpy as np
import pytest
from scipy.signal import lfilter

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    begin_slides,
    begin_slow_times,
    begin_train,
    begin_wheelset,
    begin_window,
    note_standstill,
)
from uictest.core.measures.records import SPEED_CLASSES, WINDOW_SECONDS
from uictest.core.measures.train import observe_reservoir_margin


def begun(held_before):
    train = np.full(STOP_MEASURES.itemsize // 8, held_before).view(STOP_MEASURES)
    begin_train(train[0], 0.5, 1.0, 30.0, 7e5, 3.8e5, 0.0)
    begin_window(train[0])
    begin_slow_times(train[0], np.zeros(4, WHEELSET_MEASURES).view(np.recarray))
    return train.view(np.float64)


def test_measures_begin_alike_whatever_the_record_held():
    np.testing.assert_array_equal(begun(7.0), begun(0.0))
    np.testing.assert_array_equal(begun_wheelset(7.0), begun_wheelset(0.0))


def test_first_sliding_who_slides_first_and_the_speeds_after_it(samples, stop):
    sliding = sliding_rows(samples)
    first = int(np.argmax(sliding.any(axis=1)))
    assert stop[0].sliding_time == samples.time[first]
    assert stop[0].sliding_wheelset == 1 + np.argmax(sliding[first])
    at = stop[0].sliding_time + np.arange(WINDOW_SECONDS + 1)
    np.testing.assert_allclose(
        stop[0].speed_after_sliding, np.interp(at, samples.time, samples.speed), rtol=1e-12
    )


def test_speeds_after_sliding_end_with_the_record_and_do_not_depend_on_the_samples(samples, measured):
    short = replace(samples, **{name: column[:700] for name, column in vars(samples).items()})
    train = measured(short)[0]
    reached = train.sliding_time + np.arange(WINDOW_SECONDS + 1) <= short.time[-1] + 1e-9
    np.testing.assert_array_equal(np.isfinite(train.speed_after_sliding), reached)
    assert 0 < reached.sum() < reached.size
    # Every third sample gives the same speeds, within what is linear between samples.
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


INTERVAL = 0.01


def slides(samples):
    return (samples.speed[:, None] - samples.wheel_speed) / samples.speed[:, None]


def moving_rows(samples):
    """Samples that count: all but the first, while the train moves."""
    return (samples.speed > 2.8) & (np.arange(samples.time.size) > 0)


def sliding_rows(samples):
    """Samples in which each wheelset slides: by more than 5 % and 0.3 m/s while the train moves."""
    slip = samples.speed[:, None] - samples.wheel_speed
    return moving_rows(samples)[:, None] & (slides(samples) > 0.05) & (slip > 0.3)


def begun_wheelset(held_before):
    wheelset = np.full(WHEELSET_MEASURES.itemsize // 8, held_before).view(WHEELSET_MEASURES)
    begin_wheelset(wheelset[0])
    begin_slides(wheelset[0])
    begin_slow_times(np.zeros(1, STOP_MEASURES)[0], [wheelset[0]] * 4)
    return wheelset.view(np.float64)


def test_extremes_of_slide_force_and_disc_temperature(samples, stop):
    expected = slides(samples)[moving_rows(samples)].max(axis=0)
    np.testing.assert_array_equal(stop[1].maximum_slide, expected)
    np.testing.assert_array_equal(stop[1].maximum_clamping_force, samples.clamping_force[1:].max(axis=0))
    # The record of the last wheelset holds no temperature.
    np.testing.assert_array_equal(stop[1].maximum_disc_temperature, samples.disc_temperature[1:].max(axis=0))
    assert np.isnan(stop[1].maximum_disc_temperature).tolist() == [False, False, False, True]


@pytest.mark.parametrize("k", range(SPEED_CLASSES))
def test_largest_slide_above_a_train_speed(samples, stop, k):
    """Classes of 10 km/h; NaN for speeds that the train never had."""
    faster = moving_rows(samples) & (samples.speed > 10 * k / 3.6)
    expected = slides(samples)[faster].max(axis=0) if faster.any() else np.full(4, np.nan)
    np.testing.assert_array_equal(stop[1].maximum_slide_above[:, k], expected)


def test_times_spent_sliding_and_locked_and_openings_of_the_vent(samples, stop):
    sliding = sliding_rows(samples)
    np.testing.assert_allclose(stop[1].sliding_duration, INTERVAL * sliding.sum(axis=0), rtol=1e-9)
    first = np.where(sliding.any(axis=0), samples.time[sliding.argmax(axis=0)], np.nan)
    np.testing.assert_array_equal(stop[1].first_sliding_time, first)
    locked = moving_rows(samples)[:, None] & (samples.wheel_speed < 0.1)
    runs = [[len(list(run)) for stands, run in groupby(column) if stands] for column in locked.T]
    assert any(runs)
    np.testing.assert_allclose(stop[1].locked_time, [INTERVAL * sum(run) for run in runs], rtol=1e-9)
    np.testing.assert_allclose(
        stop[1].longest_lock, [INTERVAL * max(run, default=0) for run in runs], rtol=1e-9
    )
    openings = (np.diff(samples.venting, axis=0) > 0.0).sum(axis=0)
    np.testing.assert_array_equal(stop[1].valve_actuations, openings)


def test_a_gap_in_a_recording_does_not_hide_what_came_before(samples, measured):
    count = len(samples.time)
    hot = np.repeat(np.linspace(700.0, 400.0, count)[:, None], 4, axis=1)
    hot[: count // 8] = hot[count // 2 : count // 2 + 5] = np.nan
    force = np.repeat(np.linspace(12e3, 2e3, count)[:, None], 4, axis=1)
    force[count // 2 : count // 2 + 5] = np.nan
    wheelsets = measured(replace(samples, disc_temperature=hot, clamping_force=force))[1]
    np.testing.assert_array_equal(wheelsets.maximum_disc_temperature, hot[count // 8])
    np.testing.assert_array_equal(wheelsets.maximum_clamping_force, force[1])


def test_two_locks_are_not_one(samples, measured):
    """Standing for 1 s, rolling for a moment, standing for 2 s: the longest lock is 2 s."""
    wheel_speed = np.repeat(samples.speed[:, None], 4, axis=1)
    wheel_speed[500:600, 0] = wheel_speed[601:801, 0] = 0.0
    wheelset = measured(replace(samples, wheel_speed=wheel_speed))[1][0]
    assert (wheelset.longest_lock, wheelset.locked_time) == pytest.approx((2.0, 3.0))
    assert wheelset.maximum_slide == 1.0


def test_a_lock_at_walking_pace_does_not_count_and_nothing_slides_where_nothing_slid(samples, measured):
    """Below the speed from which measures are taken a slide means nothing."""
    wheel_speed = np.repeat(samples.speed[:, None], 4, axis=1)
    wheel_speed[samples.speed < 2.8] = 0.0
    train, wheelsets = measured(replace(samples, wheel_speed=wheel_speed))
    assert not wheelsets.locked_time.any()
    assert not wheelsets.maximum_slide.any()
    assert np.isnan([train.sliding_time, train.sliding_wheelset, *train.speed_after_sliding]).all()

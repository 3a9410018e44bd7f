"""Measures of the wheelsets against plain numpy on the same samples."""

from dataclasses import replace
from itertools import groupby

import numpy as np
import pytest

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    begin_slides,
    begin_slow_times,
    begin_wheelset,
)
from uictest.core.measures.records import SPEED_CLASSES

INTERVAL = 0.01


def slides(samples):
    return (samples.speed[:, None] - samples.wheel_speed) / samples.speed[:, None]


def observed(samples):
    """Samples that count: all but the first, while the train moves."""
    return (samples.speed > 2.8) & (np.arange(samples.time.size) > 0)


def begun(held_before):
    wheelset = np.full(WHEELSET_MEASURES.itemsize // 8, held_before).view(WHEELSET_MEASURES)
    begin_wheelset(wheelset[0])
    begin_slides(wheelset[0])
    begin_slow_times(np.zeros(1, STOP_MEASURES)[0], [wheelset[0]] * 4)
    return wheelset.view(np.float64)


def test_measures_begin_alike_whatever_the_record_held():
    np.testing.assert_array_equal(begun(7.0), begun(0.0))


def test_extremes_of_slide_force_and_disc_temperature(samples, stop):
    expected = slides(samples)[observed(samples)].max(axis=0)
    np.testing.assert_array_equal(stop[1].maximum_slide, expected)
    np.testing.assert_array_equal(stop[1].maximum_clamping_force, samples.clamping_force[1:].max(axis=0))
    # The record of the last wheelset holds no temperature.
    np.testing.assert_array_equal(stop[1].maximum_disc_temperature, samples.disc_temperature[1:].max(axis=0))
    assert np.isnan(stop[1].maximum_disc_temperature).tolist() == [False, False, False, True]


@pytest.mark.parametrize("k", range(SPEED_CLASSES))
def test_largest_slide_above_a_train_speed(samples, stop, k):
    """Classes of 10 km/h; NaN for speeds that the train never had."""
    faster = observed(samples) & (samples.speed > 10 * k / 3.6)
    expected = slides(samples)[faster].max(axis=0) if faster.any() else np.full(4, np.nan)
    np.testing.assert_array_equal(stop[1].maximum_slide_above[:, k], expected)


def test_times_spent_sliding_and_locked_and_openings_of_the_vent(samples, stop):
    slip = samples.speed[:, None] - samples.wheel_speed
    sliding = observed(samples)[:, None] & (slides(samples) > 0.05) & (slip > 0.3)
    np.testing.assert_allclose(stop[1].sliding_duration, INTERVAL * sliding.sum(axis=0), rtol=1e-9)
    first = np.where(sliding.any(axis=0), samples.time[sliding.argmax(axis=0)], np.nan)
    np.testing.assert_array_equal(stop[1].first_sliding_time, first)
    locked = observed(samples)[:, None] & (samples.wheel_speed < 0.1)
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

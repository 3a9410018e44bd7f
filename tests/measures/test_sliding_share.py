"""The share of time in which wheelsets slide, on courses of speed whose shares are known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from uictest.core.measures import MEASURES, STOP_MEASURES, WHEELSET_MEASURES, begin_slow_times
from uictest.core.measures.records import END_SPEEDS, SLOW_TIMES
from uictest.core.measures.wheelset import keep_slow_times

KMH = 1.0 / 3.6
DEFINITION = {"sliding_below": 0.9, "end_speed": 60.0 * KMH}
STEP = 0.25
"""s: sums of it are exact."""


def measured(speed, wheel_speed, step=STEP):
    """Return the records after samples of the train's speed and of (samples, 4) wheel speeds, m/s."""
    train, wheelsets = np.zeros(1, STOP_MEASURES)[0], np.zeros(4, WHEELSET_MEASURES)
    begin_slow_times(train, wheelsets)
    train["initial_speed"] = speed[0]
    for k in range(1, len(speed)):
        train["previous_time"], train["end_time"], train["end_speed"] = (k - 1) * step, k * step, speed[k]
        wheelsets["wheel_speed"] = wheel_speed[k]
        keep_slow_times(train, wheelsets, train, wheelsets)
    return train.view(np.recarray), wheelsets.view(np.recarray)


def share(records, **definition):
    return MEASURES["sliding_share"].read(*records, {**DEFINITION, **definition})


def shares(records, **definition):
    return MEASURES["sliding_share_of_wheelsets"].read(*records, {**DEFINITION, **definition})


def even_stop(seconds=40.0, initial=120.0):
    """Speeds of an even stop from 120 km/h, which runs at 60 km/h in its middle."""
    count = round(seconds / STEP)
    return 5.0 * (initial - initial * np.arange(count + 1) / count) / 18.0


def rolling(speed):
    return np.repeat(np.asarray(speed)[:, None], 4, axis=1)


def slid(speed, first, last, wheelsets, ratio=0.8):
    """Let wheelsets turn at a ratio of the train's speed in the samples after `first` s until `last` s."""
    wheels = rolling(speed)
    time = STEP * np.arange(len(speed))
    for i in wheelsets:
        wheels[(time > first) & (time <= last), i] *= ratio
    return wheels


def test_half_of_the_wheelsets_at_once_suffice_and_less_or_one_after_another_never_counts():
    """Sliding 5 of the 20 s that lead to 60 km/h, two wheelsets at once: a quarter."""
    speed = even_stop()
    records = measured(speed, slid(speed, 5.0, 10.0, [1, 3]))
    assert share(records).values == (0.25,)
    assert shares(records).values == (0.0, 0.25, 0.0, 0.25)
    assert share(measured(speed, slid(speed, 0.0, 20.0, [2]))).values == (0.0,)
    assert share(measured(speed, np.full_like(rolling(speed), math.nan))).values == (0.0,)
    # Each has its share, and the reading wheelset by wheelset says more than that of half at once.
    wheels = slid(speed, 2.0, 8.0, [0])
    wheels[:, 1] = slid(speed, 8.0, 14.0, [1])[:, 1]
    records = measured(speed, wheels)
    assert share(records).values == (0.0,)
    assert shares(records).values == pytest.approx((0.3, 0.3, 0.0, 0.0))


@pytest.mark.parametrize(("below", "factor"), [(0.85, 0.85), (0.9, 0.9), (0.95, 0.95)])
def test_a_wheelset_at_exactly_the_share_of_the_speed_does_not_slide(below, factor):
    speed = even_stop()
    at = rolling(speed)
    at[:, :2] = factor * speed[:, None]
    assert share(measured(speed, at), sliding_below=below).values == (0.0,)
    just_below = np.nextafter(at, 0.0)
    just_below[:, 2:] = speed[:, None]
    assert share(measured(speed, just_below), sliding_below=below).values == (1.0,)


def test_time_counts_until_the_first_sample_at_sixty_and_not_after_it():
    """At exactly 60 km/h the interval ends, also where the train gains speed again."""
    speed = np.array([120.0, 100.0, 80.0, 60.0, 70.0, 50.0, 0.0]) * KMH
    slides_until, slides_after = rolling(speed), rolling(speed)
    slides_until[:4] *= 0.5
    slides_after[4:] *= 0.5
    assert share(measured(speed, slides_until)).values == (1.0,)
    assert share(measured(speed, slides_after)).values == (0.0,)
    assert share(measured(speed, slides_after), end_speed=50.0 * KMH).values == pytest.approx((2 / 5,))


def test_the_share_down_to_each_speed():
    """Sliding from 80 to 50 km/h of an even stop from 120: down to v it is (80 - v) of 120 - v."""
    speed = even_stop(60.0)
    records = measured(speed, slid(speed, 20.0, 35.0, [0, 1]))
    for end in range(10, 101, 10):
        expected = max(0, 80 - max(end, 50)) / (120 - end)
        assert share(records, end_speed=end * KMH).values == pytest.approx((expected,)), end


@pytest.mark.parametrize("initial", [60.0, 45.0])
def test_a_stop_from_sixty_or_less_has_no_share_whatever_follows(initial):
    speed = even_stop(initial=initial)
    value = share(measured(speed, rolling(speed)))
    assert value.values == ()
    assert value.whatever_follows
    assert "60 km/h" in value.unavailable_reason
    speed = even_stop()[:60]  # which never came down to it
    value = share(measured(speed, rolling(speed)))
    assert value.values == ()
    assert not value.whatever_follows


def test_plain_objects_and_records_agree():
    """Recorded stops are observed with objects, simulated ones with records."""
    speed = even_stop()
    wheels = slid(speed, 3.0, 17.25, [0, 1, 2], 0.87)
    record, records = measured(speed, wheels)
    train = SimpleNamespace(reached_time=[0.0] * len(END_SPEEDS), half_slow_time=[7.0] * SLOW_TIMES)
    own = [SimpleNamespace(slow_time=[7.0] * SLOW_TIMES) for _ in range(4)]
    begin_slow_times(train, own)
    for k in range(1, len(speed)):
        train.previous_time, train.end_time, train.end_speed = (k - 1) * STEP, k * STEP, speed[k]
        for wheelset, wheel_speed in zip(own, wheels[k], strict=True):
            wheelset.wheel_speed = wheel_speed
        keep_slow_times(train, own, train, own)
    np.testing.assert_array_equal(train.half_slow_time, record.half_slow_time)
    np.testing.assert_array_equal(train.reached_time, record.reached_time)
    for wheelset, kept in zip(own, records, strict=True):
        np.testing.assert_array_equal(wheelset.slow_time, kept.slow_time)

"""Pole wheels: what passes the sensor, what it counts, and how old the speed of whole teeth is."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.sensors import (
    last_tooth,
    passed_turns,
    passing_rate,
    sine_of_turns,
    speed_of_teeth,
    time_since,
)


@given(st.floats(-1e4, 1e4))
def test_the_sine_is_that_of_the_library(turns):
    whole = turns - math.floor(turns)
    assert sine_of_turns(turns) == pytest.approx(math.sin(2.0 * math.pi * whole), abs=2e-15)


def test_an_eccentric_wheel_errs_once_per_turn_by_its_amplitude():
    turns = np.linspace(3.0, 4.0, 4001)
    errors = np.array([passing_rate(float(x), 0.01) for x in turns]) - 1.0
    assert errors.max() == pytest.approx(0.01, rel=1e-6)
    assert errors.min() == pytest.approx(-0.01, rel=1e-6)
    assert errors[:-1].mean() == pytest.approx(0.0, abs=1e-12)
    assert np.count_nonzero(np.diff(np.sign(errors[1:-1]))) == 1 + 1 * (errors[2000] == 0.0)


@given(st.floats(0.0, 1e3), st.floats(0.0, 0.5))
def test_a_whole_turn_passes_whole(turns, eccentricity):
    """An eccentric wheel has neither more nor fewer teeth."""
    passed = passed_turns(turns + 1.0, eccentricity) - passed_turns(turns, eccentricity)
    assert passed == pytest.approx(1.0, abs=1e-11)


@given(st.floats(0.0, 100.0), st.floats(0.0, 0.5))
def test_what_passes_grows_at_the_passing_rate(turns, eccentricity):
    h = 1e-5
    slope = (passed_turns(turns + h, eccentricity) - passed_turns(turns - h, eccentricity)) / (2.0 * h)
    assert slope == pytest.approx(passing_rate(turns, eccentricity), abs=1e-6)


@given(st.floats(0.0, 1e5), st.integers(2, 200), st.integers(0, 5))
def test_teeth_are_counted_one_by_one(place, teeth, missing):
    """Against a wheel whose teeth are written out."""
    missing = min(missing, teeth - 1)
    there = (
        [pitch for pitch in range(math.floor(place) + 1) if pitch % teeth < teeth - missing]
        if place < 2e3
        else None
    )
    counted, tooth = last_tooth(place, float(teeth), float(missing))
    assert 0.0 <= place - tooth < missing + 1.0
    assert tooth % teeth < teeth - missing
    if there is not None:
        assert (counted, tooth) == (len(there) - 1, there[-1])


@given(
    rate=st.floats(0.1, 2000.0),
    change=st.floats(-50.0, 50.0),
    share=st.floats(0.0, 1.0),
    interval=st.floats(0.001, 0.1),
)
def test_the_time_since_a_tooth_is_that_of_even_acceleration(rate, change, share, interval):
    before = max(rate - change * interval, 0.0)
    change = (rate - before) / interval
    ago = share * interval
    distance = rate * ago - 0.5 * change * ago * ago
    assert time_since(distance, rate, before, interval) == pytest.approx(ago, rel=1e-6, abs=1e-6 * interval)


def test_the_timer_counts_ticks_and_a_wheel_that_stands_has_passed_nothing():
    assert time_since(0.0, 0.0, 0.0, 0.01) == 0.0
    assert math.isfinite(time_since(0.5, 0.0, 0.0, 0.01))
    assert speed_of_teeth(2.0, 0.03, 0.0104, 0.001) == pytest.approx(0.06 / 0.010)
    assert speed_of_teeth(2.0, 0.03, 0.0106, 0.001) == pytest.approx(0.06 / 0.011)


@pytest.mark.parametrize("deceleration", [0.0, 1.0, 4.0])
def test_the_speed_of_whole_teeth_is_the_true_one_in_the_middle_of_their_interval(deceleration):
    """At constant deceleration the mean over an interval is the speed at the middle of it."""
    pitch, speed = 0.03, 10.0
    times = (
        [(speed - math.sqrt(speed**2 - 2.0 * deceleration * n * pitch)) / deceleration for n in (4, 9)]
        if deceleration
        else [n * pitch / speed for n in (4, 9)]
    )
    reading = speed_of_teeth(5.0, pitch, times[1] - times[0], 1e-12)
    assert reading == pytest.approx(speed - deceleration * 0.5 * (times[0] + times[1]), rel=1e-9)

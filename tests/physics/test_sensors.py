"""Sensors: what they make of quantities, their noise, and pole wheels that are counted by the tooth."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.sensors import (
    analogue_reading,
    bell,
    last_tooth,
    passed_turns,
    passing_rate,
    rounded_to_whole,
    sine_of_turns,
    speed_of_teeth,
    speed_reading,
    threefry,
    time_since,
)

PITCH = 2.0 * math.pi * 0.43 / 80
TICK = 1e-6
CYCLE = 0.01
SLOWEST = 0.14


def reading(speed, noise=0.0):
    return speed_reading(speed, PITCH, TICK, CYCLE, SLOWEST, noise)


@given(st.floats(SLOWEST, 100.0))
def test_speed_is_off_by_half_a_tick_of_the_timer_at_most(speed):
    """The timer counts over the teeth of a whole cycle, or over one tooth where that takes longer."""
    counted = max(math.floor(speed * CYCLE / PITCH), 1) * PITCH / speed
    bound = 0.5 * TICK / (counted - 0.5 * TICK)
    assert abs(reading(speed) / speed - 1.0) <= bound * (1.0 + 1e-6)
    # A cycle of 10 ms holds ten thousand ticks; at least half of it lies between teeth that are counted.
    assert reading(speed) == pytest.approx(speed, rel=2e-4)


@given(st.floats(-5.0, SLOWEST, exclude_max=True), st.floats(SLOWEST, 100.0))
def test_a_wheel_slower_than_the_time_out_reads_zero_and_noise_is_relative(slow, fast):
    assert reading(slow, noise=0.1) == 0.0
    assert reading(fast, noise=1e-3) == pytest.approx(reading(fast) * 1.001, rel=1e-14)


@given(st.floats(0.0, 1e6), st.floats(-0.01, 0.01), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_analogue_sensor_adds_its_errors_and_stays_within_its_range(value, gain_error, offset, noise):
    step = 2.0**-4
    read = analogue_reading(value, gain_error, offset, noise, 1e6, step, 1.0 / step)
    assert 0.0 <= read <= 1e6
    if 1e5 < value < 9e5:
        assert abs(read - value) <= abs(gain_error) * value + abs(offset) + abs(noise) + step


@given(st.floats(-1e12, 1e12), st.floats(0.0, 9e5), st.floats(1e-3, 1e4))
def test_reading_is_the_nearest_step_of_the_converter(x, value, resolution):
    """Rounded as by Python: ties go to the even neighbour."""
    assert rounded_to_whole(x) == round(x)
    read = analogue_reading(value, 0.0, 0.0, 0.0, 1e6, resolution, 1.0 / resolution)
    assert abs(read - value) <= 0.5 * resolution * (1.0 + 1e-6)
    assert read / resolution == pytest.approx(round(read / resolution), abs=1e-6)


ALL_ONES = 0xFFFFFFFF
# Known answers of the authors' Random123 library (kat_vectors): key, counter, random bits.
KNOWN_ANSWERS = [
    ((0, 0), (0, 0), (0x6B200159, 0x99BA4EFE)),
    ((ALL_ONES, ALL_ONES), (ALL_ONES, ALL_ONES), (0x1CB996FC, 0xBB002BE7)),
    ((0x13198A2E, 0x03707344), (0x243F6A88, 0x85A308D3), (0xC4923A9C, 0x483DF7A0)),
]
DRAWS = 1 << 15


@pytest.mark.parametrize(("key", "counter", "bits"), KNOWN_ANSWERS)
def test_known_answers_hold_also_for_the_integers_of_a_record(key, counter, bits):
    """Numpy's signed 64-bit integers must not overflow in the rotations."""
    assert threefry(*key, *counter) == bits
    assert threefry(*map(np.int64, key), *map(np.int64, counter)) == bits


@pytest.fixture(scope="module")
def draws():
    """One channel's noise over many samples."""
    return np.array([bell(*threefry(7, 11, sample, 3)) for sample in range(DRAWS)])


def test_bell_has_the_moments_of_four_uniform_numbers_and_successive_samples_are_unrelated(draws):
    """The excess kurtosis of one uniform number is -6/5, that of a sum of n is -6/(5 n)."""
    assert bell(ALL_ONES, ALL_ONES) == -bell(0, 0) < 2.0 * math.sqrt(3.0)
    error = 4.0 / math.sqrt(DRAWS)
    assert draws.mean() == pytest.approx(0.0, abs=error)
    assert draws.var() == pytest.approx(1.0, abs=error * math.sqrt(1.7))
    assert np.mean(draws**3) == pytest.approx(0.0, abs=error * math.sqrt(10.0))
    assert np.mean(draws**4) == pytest.approx(3.0 - 6.0 / 20.0, abs=error * math.sqrt(40.0))
    correlations = [np.mean(draws[lag:] * draws[:-lag]) for lag in (1, 2, 20)]
    np.testing.assert_allclose(correlations, 0.0, atol=4.0 / math.sqrt(DRAWS))


def test_channels_seeds_and_cases_are_unrelated():
    keys = list(product((0, 1), (0, 1), (0, 1)))
    series = [[bell(*threefry(seed, case, k, channel)) for k in range(2000)] for seed, case, channel in keys]
    correlations = np.corrcoef(series) - np.eye(len(keys))
    np.testing.assert_allclose(correlations, 0.0, atol=5.0 / math.sqrt(2000))


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
def test_what_passes_grows_at_the_passing_rate_and_by_one_in_a_whole_turn(turns, eccentricity):
    """An eccentric wheel has neither more nor fewer teeth."""
    passed = passed_turns(turns + 1.0, eccentricity) - passed_turns(turns, eccentricity)
    assert passed == pytest.approx(1.0, abs=1e-11)
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

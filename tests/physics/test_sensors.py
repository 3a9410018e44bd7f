"""What sensors make of the quantities they measure, and their noise."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.sensors import analogue_reading, bell, rounded_to_whole, speed_reading, threefry

PITCH = 2.0 * math.pi * 0.43 / 80
TICK = 1e-6
CYCLE = 0.01
SLOWEST = 0.14


def reading(speed, noise=0.0):
    return speed_reading(speed, PITCH, TICK, CYCLE, SLOWEST, noise)


@given(st.floats(SLOWEST, 100.0))
def test_speed_is_off_by_no_more_than_half_a_tick_of_the_timer(speed):
    """The timer counts over the teeth of a whole cycle, or over one tooth where that takes longer."""
    counted = max(math.floor(speed * CYCLE / PITCH), 1) * PITCH / speed
    bound = 0.5 * TICK / (counted - 0.5 * TICK)
    assert abs(reading(speed) / speed - 1.0) <= bound * (1.0 + 1e-6)


@given(st.floats(SLOWEST, 100.0))
def test_speed_is_within_a_tenth_of_a_per_mille_with_a_microsecond_timer(speed):
    """A cycle of 10 ms holds ten thousand ticks; at least half of it lies between teeth that are counted."""
    assert reading(speed) == pytest.approx(speed, rel=2e-4)


@given(st.floats(-5.0, SLOWEST, exclude_max=True))
def test_a_wheel_slower_than_the_time_out_reads_zero(speed):
    assert reading(speed, noise=0.1) == 0.0


def test_noise_is_relative():
    assert reading(20.0, noise=1e-3) == pytest.approx(reading(20.0) * 1.001, rel=1e-14)


@given(st.floats(0.0, 1e6), st.floats(-0.01, 0.01), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_analogue_sensor_adds_its_errors_and_stays_within_its_range(value, gain_error, offset, noise):
    step = 2.0**-4
    read = analogue_reading(value, gain_error, offset, noise, 1e6, step, 1.0 / step)
    assert 0.0 <= read <= 1e6
    if 1e5 < value < 9e5:
        assert abs(read - value) <= abs(gain_error) * value + abs(offset) + abs(noise) + step


@given(st.floats(-1e12, 1e12))
def test_nearest_whole_number(x):
    """As Python's own rounding: ties go to the even neighbour."""
    assert rounded_to_whole(x) == round(x)


@given(st.floats(0.0, 9e5), st.floats(1e-3, 1e4))
def test_reading_is_the_nearest_step_of_the_converter(value, resolution):
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
def test_known_answers(key, counter, bits):
    assert threefry(*key, *counter) == bits


def test_known_answers_hold_for_the_integers_of_a_record_and_the_bell_is_bounded_and_symmetric():
    """Numpy's signed 64-bit integers must not overflow in the rotations."""
    key, counter, bits = KNOWN_ANSWERS[1]
    assert threefry(*map(np.int64, key), *map(np.int64, counter)) == bits
    assert bell(ALL_ONES, ALL_ONES) == -bell(0, 0) < 2.0 * math.sqrt(3.0)


@pytest.fixture(scope="module")
def draws():
    """One channel's noise over many samples."""
    return np.array([bell(*threefry(7, 11, sample, 3)) for sample in range(DRAWS)])


def test_bell_has_the_moments_of_four_uniform_numbers_and_successive_samples_are_unrelated(draws):
    """The excess kurtosis of one uniform number is -6/5, that of a sum of n is -6/(5 n)."""
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

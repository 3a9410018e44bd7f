"""Values of measures."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.measures import MEASURES, WHEELSET_MEASURES, MeasureValue, wheelset_column_values
from uictest.core.measures.catalogue.deceleration import initial_adhesion
from uictest.core.measures.catalogue.sliding import maximum_slide_above_cutoff
from uictest.core.measures.catalogue.stopping import (
    braking_distance,
    braking_time,
    corrected_distance,
    mean_deceleration,
    standstill,
)

from .conftest import sliding_stop, stop, wheelsets

G = 9.80665


def test_an_even_deceleration_is_found_whatever_the_first_phase_and_speed_is_linear_between_seconds():
    for duration in (0.3, 1.0, 2.75, 10.0):
        (value,) = initial_adhesion(sliding_stop(0.07 * G), duration).values
        assert value == pytest.approx(0.07 * G, rel=1e-12)
    speed = [30.0, 29.0, 27.0] + [20.0] * 8
    (value,) = initial_adhesion(sliding_stop(speed_after_sliding=speed), 1.5).values
    assert value == pytest.approx((30.0 - 28.0) / 1.5)
    assert "no wheelset slid" in initial_adhesion(stop(), 3.0).unavailable_reason


@pytest.mark.parametrize("end", [math.nan, 0.0])
def test_a_stop_over_within_the_first_phase_supports_none(end):
    # Counting the time after standstill would make a short last slide look like a slippery rail.
    speed = np.array([2.0, 1.0, end, *[end] * 8])
    measures = sliding_stop(speed_after_sliding=speed)
    assert initial_adhesion(measures, 1.0).values == (1.0,)
    assert "ended within 1.5 s" in initial_adhesion(measures, 1.5).unavailable_reason
    assert "ended within 3 s" in initial_adhesion(measures, 3.0).unavailable_reason


HIGHEST = MEASURES["maximum_disc_temperature"]


def wheelsets_at(*temperatures):
    records = np.zeros(4, WHEELSET_MEASURES).view(np.recarray)
    records.maximum_disc_temperature = temperatures
    return records


def test_disc_temperatures_are_reported_in_degrees_and_bounded_in_kelvin():
    hot = wheelsets_at(373.15, 383.15, 373.15, 373.15)
    assert HIGHEST.read(None, hot, {}).values == (373.15, 383.15, 373.15, 373.15)
    assert wheelset_column_values(hot[1])["maximum_disc_temperature_degc"] == pytest.approx(110.0)


def test_without_a_model_of_the_discs_the_measure_says_which_key_asks_for_it():
    cold = wheelsets_at(*[math.nan] * 4)
    value = HIGHEST.read(None, cold, {})
    assert value.values == ()
    assert "brake.disc_temperature" in value.unavailable_reason
    assert math.isnan(wheelset_column_values(cold[0])["maximum_disc_temperature_degc"])


def value(name, stop, wheelsets):
    records = [SimpleNamespace(**each) for each in wheelsets]
    return MEASURES[name].read(SimpleNamespace(**stop), records, {})


FAULT = {"fault_time": 3.0, "reference_excess": 1.5}
NO_FAULT = {"fault_time": math.nan, "reference_excess": math.nan}
LOCKS = [
    {"faulty": 0.0, "longest_lock": 0.4, "longest_release": math.nan},
    {"faulty": 1.0, "longest_lock": 9.0, "longest_release": 2.5},
]


def test_the_locks_of_sound_wheelsets_the_longest_release_and_the_excess_of_a_faulty_stop():
    assert value("longest_lock_of_sound_wheelsets", FAULT, LOCKS).values == (0.4,)
    assert value("longest_lock_of_sound_wheelsets", FAULT, LOCKS[1:]).unavailable_reason
    assert value("longest_lock_of_sound_wheelsets", NO_FAULT, LOCKS).unavailable_reason
    assert value("longest_release", FAULT, LOCKS).values == (2.5,)
    assert value("longest_release", FAULT, LOCKS[:1]).unavailable_reason
    assert value("reference_excess", FAULT, LOCKS).values == (1.5,)
    assert "no fault" in value("reference_excess", NO_FAULT, LOCKS).unavailable_reason
    without = {"fault_time": 3.0, "reference_excess": math.nan}
    assert "no reference speed" in value("reference_excess", without, LOCKS).unavailable_reason


KMH = 1 / 3.6


def test_slides_below_the_cutoff_do_not_count_and_none_above_it_is_none():
    records = wheelsets(0.9, 0.9)
    records.maximum_slide_above[:, 4:] = [[0.2], [0.3]]
    assert maximum_slide_above_cutoff(stop(), records, 30 * KMH).values == (0.9, 0.9)
    assert maximum_slide_above_cutoff(stop(), records, 40 * KMH).values == (0.2, 0.3)
    reading = maximum_slide_above_cutoff(stop(initial_speed=25 * KMH), wheelsets(0.9), 30 * KMH)
    assert reading.unavailable_reason == "the train never ran faster than the cut-off of 30 km/h"
    assert maximum_slide_above_cutoff(stop(), wheelsets(np.nan, np.nan), 30 * KMH).unavailable_reason


def test_a_distance_of_a_stop_is_a_mean_deceleration_and_grows_while_the_train_runs():
    (short,), (long,) = (mean_deceleration(stop(braking_distance=s)).values for s in (440.0, 490.0))
    assert short == pytest.approx(1.263, abs=5e-4)
    assert long == pytest.approx(1.134, abs=5e-4)
    running = stop(stopped=0.0, end_speed=12.0, end_time=180.0, end_distance=2500.0)
    assert braking_distance(running).values == (2500.0,)
    assert braking_time(running).values == (180.0,)
    assert mean_deceleration(running).values == (pytest.approx((120 / 3.6) ** 2 / 5000.0),)
    assert standstill(running) == MeasureValue(unavailable_reason="no standstill")


NOMINAL = {"nominal_speed": 120 / 3.6, "gradient": 0.0}


@given(st.floats(0.1, 5000.0))
def test_a_distance_from_the_nominal_speed_on_level_track_keeps_its_bits(distance):
    stop = SimpleNamespace(initial_speed=120 / 3.6)
    assert corrected_distance(distance, stop, NOMINAL) == distance


@pytest.mark.parametrize("gradient", [-0.03, -0.002, 0.0, 0.03])
@pytest.mark.parametrize("speed", [117 / 3.6, 123 / 3.6])
def test_even_braking_gives_the_same_distance_from_any_speed_on_any_gradient(speed, gradient):
    level = 0.9
    run = speed**2 / (2.0 * (level + 9.80665 * gradient))
    stop = SimpleNamespace(initial_speed=speed)
    corrected = corrected_distance(run, stop, {**NOMINAL, "gradient": gradient})
    assert corrected == pytest.approx((120 / 3.6) ** 2 / (2.0 * level))


def test_a_train_that_only_the_weight_slows_never_stops_on_level_track():
    stop = SimpleNamespace(initial_speed=30.0)
    coasted = 30.0**2 / (2.0 * 9.80665 * 0.03)
    assert corrected_distance(1.0001 * coasted, stop, {**NOMINAL, "gradient": 0.03}) == math.inf
    assert math.isnan(corrected_distance(math.nan, stop, NOMINAL))

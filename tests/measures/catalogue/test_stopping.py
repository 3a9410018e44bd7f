import math
from types import SimpleNamespace

import pytest
from hypothesis import given, strategies as st

from uictest.core.measures import MeasureValue
from uictest.core.measures.catalogue.stopping import (
    braking_distance,
    braking_time,
    corrected_distance,
    mean_deceleration,
    standstill,
)


def test_440_to_490_m_from_120_km_h_are_1_263_to_1_134_m_per_s2(stop):
    (short,), (long,) = (mean_deceleration(stop(braking_distance=s)).values for s in (440.0, 490.0))
    assert short == pytest.approx(1.263, abs=5e-4)
    assert long == pytest.approx(1.134, abs=5e-4)


def test_up_to_now_a_train_still_running_has_run_a_distance_that_can_only_grow(stop):
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

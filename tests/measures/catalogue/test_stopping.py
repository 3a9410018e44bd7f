import pytest

from uictest.core.measures import MeasureValue
from uictest.core.measures.catalogue.stopping import (
    braking_distance,
    braking_time,
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

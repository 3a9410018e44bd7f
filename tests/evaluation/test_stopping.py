import pytest

from uictest.evaluation.stopping import braking_distance, braking_time, mean_deceleration, standstill


def test_440_to_490_m_from_120_km_h_are_1_263_to_1_134_m_per_s2(stop) -> None:
    (short,), (long,) = (mean_deceleration(stop(braking_distance=s)).values for s in (440.0, 490.0))
    assert short == pytest.approx(1.263, abs=5e-4)
    assert long == pytest.approx(1.134, abs=5e-4)


def test_a_train_still_running_has_no_braking_distance_but_a_least_one(stop) -> None:
    running = stop(stopped=0.0, end_speed=12.0, end_time=180.0, end_distance=2500.0)
    for reading, least in ((braking_distance(running), 2500.0), (braking_time(running), 180.0)):
        assert reading.at_least
        assert reading.values == (least,)
        assert reading.missing == "the train still ran at 43.2 km/h when the record ended after 180 s"
    assert mean_deceleration(running).values == ()
    assert standstill(running).values == (0.0,)
    assert standstill(running).remark == braking_distance(running).missing

import pytest

from studies.experiments.field_against_rig import QUANTITIES
from studies.field.assumptions import REAL_TRAIN, TOLERANCES, FieldStop, even_braking_delay
from studies.quantity import OwnBand


def _stop(**figures):
    return FieldStop({**REAL_TRAIN, **figures}, (11, 12, 11, 12), 0.4)


def test_the_data_are_those_of_the_source_and_bands_are_their_tolerances():
    run = {"braking_time": 17.6, "braking_distance": 197.0}
    assert dict(REAL_TRAIN) == {**run, "minimum_deceleration": 0.98, "maximum_deceleration": 1.52}
    assert {quantity.key for quantity in QUANTITIES} >= REAL_TRAIN.keys()
    bands = {each.key: each.band for each in QUANTITIES if each.key in REAL_TRAIN}
    assert bands.keys() == REAL_TRAIN.keys()
    for name, band in bands.items():
        assert isinstance(band, OwnBand)
        assert band.lower == pytest.approx(REAL_TRAIN[name] - TOLERANCES[name])
        assert band.upper == pytest.approx(REAL_TRAIN[name] + TOLERANCES[name])


def test_the_real_train_fits_itself_and_a_stop_without_end_fits_nothing():
    assert _stop().misfit == 0.0
    endless = _stop(braking_time=float("nan"), braking_distance=float("nan"))
    assert endless.misfit == float("inf")
    assert not endless.agrees
    assert not endless.agrees_in_run


def test_a_misfit_counts_tolerances_and_a_stop_can_agree_in_time_and_distance_alone():
    assert _stop(braking_distance=205.0).misfits["braking_distance"] == pytest.approx(2.0)
    assert _stop(braking_distance=189.0).misfits["braking_distance"] == pytest.approx(2.0)
    assert _stop(braking_distance=199.0, minimum_deceleration=1.28).misfit == pytest.approx(3.0)
    brakes_harder = _stop(braking_time=17.9, maximum_deceleration=1.8)
    assert brakes_harder.agrees_in_run
    assert not brakes_harder.agrees


def test_an_even_deceleration_after_the_delay_takes_the_time_and_the_distance():
    speed, delay = 80.0 / 3.6, even_braking_delay()
    deceleration = speed / (17.6 - delay)
    assert delay * speed + speed**2 / (2.0 * deceleration) == pytest.approx(197.0)

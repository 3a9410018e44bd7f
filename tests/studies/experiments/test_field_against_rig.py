from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from uictest.studies.experiments.field_against_rig import (
    BREAKS,
    PAD_FACTORS,
    QUANTITIES,
    REAL_TRAIN,
    STUDY,
    misfit,
    profiles,
)


def _stop(**measures: float) -> Any:
    return SimpleNamespace(measures={**REAL_TRAIN, **measures})


def test_the_data_are_those_of_the_source() -> None:
    assert REAL_TRAIN == {
        "braking_time": 17.6,
        "braking_distance": 197.0,
        "minimum_deceleration": 0.98,
        "maximum_deceleration": 1.52,
    }
    assert {quantity.key for quantity in QUANTITIES} >= REAL_TRAIN.keys()
    assert STUDY.name == "field-against-rig"


def test_the_real_train_fits_itself_and_a_stop_without_end_fits_nothing() -> None:
    assert max(misfit(_stop()).values()) == 0.0
    assert misfit(_stop(braking_time=float("nan")))["braking_time"] == float("inf")


def test_misfit_counts_tolerances() -> None:
    assert misfit(_stop(braking_distance=205.0))["braking_distance"] == pytest.approx(2.0)


def test_every_profile_is_tried_once_with_every_strength_of_the_brake() -> None:
    tried = list(profiles())
    assert len(set(tried)) == len(tried)
    assert {profile.pad_factor for profile in tried} == set(PAD_FACTORS)
    assert {profile.place for profile in tried} == {None, *BREAKS}

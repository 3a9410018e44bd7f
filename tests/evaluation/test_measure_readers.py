import numpy as np
import pytest

from uictest.evaluation.measure_readers import MEASURE_READERS, read
from uictest.measures.records import DEFINITION as DEFINITION_FIELDS
from uictest.scenario.parts.measure_catalogue import MEASURES as CATALOGUE

DEFINITION = {"first_phase_duration": 3.0, "low_speed_cutoff": 30 / 3.6}


def test_what_a_criteria_file_can_name_is_what_can_be_measured() -> None:
    assert set(MEASURE_READERS) == set(CATALOGUE)


@pytest.mark.parametrize("name", CATALOGUE)
def test_each_measure_gives_one_value_for_the_stop_or_one_per_wheelset(
    name: str, sliding_stop, wheelsets
) -> None:
    reading = read(name, sliding_stop(), wheelsets(0.1, 0.2, 0.3, 0.4), DEFINITION)
    assert not reading.missing
    assert len(reading.values) == (4 if CATALOGUE[name].of_wheelsets else 1)


def test_what_decides_an_observation_is_a_definition_of_the_measures() -> None:
    deciding = {name for measure in CATALOGUE.values() for name in measure.observed_by}
    assert deciding == {name for name, _ in DEFINITION_FIELDS}


def test_a_residual_counts_by_its_magnitude(stop, wheelsets) -> None:
    assert read("energy_residual", stop(energy_residual=-0.5), wheelsets(0.1), {}).values == (0.5,)


def test_air_is_measured_as_normal_volume(stop, wheelsets) -> None:
    (volume,) = read("air_consumed", stop(air_consumed=0.1185), wheelsets(0.1), {}).values
    assert volume == pytest.approx(0.1)


def test_a_brake_never_developed_has_no_least_deceleration(stop, wheelsets) -> None:
    reading = read("minimum_deceleration", stop(minimum_deceleration=np.nan), wheelsets(0.1), {})
    assert reading.missing == "the brake was never fully developed while the train ran"

"""What is computed along a foreign record is what the rig itself computes; a refusal stays one."""

import math

import numpy as np
import pytest

from studies.identified_module import WAYS, Fits, air_of, errors, identified, shipped, unknowns
from studies.model_errors import force_error, pressure_error
from studies.replay import maximum_pressure, replayed
from uictest import Recording


@pytest.fixture(scope="module")
def replay(stop_runner):
    """Return the slide test and the replay of its first wheelset on the library's bench."""
    (case,) = stop_runner.cases("slide-80-four-caliper")
    (stop,) = stop_runner.recordings([case])
    return case, replayed(case, stop, 1)


def test_the_compensation_that_ships_errs_along_a_record_as_it_does_on_the_rig(replay):
    case, record = replay
    top = maximum_pressure(case)
    found = errors(record, shipped(case.scenario.rig.compensation_model), case, top)
    assert set(found) == set(WAYS)
    for way, setting, channel in (("nothing", "none", "hysteresis"), ("thermal", "thermal", "thermal")):
        assert found[way].pressure_error == pytest.approx(pressure_error(record, setting, top), abs=0.03)
        force = force_error(record, f"computed_force_{channel}_2")
        assert found[way].force_error == pytest.approx(force, abs=0.05)


def test_time_beyond_the_bound_is_counted_and_what_was_not_identified_has_no_error(replay):
    case, record = replay
    top = maximum_pressure(case)
    off = np.abs(record["measured_pressure_2"] - record["cylinder_pressure_1"]) >= 0.02 * top
    assert 1.0 < 100.0 * off.mean() < 99.0
    found = errors(record, Fits(), case, top)
    assert found["nothing"].beyond == pytest.approx(100.0 * off.mean())
    assert math.isnan(found["full"].pressure_error) and math.isnan(found["thermal"].pressure_error)
    assert math.isnan(found["nothing"].force_error)


def test_a_record_that_is_refused_gives_no_numbers_but_the_reason(replay):
    case, record = replay
    still = {
        name: record[name] if name == "time" else np.zeros_like(record[name]) for name in record.channels
    }
    silent = Recording(still, record.units, {})
    found = identified(silent, silent, case)
    assert found.lines is found.cylinder is found.air["thermal"] is None
    assert set(found.refusals) == {"hysteresis", "full", "thermal"}
    assert "no excitation" in found.refusals["thermal"]
    assert all(math.isnan(error) for error in found.training.values())
    assert air_of(silent, case) is None


def test_the_numbers_of_an_air_are_those_that_its_model_takes(replay):
    air = replay[0].scenario.rig.compensation_model.air
    tank, caliper, swept, opening, gap = unknowns(air, 2e-3)
    assert (tank, caliper) == (air.tank_heat_conductance, air.caliper_heat_conductance)
    assert swept * 2e-3 == pytest.approx(air.swept_volume)
    assert opening + gap == pytest.approx(air.closing_pressure)

"""Equivalent build-up time against closed forms of a stop whose brake builds up evenly."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.measures import MEASURES, STOP_COLUMNS, begin_train, note_standstill
from uictest.core.measures.catalogue.stopping import (
    deceleration_distance,
    developed_deceleration,
    mean_deceleration,
)
from uictest.core.measures.train import observe_build_up, observe_train

from .conftest import STANDARD

COMMANDED = 3.8e5
DEFINITION = SimpleNamespace(**STANDARD)


class Braking:
    """A train that rolls at v0 for the dead time; its deceleration then grows evenly to `full`."""

    def __init__(self, v0, dead, rise, full):
        self.v0, self.dead, self.rise, self.full = v0, dead, rise, full
        self.speed_after_rise = v0 - full * rise / 2
        self.standstill = dead + rise + self.speed_after_rise / full

    def pressure(self, t):
        return COMMANDED * np.clip((t - self.dead) / self.rise, 0.0, 1.0)

    def speed(self, t):
        growing = np.clip(t - self.dead, 0.0, self.rise)
        steady = np.maximum(t - self.dead - self.rise, 0.0)
        return self.v0 - self.full * (growing**2 / (2 * self.rise) + steady)

    def distance(self, t):
        growing = np.clip(t - self.dead, 0.0, self.rise)
        steady = np.maximum(t - self.dead - self.rise, 0.0)
        lost = growing**3 / (6 * self.rise) + growing / 2 * steady + steady**2 / 2
        return self.v0 * t - self.full * lost


def observed(stop, interval, begin=0.0):
    """The measures of the train; at the end of the samples it stands."""
    times = np.arange(begin, stop.standstill, interval)
    rows = np.stack([times, stop.distance(times), stop.speed(times), stop.pressure(times)], axis=1).tolist()
    train = SimpleNamespace()
    begin_train(train, *rows[0][:3], 7e5, COMMANDED, rows[0][3])
    for time, distance, speed, pressure in rows[1:]:
        observe_build_up(train, DEFINITION, time, distance, speed, pressure)
        observe_train(train, DEFINITION, time, distance, speed, 7e5)
    end = np.array(stop.standstill)
    note_standstill(train, True, float(end), float(stop.distance(end)))
    return train


COLUMNS = {
    "deceleration_distance_m": deceleration_distance,
    "developed_deceleration_mps2": developed_deceleration,
}
STOP = Braking(v0=33.0, dead=0.4, rise=4.0, full=1.1)


def test_even_build_up_takes_its_dead_time_and_half_of_its_duration():
    train = observed(STOP, 0.01)
    assert train.build_up_time == pytest.approx(0.4 + 4.0 / 2, abs=1e-9)
    assert train.build_up_distance == pytest.approx(float(STOP.distance(np.array(2.4))), abs=1e-4)


@given(st.floats(20.0, 60.0), st.floats(0.0, 1.0), st.floats(0.5, 8.0), st.floats(0.6, 1.5))
def test_deceleration_distance_of_an_even_build_up(v0, dead, rise, full):
    """s - s(te), where s(te) = v0 te - a rise^2 / 48: half of the build-up is over."""
    stop = Braking(v0, dead, rise, full)
    te = dead + rise / 2
    expected = float(stop.distance(np.array(stop.standstill))) - (v0 * te - full * rise**2 / 48)
    (distance,) = deceleration_distance(observed(stop, 0.02)).values
    assert distance == pytest.approx(expected, abs=1e-3)


@given(st.floats(20.0, 60.0), st.floats(0.0, 2.0), st.floats(0.6, 1.5))
def test_brake_that_comes_at_once_has_its_own_deceleration_behind_the_dead_time(v0, dead, full):
    (deceleration,) = developed_deceleration(observed(Braking(v0, dead, 1e-6, full), 0.01)).values
    assert deceleration == pytest.approx(full, rel=1e-3)


def test_a_weaker_brake_keeps_its_share_of_the_developed_deceleration():
    """4 s of build-up, the same in both stops, make the mean deceleration of the weaker one look better."""
    full, weak = observed(STOP, 0.01), observed(Braking(v0=33.0, dead=0.4, rise=4.0, full=0.8 * 1.1), 0.01)
    (developed,), (reference,) = developed_deceleration(weak).values, developed_deceleration(full).values
    assert developed / reference == pytest.approx(0.8, abs=5e-4)
    (mean,), (reference,) = mean_deceleration(weak).values, mean_deceleration(full).values
    assert mean / reference > 0.82


def test_the_column_of_a_stop_that_ended_is_its_measure_which_falls_up_to_then():
    train = observed(STOP, 0.01)
    for column, measure in COLUMNS.items():
        assert STOP_COLUMNS[column].read(train, {}) == measure(train).values[0]
    train.stopped = 0.0
    train.end_distance = train.build_up_distance
    assert developed_deceleration(train).values == (float("inf"),)
    train.end_distance += 500.0
    assert developed_deceleration(train).values == (pytest.approx(33.0**2 / 1000.0),)


@pytest.mark.parametrize("interval", [0.02, 0.05, 0.1, 0.2])
def test_build_up_does_not_depend_on_when_the_samples_fall(interval):
    fine, coarse = observed(STOP, 0.001), observed(STOP, interval)
    assert coarse.build_up_time == pytest.approx(fine.build_up_time, abs=1e-6)
    assert coarse.build_up_distance == pytest.approx(fine.build_up_distance, abs=0.2 * interval**2)


def test_shares_of_the_pressure_are_parameters():
    other = SimpleNamespace(**vars(DEFINITION) | {"rising_share": 0.01, "developed_share": 0.5})
    train = SimpleNamespace()
    begin_train(train, 0.0, 0.0, 20.0, 7e5, COMMANDED, 0.0)
    observe_build_up(train, other, 4.0, 80.0, 20.0, COMMANDED)
    assert train.build_up_time == pytest.approx(4.0 * (0.01 + 0.5) / 2)


def test_pressure_that_comes_at_once_or_was_there_or_falls_again():
    train = observed(Braking(v0=20.0, dead=1.0, rise=1e-6, full=1.0), 0.01)
    assert train.build_up_time == pytest.approx(1.0, abs=0.01)
    # What comes late cannot be known; whether that counts is decided by what the record lacks.
    train = observed(STOP, 0.01, begin=6.0)
    assert train.build_up_time == pytest.approx(6.0)
    train = observed(STOP, 0.01)
    before = (train.build_up_time, train.build_up_distance)
    for pressure in (0.0, COMMANDED):
        observe_build_up(train, DEFINITION, 50.0, 700.0, 1.0, pressure)
    assert (train.build_up_time, train.build_up_distance) == before


def test_brake_that_never_builds_up_or_whose_pressure_is_not_known_has_neither_time_nor_distance():
    train = SimpleNamespace()
    begin_train(train, 0.0, 0.0, 20.0, 7e5, COMMANDED, 0.0)
    observe_build_up(train, DEFINITION, 1.0, 20.0, 20.0, 0.94 * COMMANDED)
    values = [MEASURES["build_up_time"].read(train, (), {}), *(read(train) for read in COLUMNS.values())]
    assert all("never reached `developed_share`" in value.unavailable_reason for value in values)
    train = SimpleNamespace()
    begin_train(train, 0.0, 0.0, 20.0, 7e5, COMMANDED, float("nan"))
    observe_build_up(train, DEFINITION, 1.0, 20.0, 20.0, float("nan"))
    assert np.isnan([train.rise_time, train.build_up_time]).all()

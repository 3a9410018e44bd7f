"""Vents one by one, against stops whose vents are known."""

import math
from dataclasses import replace

import numpy as np
import pytest

from uictest.report.traces.trace import trace_of
from uictest.report.traces.vent_cycles import vent_cycles

from ..builders import make_recording

TIME = np.arange(0.0, 10.0, 0.01)


def _cycles(**series):
    return vent_cycles(
        TIME, {name: np.asarray(samples, dtype=np.float64) for name, samples in series.items()}
    )


def _valve(*spans):
    return 2.0 * np.any([(start - 1e-9 <= TIME) & (end - 1e-9 > TIME) for start, end in spans], axis=0)


def test_a_vent_is_measured_from_its_start_to_the_next():
    pressure = 4.0 - np.clip(TIME - 2.0, 0.0, 1.0) + np.clip(TIME - 5.0, 0.0, 0.5)
    slide = 100.0 * np.interp(TIME, [0.0, 1.0, 3.0, 5.0], [0.0, 0.0, 0.4, 0.0])
    (one, other) = _cycles(
        valve_command_2=_valve((2.0, 3.0), (6.0, 6.2)), slide_2=slide, tank_pressure_2=pressure
    )
    assert (one.wheelset, one.start, one.duration) == (2, pytest.approx(2.0), pytest.approx(1.0))
    assert one.slide == pytest.approx(20.0)
    assert one.drop == pytest.approx(1.0, abs=0.01)
    assert one.recovery == pytest.approx(2.0, abs=0.011)  # back at 20 % at 4 s, its peak is at 3 s
    assert (other.start, other.duration) == (pytest.approx(6.0), pytest.approx(0.2))
    assert other.drop == pytest.approx(0.0)


def test_a_slide_that_never_comes_back_has_no_recovery_and_what_is_not_recorded_no_number():
    (locked,) = _cycles(valve_command_1=_valve((2.0, 3.0)), slide_1=10.0 * TIME)
    assert math.isnan(locked.recovery)
    assert math.isnan(locked.drop)
    assert locked.slide == pytest.approx(20.0)


def test_a_slide_that_is_not_back_before_the_next_vent_has_not_recovered():
    slide = 100.0 * np.interp(TIME, [0.0, 2.0, 3.0, 4.0, 9.0], [0.0, 0.2, 0.5, 0.3, 0.0])
    (one, other) = _cycles(valve_command_1=_valve((2.0, 2.5), (4.0, 4.5)), slide_1=slide)
    assert math.isnan(one.recovery)
    assert other.recovery == pytest.approx(0.0)


def test_a_stop_in_which_nothing_is_vented_has_none():
    assert _cycles(valve_command_1=np.zeros(len(TIME)), slide_1=np.zeros(len(TIME))) == ()


def test_a_vent_that_the_record_cuts_off_ends_with_it():
    (cut,) = _cycles(valve_command_3=_valve((9.5, 20.0)))
    assert cut.start + cut.duration == pytest.approx(TIME[-1])
    assert math.isnan(cut.slide)


def test_vents_of_all_wheelsets_stand_in_the_order_of_their_starts():
    cycles = _cycles(valve_command_1=_valve((1.0, 2.0), (5.0, 6.0)), valve_command_4=_valve((3.0, 4.0)))
    assert [(cycle.start, cycle.wheelset) for cycle in cycles] == [
        (pytest.approx(1.0), 1), (pytest.approx(3.0), 4), (pytest.approx(5.0), 1),
    ]  # fmt: skip


def test_the_trace_of_a_stop_has_as_many_vents_as_its_valves_show():
    record = make_recording()
    vents = trace_of(record).vents
    assert [vent.wheelset for vent in vents] == [1, 2, 3, 4]
    assert {round(vent.slide) for vent in vents} == {40}
    channels, units = (
        {name: each for name, each in own.items() if "valve" not in name}
        for own in (record.channels, record.units)
    )
    assert trace_of(replace(record, channels=channels, units=units)).vents == ()

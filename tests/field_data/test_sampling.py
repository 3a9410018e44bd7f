"""What is done to a record before it is measured, and numbers that no train shows."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording.recording import Contents, Group
from uictest.recorded.field_data import (
    MapError,
    Preparation,
    RawChannel,
    UnusableError,
    load_map,
    select_channels,
)
from uictest.recorded.field_data.defects import coarse_defects, gap_defects
from uictest.recorded.field_data.raw_channels import gaps, low_passed, resampled
from uictest.recorded.field_data.trigger import find_standstill, find_trigger, require_plausible_deceleration

RISING = st.lists(st.floats(0.01, 1.0), min_size=2, max_size=30).map(np.cumsum)


def _channel(name, time, samples):
    return RawChannel(name, name, np.asarray(time, dtype=float), np.asarray(samples, dtype=float))


@given(RISING, st.lists(st.floats(-5.0, 40.0), min_size=1, max_size=20))
def test_nothing_is_known_beyond_the_record_and_a_line_stays_a_line(time, times_asked):
    times = np.sort(times_asked)
    values = resampled(_channel("speed", time, 3.0 * time + 1.0), times, grid_interval=100.0)
    inside = (times >= time[0]) & (times <= time[-1])
    assert np.isnan(values[(times < time[0] - 1e-3) | (times > time[-1] + 1e-3)]).all()
    np.testing.assert_allclose(values[inside], 3.0 * times[inside] + 1.0, atol=1e-4)


@given(RISING, st.floats(0.0, 1.0))
def test_states_are_held(time, share):
    states = np.arange(len(time), dtype=float) % 3
    times = time[:-1] + 0.99 * share * np.diff(time)
    np.testing.assert_array_equal(
        resampled(_channel("valve_command_1", time, states), times, 100.0), states[:-1]
    )


def test_a_gap_or_a_missing_sample_stays_one_but_for_its_edges():
    time = np.array([0.0, 0.1, 0.2, 0.3, 1.0, 1.1, 1.2])
    values = resampled(_channel("speed", time, time), np.array([0.3, 0.5, 1.0]), grid_interval=0.1)
    np.testing.assert_allclose(values, [0.3, np.nan, 1.0])
    channel = _channel("speed", np.arange(4.0), np.array([0.0, np.nan, 2.0, 3.0]))
    values = resampled(channel, np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5]), grid_interval=1.0)
    np.testing.assert_array_equal(np.isnan(values), [False, True, True, True, False, False])


def test_two_lost_samples_are_a_gap_and_more_than_a_quarter_of_a_second_between_them_is_coarse():
    for lost, is_a_gap in ((1, False), (2, True)):
        time = np.delete(0.125 * np.arange(20), range(10, 10 + lost))
        assert gaps(time, grid_interval=0.125).any() == is_a_gap
        assert len(list(gap_defects(time, "speed", grid_interval=0.125))) == is_a_gap
    for interval, coarse in ((0.25, False), (0.26, True)):
        assert len(list(coarse_defects(interval, "speed"))) == coarse


def test_gaps_are_intervals_of_more_than_two_and_a_half_usual_ones_and_slower_than_the_raster():
    time = np.array([0.0, 1.0, 2.0, 3.0, 5.5, 6.5, 7.5, 10.25])
    assert list(gaps(time, grid_interval=0.1)) == [False] * 6 + [True]
    # Times of a file are rounded: the raster itself may come out a digit longer.
    time = np.array([0.0, 0.01, 0.02, 0.03, 0.13, 0.14])
    assert not gaps(time, grid_interval=0.1).any()
    assert gaps(time, grid_interval=0.09).any()
    time = np.concatenate([10.0 * k + np.arange(5.0) for k in range(6)])
    [defect] = gap_defects(time, "speed", grid_interval=0.1)
    listed = "4 to 10 s, 14 to 20 s, 24 to 30 s and 2 more"
    assert str(defect) == f"gap: speed is not recorded from {listed}"


TIME = np.linspace(0.0, 10.0, 1001)
SPEED = _channel("speed", TIME, np.full(1001, 20.0))
PRESSURE = _channel("brake_line_pressure", TIME, 1e5 * np.clip(TIME - 3.0, 0.0, 3.0))
DEMAND = _channel("demanded_pressure", TIME, np.where(TIME < 2.495, 0.0, 3e5))
COMMAND = _channel("brake_command", TIME, np.where(TIME < 1.995, 0.0, 1.0))
CHANNELS = {channel.name: channel for channel in (SPEED, PRESSURE, DEMAND, COMMAND)}
FACT = {"brake_command_time": "1.5 s"}


@pytest.mark.parametrize(
    ("choices", "time", "text"),
    [
        ({}, 1.5, "stated by the file"),
        ({"trigger": "command"}, 2.0, "brake_command rises"),
        ({"trigger": "demand"}, 2.49 + 0.01 / 30.0, "demanded_pressure rises"),
        ({"trigger": "pressure"}, 3.1, "brake_line_pressure rises"),
        ({"trigger": "pressure", "trigger_pressure": "0.5 bar"}, 3.5, "brake_line_pressure rises"),
        ({"trigger": "pressure", "trigger_lead": "0.4 s"}, 2.7, "0.4 s before it"),
        ({"trigger": "start"}, 0.0, "begins with it"),
        ({"trigger_time": "4 s"}, 4.0, "stated by the user"),
    ],
)
def test_triggers(choices, time, text):
    found = find_trigger(CHANNELS, FACT, Preparation.model_validate(choices))
    assert found.time == pytest.approx(time)
    assert text in found.text
    assert not found.late


def test_auto_takes_the_first_that_is_recorded_or_asks():
    auto = Preparation()
    assert find_trigger(CHANNELS, {}, auto).time == 2.0
    without = {name: channel for name, channel in CHANNELS.items() if name != "brake_command"}
    assert find_trigger(without, {}, auto).text.endswith("demanded_pressure rises")
    with pytest.raises(MapError, match="state it with --trigger"):
        find_trigger({"speed": SPEED}, {}, Preparation())


def test_a_brake_that_is_on_is_late_for_a_running_train_and_no_trigger_before_it_departs():
    pressure = _channel("brake_line_pressure", TIME, np.where((TIME < 1.0) | (TIME > 6.0), 3e5, 0.0))
    speed = _channel("speed", TIME, np.clip(5.0 * (TIME - 2.0), 0.0, 15.0))
    found = find_trigger({"speed": speed, "brake_line_pressure": pressure}, {}, Preparation())
    assert found.time == pytest.approx(6.0, abs=0.02)
    assert not found.late
    pressure = _channel("brake_line_pressure", TIME, np.full(1001, 3e5))
    assert find_trigger({"speed": SPEED, "brake_line_pressure": pressure}, {}, Preparation()).late


def stood(time, speed):
    found = find_standstill(time, speed, 0.0, slow=0.3)
    assert found is not None
    return found


def test_standstill_between_samples_or_just_beyond_the_record_is_found_and_no_other():
    time = np.arange(0.0, 12.0, 0.1)
    found = stood(time, 10.03 - time)
    assert found.time == pytest.approx(10.03)
    assert found.beyond == 0.0
    time = np.arange(0.0, 9.95, 0.1)
    found = stood(time, 10.03 - time)
    assert found.time == pytest.approx(10.03)
    assert found.beyond == pytest.approx(0.5 * 0.13**2)
    assert "run out" in found.text
    time = np.arange(0.0, 9.0, 0.1)
    assert find_standstill(time, 10.03 - time, 0.0, slow=0.3) is None
    # No deceleration can be taken from it, so nobody knows when the train stood.
    time = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    assert find_standstill(time, np.array([8.0, 6.0, 4.0, 2.0, 0.1]), 0.0, slow=0.3) is None


def test_a_sensor_that_reads_a_little_at_rest_or_a_late_zero_does_not_delay_standstill():
    time = np.arange(0.0, 30.0, 0.1)
    found = stood(time, np.maximum(10.03 - time, 0.05))
    assert found.time == pytest.approx(10.03, abs=0.06)
    # The train creeps for three seconds, then stands: what it ran out to is the standstill.
    time = np.arange(0.0, 15.0, 0.1)
    speed = np.where(time < 13.0, np.maximum(10.03 - time, 0.05), 0.0)
    found = stood(time, speed)
    assert found.time == pytest.approx(10.03, abs=0.06)
    assert "run out" in found.text
    # It runs out at the deceleration of the last half second: here it brakes twice as hard from then on.
    time = np.arange(0.0, 9.75, 0.05)
    speed = np.where(time < 9.2, 10.2 - time, 1.0 - 2.0 * (time - 9.2)) + 0.25
    found = stood(time, speed)
    assert found.time == pytest.approx(time[-1] + speed[-1] / 2.0)
    assert found.beyond == pytest.approx(speed[-1] ** 2 / 4.0)


def _braking(deceleration, initial_speed=20.0):
    time = np.linspace(0.0, initial_speed / deceleration, 2001)
    return _channel("speed", time, initial_speed - deceleration * time)


def test_what_a_train_can_do_after_its_brake_command_is_plausible_and_nothing_else():
    for deceleration in (0.0102, 1.0, 19.8):
        require_plausible_deceleration(_braking(deceleration), 0.0)
    for deceleration in (0.0098, 20.2):
        numbers = f"from 72 to 36 km/h in {10.0 / deceleration:.4g} s, at {deceleration:.4g} m/s2"
        with pytest.raises(MapError, match=f"the train slows {numbers}"):
            require_plausible_deceleration(_braking(deceleration), 0.0)
    time = np.arange(0.0, 20.0, 0.1)
    speed = np.where(np.abs(time - 5.0) < 2.0, 5.0, 0.0)
    require_plausible_deceleration(_channel("speed", time, speed), 0.0)
    # Before it, a wagon may have been shunted or a sensor switched on.
    braking = _braking(1.0)
    time = np.concatenate(([-2.0, -1.9], braking.time))
    speed = np.concatenate(([300.0, 0.0], braking.samples))
    require_plausible_deceleration(_channel("speed", time, speed), 0.0)


def test_a_low_pass_keeps_level_and_place_of_what_it_filters():
    ripple = np.sin(2.0 * np.pi * 40.0 * TIME)
    channel = _channel("speed", TIME, 20.0 - TIME + ripple)
    filtered = low_passed(channel, 2.0).samples[100:-100]
    np.testing.assert_allclose(filtered, (20.0 - TIME)[100:-100], atol=0.02)
    wave = np.sin(2.0 * np.pi * 2.0 * TIME)  # at its corner half of it is left, without delay
    half = low_passed(_channel("speed", TIME, wave), 2.0).samples
    np.testing.assert_allclose(half[100:-100], 0.5 * wave[100:-100], atol=0.005)
    assert low_passed(COMMAND, 2.0) is COMMAND
    assert low_passed(SPEED, 45.0) is SPEED


SECONDS = np.arange(0.0, 20.0, 0.05)


def _selected(time, speed, pressure, units):
    samples = {"time": time, "speed": speed, "cylinder_pressure_1": pressure}
    channels = {name: np.broadcast_to(np.asarray(each), len(SECONDS)) for name, each in samples.items()}
    group = Group("", channels, dict(zip(channels, units, strict=True)))
    return select_channels(Contents((group,)), load_map("uictest")[0])


@pytest.mark.parametrize(
    ("factors", "units", "message"),
    [
        ((1e3, 1.0, 1.0), ("s", "m/s", "bar"), r"is it in ms\? write `unit: ms`"),
        ((1e6, 1.0, 1.0), ("s", "m/s", "bar"), r"is it in us\? write `unit: us`"),
        ((1e9, 1.0, 1.0), ("s", "m/s", "bar"), r"is it in ns\? write `unit: ns`"),
        ((1e12, 1.0, 1.0), ("s", "m/s", "bar"), r"runs from 0 to 1.995e\+13 s with a sample every 5e\+10 s"),
        ((1e-9, 1.0, 1.0), ("s", "m/s", "bar"), "with a sample every 5e-11 s"),
        ((1.0, 100.0, 1.0), ("s", "m/s", "bar"), "'speed' reaches 2000 m/s; at most 1000 km/h"),
        ((1.0, 1.0, 1e2), ("s", "m/s", "bar"), "reaches 380 bar; .* is it in kPa"),
        ((1.0, 1.0, 1e5), ("s", "m/s", "bar"), "reaches 3.8e\\+05 bar; .* is it in Pa"),
        ((1.0, 1.0, 1e308), ("s", "m/s", "bar"), "reaches inf bar"),
    ],
)
def test_a_wrong_unit_is_asked_for(factors, units, message):
    with np.errstate(over="ignore"):
        pressure = 3.8 * np.float64(factors[2])
    with pytest.raises(MapError, match=message):
        _selected(SECONDS * factors[0], 20.0 * factors[1], pressure, units)


def test_times_in_nanoseconds_and_numbers_among_texts_are_read_in_the_unit_of_their_channel():
    channels = _selected(SECONDS * 1e9, 20.0, 3.8, ("ns", "m/s", "bar"))
    np.testing.assert_allclose(channels["speed"].time, SECONDS)
    texts = {"time": SECONDS[:3], "speed": np.array(["36.0", "", "18.0"])}
    group = Group("", texts, {"time": "s", "speed": "km/h"})
    speed = select_channels(Contents((group,)), load_map("uictest")[0])["speed"].samples
    np.testing.assert_allclose(speed, [10, np.nan, 5])


def test_a_single_impossible_sample_is_a_defect_and_a_speed_without_a_number_unusable(channels, prepared):
    samples = channels["wheel_speed_2"].samples.copy()
    samples[100] = 6553.5
    channels["wheel_speed_2"] = replace(channels["wheel_speed_2"], samples=samples)
    stop = prepared(channels)
    [defect] = [each for each in stop.defects if each.kind == "out-of-range"]
    assert str(defect).startswith("out-of-range: wheel_speed_2 has 1 of")
    assert np.isnan(stop.recording["wheel_speed_2"]).any()
    speed = channels["speed"]
    channels["speed"] = replace(speed, samples=np.full(len(speed.samples), np.nan))
    with pytest.raises(UnusableError, match="not-a-number: speed has"):
        prepared(channels)


@pytest.mark.parametrize("scale", [1e-3, 150.0])
def test_a_stop_that_no_train_makes_is_refused(channels, prepared, scale):
    time = channels["speed"].time * scale
    scaled = {name: replace(channel, time=time) for name, channel in channels.items()}
    with pytest.raises(MapError, match=r"m/s2; .* are plausible: check the units of time and speed"):
        prepared(scaled)


def test_a_stated_time_that_is_none_or_after_the_record_is_refused(channels, prepared):
    for text in ("nan s", "inf s", "1e400 s", "12", "soon", ""):
        with pytest.raises(MapError, match=r"brake_command_time in the header of the file: .* --trigger"):
            prepared(channels, {"brake_command_time": text})
    with pytest.raises(MapError, match=r"1.7e\+09 s, stated by the file, is not in the record"):
        prepared(channels, {"brake_command_time": "1700000000 s"})
    with pytest.raises(MapError, match=r"1.7e\+09 s, stated by the user, is not in the record"):
        prepared(channels, {}, trigger_time="1700000000 s")

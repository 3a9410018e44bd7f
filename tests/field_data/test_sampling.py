"""Resampling, trigger, standstill, filter: what is done to a record before it is measured."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.field_data import MapError, Preparation, RawChannel
from uictest.field_data.signals import low_passed, resampled
from uictest.field_data.standstill import find_standstill
from uictest.field_data.trigger import find_trigger

RISING = st.lists(st.floats(0.01, 1.0), min_size=2, max_size=30).map(np.cumsum)


def _channel(name: str, time: np.ndarray, samples: np.ndarray) -> RawChannel:
    return RawChannel(name, name, np.asarray(time, dtype=float), np.asarray(samples, dtype=float))


@given(RISING, st.lists(st.floats(-5.0, 40.0), min_size=1, max_size=20))
def test_nothing_is_known_beyond_the_record_and_a_line_stays_a_line(
    time: np.ndarray, times_asked: list[float]
) -> None:
    times = np.sort(times_asked)
    values = resampled(_channel("speed", time, 3.0 * time + 1.0), times, raster=100.0)
    inside = (times >= time[0]) & (times <= time[-1])
    assert np.isnan(values[(times < time[0] - 1e-3) | (times > time[-1] + 1e-3)]).all()
    np.testing.assert_allclose(values[inside], 3.0 * times[inside] + 1.0, atol=1e-4)


@given(RISING, st.floats(0.0, 1.0))
def test_states_are_held(time: np.ndarray, share: float) -> None:
    states = np.arange(len(time), dtype=float) % 3
    times = time[:-1] + 0.99 * share * np.diff(time)
    np.testing.assert_array_equal(
        resampled(_channel("valve_command_1", time, states), times, 100.0), states[:-1]
    )


def test_a_gap_stays_a_gap_but_for_its_edges() -> None:
    time = np.array([0.0, 0.1, 0.2, 0.3, 1.0, 1.1, 1.2])
    values = resampled(_channel("speed", time, time), np.array([0.3, 0.5, 1.0]), raster=0.1)
    np.testing.assert_allclose(values, [0.3, np.nan, 1.0])


def test_a_missing_sample_spoils_what_lies_beside_it() -> None:
    channel = _channel("speed", np.arange(4.0), np.array([0.0, np.nan, 2.0, 3.0]))
    values = resampled(channel, np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5]), raster=1.0)
    np.testing.assert_array_equal(np.isnan(values), [False, True, True, True, False, False])


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
def test_triggers(choices: dict[str, str], time: float, text: str) -> None:
    found = find_trigger(CHANNELS, FACT, Preparation.model_validate(choices))
    assert found.time == pytest.approx(time)
    assert text in found.text
    assert not found.late


def test_auto_takes_the_first_that_is_recorded() -> None:
    auto = Preparation()
    assert find_trigger(CHANNELS, {}, auto).time == 2.0
    without = {name: channel for name, channel in CHANNELS.items() if name != "brake_command"}
    assert find_trigger(without, {}, auto).text.endswith("demanded_pressure rises")


def test_a_brake_that_holds_the_train_before_it_departs_is_no_trigger() -> None:
    pressure = _channel("brake_line_pressure", TIME, np.where((TIME < 1.0) | (TIME > 6.0), 3e5, 0.0))
    speed = _channel("speed", TIME, np.clip(5.0 * (TIME - 2.0), 0.0, 15.0))
    found = find_trigger({"speed": speed, "brake_line_pressure": pressure}, {}, Preparation())
    assert found.time == pytest.approx(6.0, abs=0.02)
    assert not found.late


def test_a_brake_that_is_on_from_the_start_of_a_running_record_is_late() -> None:
    pressure = _channel("brake_line_pressure", TIME, np.full(1001, 3e5))
    assert find_trigger({"speed": SPEED, "brake_line_pressure": pressure}, {}, Preparation()).late


def test_nothing_marks_the_brake_command() -> None:
    with pytest.raises(MapError, match="state it with --trigger"):
        find_trigger({"speed": SPEED}, {}, Preparation())


def test_standstill_between_samples() -> None:
    time = np.arange(0.0, 12.0, 0.1)
    found = find_standstill(time, 10.03 - time, 0.0, slow=0.3)
    assert found is not None
    assert found.time == pytest.approx(10.03)
    assert found.beyond == 0.0


def test_standstill_just_beyond_the_record_is_run_out() -> None:
    time = np.arange(0.0, 9.95, 0.1)
    found = find_standstill(time, 10.03 - time, 0.0, slow=0.3)
    assert found is not None
    assert found.time == pytest.approx(10.03)
    assert found.beyond == pytest.approx(0.5 * 0.13**2)
    assert "run out" in found.text


def test_a_record_that_ends_faster_holds_no_standstill() -> None:
    time = np.arange(0.0, 9.0, 0.1)
    assert find_standstill(time, 10.03 - time, 0.0, slow=0.3) is None


def test_a_sensor_that_reads_a_little_at_rest_does_not_delay_standstill() -> None:
    time = np.arange(0.0, 30.0, 0.1)
    found = find_standstill(time, np.maximum(10.03 - time, 0.05), 0.0, slow=0.3)
    assert found is not None
    assert found.time == pytest.approx(10.03, abs=0.06)


def test_a_low_pass_keeps_level_and_place_and_takes_ripple() -> None:
    ripple = np.sin(2.0 * np.pi * 40.0 * TIME)
    channel = _channel("speed", TIME, 20.0 - TIME + ripple)
    filtered = low_passed(channel, 2.0).samples[100:-100]
    np.testing.assert_allclose(filtered, (20.0 - TIME)[100:-100], atol=0.02)


def test_states_and_slow_channels_are_not_filtered() -> None:
    assert low_passed(COMMAND, 2.0) is COMMAND
    assert low_passed(SPEED, 45.0) is SPEED

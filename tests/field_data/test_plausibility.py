"""Numbers that no train shows: the unit is wrong, or a sample is no measurement."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.core.recording.recording import Contents, Group
from uictest.recorded.field_data import MapError, UnusableError, load_map, select_channels

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
    group = Group(
        "", {"time": SECONDS[:3], "speed": np.array(["36.0", "", "18.0"])}, {"time": "s", "speed": "km/h"}
    )
    np.testing.assert_allclose(
        select_channels(Contents((group,)), load_map("uictest")[0])["speed"].samples, [10, np.nan, 5]
    )


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


@pytest.mark.parametrize("text", ["nan s", "inf s", "1e400 s", "12", "soon", ""])
def test_a_stated_time_that_is_none_is_refused(channels, prepared, text):
    with pytest.raises(MapError, match=r"brake_command_time in the header of the file: .* --trigger"):
        prepared(channels, {"brake_command_time": text})


@pytest.mark.parametrize("by", ["file", "user"])
def test_a_brake_command_after_the_record_is_refused(channels, prepared, by):
    facts = {"brake_command_time": "1700000000 s"} if by == "file" else {}
    choices = {"trigger_time": "1700000000 s"} if by == "user" else {}
    with pytest.raises(MapError, match=f"1.7e\\+09 s, stated by the {by}, is not in the record"):
        prepared(channels, facts, **choices)

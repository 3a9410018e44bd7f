"""Simulated stops as recordings: data frames and figures."""

from pathlib import Path

import numpy as np
import pytest

import uictest
from uictest.controllers import ControllerError


def test_the_rate_is_that_of_the_samples(write):
    recording = uictest.simulate(write(), record=200)
    assert np.diff(recording["time"])[:100] == pytest.approx(0.005)


def test_set_seed_and_case_choose_the_stop(write):
    path = write(text="matrix: {rail.friction: [0.06, 0.1]}\n")
    with pytest.raises(
        ValueError, match=r"the scenario has 2 cases: pass case= one of stop\[friction=0\.06\]"
    ):
        uictest.simulate(path)
    first = uictest.simulate(path, case="stop[friction=0.1]", seed=3)
    same = uictest.simulate(uictest.load(path, select="0.1")[0], seed=3)
    other = uictest.simulate(path, set={"rail.friction": 0.1}, seed=4)
    assert first.frame().equals(same.frame())
    assert not np.array_equal(first["measured_speed_1"], other["measured_speed_1"])


def test_what_applies_to_files_is_rejected_for_a_case(write):
    (case,) = uictest.load(write())
    for arguments in ({"set": {"seed": 1}}, {"case": "stop"}, {"trust": ["."]}):
        with pytest.raises(ValueError, match="apply to files"):
            uictest.simulate(case, **arguments)


@pytest.mark.parametrize("rate", [0, -1, 0.5, 100_001, float("nan"), float("inf")])
def test_a_rate_is_one_that_a_run_can_have(write, rate):
    with pytest.raises(ValueError, match=r"record is .*, expected 1 to 100000 samples per second"):
        uictest.simulate(write(), record=rate)


def test_a_controller_that_fails_is_an_error(write):
    path = write(text="controller: {python: wsp.py, class: Wsp}\n")
    methods = ("__init__(self, config): pass", "reset(self): pass", "step(self, i): 1 / 0")
    text = "".join(f"    def {method}\n" for method in methods)
    Path("scenarios/wsp.py").write_text(f"class Wsp:\n{text}")
    with pytest.raises(ControllerError, match="ZeroDivisionError"):
        uictest.simulate(path)


def test_the_frame_has_every_channel_over_the_time(write):
    recording = uictest.simulate(write())
    frame = recording.frame()
    assert frame.index.name == "time"
    assert [frame.index.name, *frame.columns] == list(recording.channels)
    for name in frame.columns:
        assert np.array_equal(frame[name], recording[name], equal_nan=True)
    assert frame.attrs["units"] == recording.units
    assert frame.attrs["metadata"]["case"] == "stop"


def test_the_figure_has_a_panel_for_each_unit(write):
    recording = uictest.simulate(write())
    figure = recording.plot(["speed", "wheel_speed_*", "tank_pressure_1"])
    wheels = [f"wheel_speed_{n}" for n in range(1, 5)]
    assert [each.name for each in figure.data] == ["speed", *wheels, "tank_pressure_1"]
    assert (figure.layout.yaxis.title.text, figure.layout.yaxis2.title.text) == ("m/s", "Pa")
    assert figure.layout.xaxis2.title.text == "time, s"
    assert np.array_equal(figure.data[0].y, recording["speed"])
    looks = {(each.line.color, each.line.dash) for each in figure.data[:5]}
    assert len(looks) == len({dash for _, dash in looks}) + 1 == 5  # train and wheelset 1 differ by colour


def test_a_figure_of_an_unknown_channel_names_those_that_there_are(write):
    with pytest.raises(KeyError, match=r"no channel 'wheel_sped_\*' in this recording of distance, speed"):
        uictest.simulate(write()).plot(["wheel_sped_*"])


def test_a_figure_of_a_train_shows_what_was_recorded():
    time = np.arange(3.0)
    channels = {"time": time, "speed": 3.0 - time, "slide_1": np.full(3, np.nan)}
    recording = uictest.Recording(channels, {"time": "s", "speed": "m/s", "slide_1": "1"})
    assert [each.name for each in recording.plot().data] == ["speed"]
    other = uictest.Recording({"time": time, "voltage": time}, {"time": "s", "voltage": "V"})
    assert [each.name for each in other.plot().data] == ["voltage"]

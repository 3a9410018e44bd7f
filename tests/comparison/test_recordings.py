from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from uictest.comparison import Tolerances, compare_recordings
from uictest.comparison.overlay import DRAWN
from uictest.recording import Recording

MakeRecording = Callable[..., Recording]
DEFAULT = Tolerances()
NAMES = ("a", "b")


def test_a_recording_and_itself_do_not_differ(make_recording: MakeRecording) -> None:
    found = compare_recordings(make_recording(), make_recording(), NAMES, DEFAULT)
    assert (list(found.differences), found.compared) == ([], 3)


def test_the_same_course_sampled_otherwise_agrees(make_recording: MakeRecording) -> None:
    found = compare_recordings(make_recording(0.1), make_recording(0.04), NAMES, DEFAULT)
    assert found.agrees


def test_a_channel_that_moved_is_named_with_the_time_of_its_largest_deviation(
    make_recording: MakeRecording,
) -> None:
    first = make_recording()
    moved = first["speed"] + np.where(np.isclose(first["time"], 4.0), 0.6, 0.0)
    found = compare_recordings(first, make_recording(speed=moved), NAMES, DEFAULT)
    (difference,) = found.beyond
    assert (difference.quantity, difference.unit, difference.remark) == ("speed", "m/s", "largest at 4 s")
    assert difference.deviation == pytest.approx(0.6)
    assert difference.allowed == pytest.approx(0.01)  # a thousandth of the range of 10 m/s


def test_a_relative_tolerance_is_of_the_range_of_the_channel(make_recording: MakeRecording) -> None:
    first = make_recording()
    second = make_recording(speed=first["speed"] + 0.6)
    assert compare_recordings(first, second, NAMES, Tolerances.read(["6.1%"])).agrees
    assert not compare_recordings(first, second, NAMES, Tolerances.read(["5.9%"])).agrees


def test_a_shorter_recording_is_compared_as_far_as_it_goes(make_recording: MakeRecording) -> None:
    found = compare_recordings(make_recording(), make_recording(end=8.0), NAMES, DEFAULT)
    assert [difference.quantity for difference in found.beyond] == ["duration"]


def test_channels_of_other_units_or_on_one_side_only_differ(make_recording: MakeRecording) -> None:
    first, second = make_recording(), make_recording(extra=np.zeros(101))
    other = Recording(second.channels, {**second.units, "speed": "km/h"}, {})
    found = compare_recordings(first, other, NAMES, DEFAULT)
    shown = {each.quantity: (each.first, each.second) for each in found.beyond}
    assert shown == {"speed": ("m/s", "km/h"), "extra": ("none", "1")}


def test_gaps_at_the_same_samples_agree_and_others_do_not(make_recording: MakeRecording) -> None:
    gap = np.where(np.arange(101) < 50, np.nan, 1.0)
    assert compare_recordings(make_recording(x=gap), make_recording(x=gap), NAMES, DEFAULT).agrees
    found = compare_recordings(make_recording(x=gap), make_recording(x=np.ones(101)), NAMES, DEFAULT)
    assert [(each.quantity, each.within, each.deviation) for each in found.differences] == [
        ("x", False, None)
    ]


def test_the_overlay_draws_the_speed_and_what_differs_as_far_as_there_is_room(
    make_recording: MakeRecording,
) -> None:
    many = {f"channel_{n}": np.arange(101.0) for n in range(30)}
    moved = {name: samples + 1.0 for name, samples in many.items()}
    found = compare_recordings(make_recording(**many), make_recording(**moved), NAMES, DEFAULT)
    (overlay,) = found.overlays
    assert [panel.title for panel, _ in overlay.panels][:2] == ["speed", "channel_0"]
    assert (len(overlay.panels), overlay.left_out) == (DRAWN, 31 - DRAWN)

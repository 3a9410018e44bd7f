import numpy as np
import pytest

from uictest.analysis.comparison import Tolerances, compare_recordings
from uictest.analysis.comparison.overlay import DRAWN
from uictest.core.recording import Recording

from .conftest import make_recording

DEFAULT = Tolerances()
NAMES = ("a", "b")


def test_a_recording_agrees_with_itself_sampled_otherwise_and_in_another_unit():
    first = make_recording()
    found = compare_recordings(first, make_recording(), NAMES, DEFAULT)
    assert (list(found.differences), found.compared) == ([], 3)
    assert compare_recordings(first, make_recording(0.04), NAMES, DEFAULT).agrees
    channels = {**first.channels, "speed": 3.6 * first["speed"]}
    in_kmh = Recording(channels, {**first.units, "speed": "km/h"}, {})
    assert compare_recordings(first, in_kmh, NAMES, DEFAULT).agrees


def test_a_channel_that_moved_is_named_with_the_time_of_its_largest_deviation():
    first = make_recording()
    moved = first["speed"] + np.where(np.isclose(first["time"], 4.0), 0.6, 0.0)
    found = compare_recordings(first, make_recording(speed=moved), NAMES, DEFAULT)
    (difference,) = found.beyond
    assert (difference.quantity, difference.unit, difference.remark) == ("speed", "km/h", "largest at 4 s")
    assert difference.deviation == pytest.approx(0.6 * 3.6)
    # A relative tolerance is of the range of the channel, 10 m/s.
    assert difference.allowed == pytest.approx(0.036)


@pytest.mark.parametrize("ends", [(10.0, 8.0), (8.0, 10.0)])
def test_a_shorter_recording_is_compared_as_far_as_it_goes_and_each_side_drawn_to_its_end(ends):
    found = compare_recordings(*(make_recording(end=end) for end in ends), NAMES, DEFAULT)
    assert [difference.quantity for difference in found.beyond] == ["duration"]
    (overlay,) = found.overlays
    times = [overlay.trace.curves[f"{side} speed"].x for side in ("first", "second")]
    assert [(float(time[0]), float(time[-1])) for time in times] == [(0.0, ends[0]), (0.0, ends[1])]
    assert (overlay.trace.start, overlay.trace.end) == (0.0, 10.0)


def test_channels_of_other_units_or_on_one_side_only_differ():
    first, second = make_recording(), make_recording(extra=np.zeros(101))
    other = Recording(second.channels, {**second.units, "speed": "knot"}, {})
    found = compare_recordings(first, other, NAMES, DEFAULT)
    shown = {each.quantity: (each.first, each.second, each.remark) for each in found.beyond}
    assert shown == {
        "speed": ("km/h", "knot", "different units"),
        "extra": ("none", "1", "only one side has the channel"),
    }
    assert (found.overlays[0].only_first, found.overlays[0].only_second) == ([], ["extra"])


def test_quantities_are_compared_and_drawn_in_the_units_of_the_page():
    first = make_recording(slide_1=0.01 * make_recording()["time"])
    (overlay,) = compare_recordings(first, first, NAMES, DEFAULT, ["*"]).overlays
    curves = overlay.trace.curves
    ends = {each.channel: (curves[f"first {each.channel}"].y[-1], each.unit) for each in overlay.channels}
    assert ends == {"speed": (pytest.approx(72.0), "km/h"), "slide_1": (pytest.approx(10.0), "%")}


def test_any_common_channel_can_be_chosen_and_the_others_are_named():
    many = {f"channel_{n}": np.zeros(101) for n in range(30)}
    recording = make_recording(**many)
    (overlay,) = compare_recordings(recording, recording, NAMES, DEFAULT, ["slide_1", "channel_2*"]).overlays
    titles = [each.channel for each in overlay.channels]
    assert titles == ["slide_1", "channel_2", *(f"channel_2{n}" for n in range(10))]
    assert len(overlay.not_drawn) == 32 - len(titles)


def test_a_channel_that_is_not_there_is_answered_with_those_that_are():
    recording = make_recording()
    with pytest.raises(ValueError, match=r"'slid_1'.*did you mean 'slide_1'.*both have: speed, slide_1"):
        compare_recordings(recording, recording, NAMES, DEFAULT, ["slid_1"])


def test_gaps_at_the_same_samples_agree_and_others_are_counted():
    gap = np.where((np.arange(101) >= 40) & (np.arange(101) < 50), np.nan, 1.0)
    assert compare_recordings(make_recording(x=gap), make_recording(x=gap), NAMES, DEFAULT).agrees
    (found,) = compare_recordings(
        make_recording(x=gap), make_recording(x=np.ones(101)), NAMES, DEFAULT
    ).differences
    assert (found.quantity, found.within, found.deviation) == ("x", False, None)
    assert found.remark == "only one side has a value at 10 of 101 instants, first at 4 s"


def test_the_overlay_draws_the_speed_and_what_differs_as_far_as_there_is_room():
    many = {f"channel_{n}": np.arange(101.0) for n in range(30)}
    moved = {name: samples + 1.0 for name, samples in many.items()}
    found = compare_recordings(make_recording(**many), make_recording(**moved), NAMES, DEFAULT)
    (overlay,) = found.overlays
    assert [each.channel for each in overlay.channels][:2] == ["speed", "channel_0"]
    assert (len(overlay.channels), len(overlay.not_drawn)) == (DRAWN, 32 - DRAWN)


def test_recordings_that_share_no_time_do_not_agree():
    first, late = make_recording(end=1.0), make_recording(end=1.0)
    later = Recording({**late.channels, "time": late["time"] + 5.0}, late.units)
    found = compare_recordings(first, later, NAMES, DEFAULT)
    assert {each.quantity: each.remark for each in found.beyond} == {
        "duration": "",
        "speed": "the two share no time",
        "slide_1": "the two share no time",
    }

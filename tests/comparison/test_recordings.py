"""Two recordings side by side: at which instants, and what differs."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays

from uictest.analysis.comparison import Tolerances, compare_recordings
from uictest.analysis.comparison.overlay import (
    DRAWN,
    Sampled,
    channel_difference,
    common_samples,
    curves_over_time,
    over_common_distance,
    over_distance,
    sampling_remarks,
)
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


def test_common_channels_are_drawn_as_chosen_or_as_far_as_there_is_room_and_the_others_named():
    many = {f"channel_{n}": np.arange(101.0) for n in range(30)}
    recording = make_recording(**many)
    (overlay,) = compare_recordings(recording, recording, NAMES, DEFAULT, ["slide_1", "channel_2*"]).overlays
    titles = [each.channel for each in overlay.channels]
    assert titles == ["slide_1", "channel_2", *(f"channel_2{n}" for n in range(10))]
    assert len(overlay.not_drawn) == 32 - len(titles)
    with pytest.raises(ValueError, match=r"'slid_1'.*did you mean 'slide_1'.*both have: speed, slide_1"):
        compare_recordings(recording, recording, NAMES, DEFAULT, ["slid_1"])
    # Not chosen: the speed and what differs.
    moved = {name: samples + 1.0 for name, samples in many.items()}
    (overlay,) = compare_recordings(recording, make_recording(**moved), NAMES, DEFAULT).overlays
    assert [each.channel for each in overlay.channels][:2] == ["speed", "channel_0"]
    assert (len(overlay.channels), len(overlay.not_drawn)) == (DRAWN, 32 - DRAWN)


def test_gaps_at_the_same_samples_agree_and_others_are_counted():
    gap = np.where((np.arange(101) >= 40) & (np.arange(101) < 50), np.nan, 1.0)
    assert compare_recordings(make_recording(x=gap), make_recording(x=gap), NAMES, DEFAULT).agrees
    (found,) = compare_recordings(
        make_recording(x=gap), make_recording(x=np.ones(101)), NAMES, DEFAULT
    ).differences
    assert (found.quantity, found.within, found.deviation) == ("x", False, None)
    assert found.remark == "only one side has a value at 10 of 101 instants, first at 4 s"


def test_recordings_that_share_no_time_do_not_agree_and_what_was_not_compared_is_stated():
    first, late = make_recording(end=1.0), make_recording(end=1.0)
    later = Recording({**late.channels, "time": late["time"] + 5.0}, late.units)
    found = compare_recordings(first, later, NAMES, DEFAULT)
    alone = dict.fromkeys(("speed", "slide_1"), "the two share no time")
    assert {each.quantity: each.remark for each in found.beyond} == {"duration": ""} | alone
    assert list(sampling_remarks(first, later)) == [
        "A and B share no time: nothing of their channels is compared"
    ]
    assert list(sampling_remarks(make_recording(), make_recording())) == []
    between = "and is read off straight lines between its samples"
    assert list(sampling_remarks(make_recording(0.1), make_recording(0.25, end=8.0))) == [
        f"compared at the instants of B, every 250 ms; A has a sample every 100 ms {between}",
        "A goes on for 2 s, from 8 s: not compared",
    ]
    first = make_recording()
    shifted = Recording({**first.channels, "time": first["time"] + 0.005}, first.units)
    assert list(sampling_remarks(first, shifted)) == [
        "compared at the instants of both; each is read off straight lines between its samples",
        "A begins 0.005 s earlier: not compared",
        "B goes on for 0.005 s, from 10 s: not compared",
    ]


def _ramp(at):
    return 3.0 * at - 2.0


@pytest.mark.parametrize("swapped", [False, True])
def test_the_coarser_side_gives_the_instants_and_the_finer_one_is_read_between_its_samples(swapped):
    fine = Sampled(np.arange(0.0, 10.0, 0.03), np.sin(np.arange(0.0, 10.0, 0.03)))
    coarse = Sampled(np.arange(1.0, 12.0, 0.25), np.cos(np.arange(1.0, 12.0, 0.25)))
    both = common_samples(*((coarse, fine) if swapped else (fine, coarse)))
    instants = np.arange(1.0, 9.99, 0.25)
    np.testing.assert_allclose(both.at, instants)
    read = np.interp(instants, fine.at, fine.values)
    sign = -1.0 if swapped else 1.0
    np.testing.assert_allclose(both.difference, sign * (np.cos(instants) - read))


@given(
    arrays.arrays(np.float64, st.integers(2, 40), elements=st.floats(0.01, 5.0)),
    arrays.arrays(np.float64, st.integers(2, 40), elements=st.floats(0.01, 5.0)),
)
def test_the_same_straight_line_agrees_however_it_is_sampled(one, other):
    sides = [Sampled(np.cumsum(steps), _ramp(np.cumsum(steps))) for steps in (one, other)]
    both = common_samples(*sides)
    np.testing.assert_allclose(both.difference, 0.0, atol=1e-9)
    assert np.all(np.isin(both.at, [*sides[0].at, *sides[1].at]))


def test_a_state_is_read_at_its_last_sample_and_drawn_in_steps():
    valve = Sampled(np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 2.0, 2.0, 0.0]))
    other = Sampled(np.array([0.0, 1.5, 3.0]), np.array([0.0, 2.0, 0.0]))
    np.testing.assert_array_equal(common_samples(valve, other, holds=True).first, [0.0, 2.0, 0.0])
    np.testing.assert_array_equal(common_samples(other, valve, holds=False).second, [0.0, 2.0, 0.0])
    late = Sampled(np.array([0.5, 2.5]), np.array([0.0, 0.0]))
    np.testing.assert_array_equal(common_samples(valve, late, holds=True).first, [0.0, 2.0])
    np.testing.assert_array_equal(common_samples(valve, late).first, [1.0, 1.0])
    command = np.where(np.arange(101) >= 50, 2.0, 0.0)
    first, second = make_recording(valve_command_1=command), make_recording(valve_command_1=np.zeros(101))
    difference = channel_difference("valve_command_1", first, second)
    curve = curves_over_time(first, second, [difference])["first valve_command_1"]
    # From 0 to 2 at 5 s, not along a line that begins at the sample before.
    assert curve.y[curve.x < 4.99].max() == 0.0
    assert curve.y[np.isclose(curve.x, 5.0)].tolist() == [0.0, 2.0]


def test_the_worst_instant_and_the_mean_of_a_known_difference():
    first = make_recording(0.1)
    time = make_recording(0.5)["time"]
    # Beside the line of the first: 0 to 2 m/s too fast, the most at 6.5 s.
    shift = np.interp(time, [0.0, 6.5, 10.0], [0.0, 2.0, 1.0])
    second = make_recording(0.5, speed=30.0 - time + shift)
    found = channel_difference("speed", first, second, allowed=1.5)
    assert found.worst is not None
    worst = found.worst
    assert (worst.at, worst.first, worst.second) == (6.5, pytest.approx(23.5), pytest.approx(25.5))
    assert (found.mean, found.within) == (pytest.approx(np.mean(shift)), False)
    np.testing.assert_allclose(found.samples.difference, shift, atol=1e-12)


def test_over_distance_the_speed_is_compared_at_the_same_place():
    """Both brake with 1 m/s2, the second from 1 m/s more: v2 = v0**2 - 2 a s at every place."""
    time = make_recording(0.01)["time"]
    first, second = (
        make_recording(0.01, speed=start - time, distance=start * time - time**2 / 2)
        for start in (30.0, 31.0)
    )
    found = over_common_distance(first, second, ["speed", "distance"])
    curve = found.curves["difference speed"]
    expected = np.sqrt(31.0**2 - 2.0 * curve.x) - np.sqrt(30.0**2 - 2.0 * curve.x)
    np.testing.assert_allclose(curve.y, expected, atol=1e-5)
    # The last place of the second, whose samples lie 0.2 m apart there, before the first stands.
    assert 250.0 - 0.22 < curve.x[-1] <= 250.0
    assert "difference distance" not in found.curves
    worst = found.worst["speed"]
    assert (worst.at, worst.second - worst.first) == (curve.x[-1], pytest.approx(expected[-1]))


@pytest.mark.parametrize(
    ("distance", "reason"),
    [
        (None, "in B there is no distance"),
        (np.zeros(101), "in B the distance stands still"),
        (np.arange(101.0)[::-1], "in B the distance has gaps or falls"),
        (np.where(np.arange(101) == 50, np.nan, np.arange(101.0)), "in B the distance has gaps or falls"),
        (np.arange(101.0) + 500.0, "A and B share no distance"),
    ],
)
def test_where_distance_makes_no_sense_it_is_said(distance, reason):
    first = make_recording(distance=np.arange(101.0))
    second = make_recording() if distance is None else make_recording(distance=distance)
    found = over_common_distance(first, second, ["speed"])
    assert (dict(found.curves), found.why_not) == ({}, reason)


def test_a_train_that_swings_back_as_it_stops_is_compared_over_distance():
    distance = np.arange(101.0)
    distance[99:] = [97.8, 97.5]
    read = over_distance(make_recording(distance=distance), "speed")
    assert read.at[-1] == 98.0
    assert len(read.at) == 99

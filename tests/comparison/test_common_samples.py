"""At which instants two recordings are compared, against what numpy and arithmetic say."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays

from uictest.analysis.comparison.overlay import (
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


def test_a_state_is_read_at_its_last_sample_and_not_between_two():
    valve = Sampled(np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 2.0, 2.0, 0.0]))
    other = Sampled(np.array([0.0, 1.5, 3.0]), np.array([0.0, 2.0, 0.0]))
    np.testing.assert_array_equal(common_samples(valve, other, holds=True).first, [0.0, 2.0, 0.0])
    np.testing.assert_array_equal(common_samples(other, valve, holds=False).second, [0.0, 2.0, 0.0])
    late = Sampled(np.array([0.5, 2.5]), np.array([0.0, 0.0]))
    np.testing.assert_array_equal(common_samples(valve, late, holds=True).first, [0.0, 2.0])
    np.testing.assert_array_equal(common_samples(valve, late).first, [1.0, 1.0])


def test_a_state_is_drawn_in_steps():
    valve = np.where(np.arange(101) >= 50, 2.0, 0.0)
    first, second = make_recording(valve_command_1=valve), make_recording(valve_command_1=np.zeros(101))
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


def test_what_was_not_compared_and_how_is_stated():
    assert list(sampling_remarks(make_recording(), make_recording())) == []
    remarks = list(sampling_remarks(make_recording(0.1), make_recording(0.25, end=8.0)))
    between = "and is read off straight lines between its samples"
    assert remarks == [
        f"compared at the instants of B, every 250 ms; A has a sample every 100 ms {between}",
        "A goes on for 2 s, from 8 s: not compared",
    ]
    late = Recording({"time": np.array([20.0, 21.0])}, {"time": "s"})
    assert list(sampling_remarks(make_recording(), late)) == [
        "A and B share no time: nothing of their channels is compared"
    ]

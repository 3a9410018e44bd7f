"""What a channel is at an instant, against what numpy and a walk through the samples say."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording import Contents, Group, at_instants, common_instants, covers, recording_of
from uictest.core.recording.formats import UnreadableError

TIMES = st.lists(st.integers(-50, 50), min_size=1, max_size=20, unique=True).map(
    lambda steps: 0.25 * np.array(sorted(steps))
)
INSTANTS = st.lists(st.integers(-120, 120), min_size=1, max_size=20).map(lambda ks: 0.125 * np.array(ks))


@given(TIMES, INSTANTS)
def test_a_signal_is_a_line_and_a_state_stands_as_far_as_there_are_samples(time, instants):
    samples = np.cos(7.0 * time)
    line = np.interp(instants, time, samples, left=np.nan, right=np.nan)
    np.testing.assert_allclose(at_instants(time, samples, instants, holds=False), line, atol=1e-12)
    stands = [
        next((x for t, x in zip(time[::-1], samples[::-1], strict=True) if t <= at), np.nan)
        if time[0] <= at <= time[-1]
        else np.nan
        for at in instants
    ]
    np.testing.assert_array_equal(at_instants(time, samples, instants, holds=True), stands)


@pytest.mark.parametrize("clock", [0.0, 86_399.99, 1.7e9])
def test_an_instant_that_is_rounded_is_still_that_of_its_sample(clock):
    time = clock + 0.01 * np.arange(1000)
    valve = np.where(np.arange(1000) >= 500, 2.0, 0.0)
    again = time[250] + 0.01 * np.arange(-250, 750)
    for instants in (again, np.nextafter(time, -np.inf), np.nextafter(time, np.inf)):
        np.testing.assert_array_equal(at_instants(time, valve, instants, holds=True), valve)
        assert covers(time, instants).all()


def test_what_lies_beside_a_missing_sample_or_in_a_gap_is_unknown_and_the_samples_are_not():
    time, samples = np.arange(5.0), np.array([0.0, 1.0, np.nan, 3.0, 4.0])
    gaps = np.array([False, False, False, True])
    at = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0])
    line = at_instants(time, samples, at, holds=False, gaps=gaps)
    np.testing.assert_array_equal(line, [0.5, 1.0, np.nan, np.nan, np.nan, 3.0, np.nan, 4.0])
    stands = at_instants(time, samples, at, holds=True, gaps=gaps)
    np.testing.assert_array_equal(stands, [0.0, 1.0, 1.0, np.nan, np.nan, 3.0, np.nan, 4.0])


@given(TIMES, TIMES)
def test_common_instants_are_samples_that_both_cover_in_either_order(first, second):
    common = common_instants(first, second)
    np.testing.assert_array_equal(common, common_instants(second, first))
    assert np.isin(common, [*first, *second]).all()
    assert covers(first, common).all()
    assert covers(second, common).all()


def test_of_two_equally_coarse_axes_the_samples_of_both_are_common_but_each_only_once():
    time = 0.01 * np.arange(100)
    np.testing.assert_array_equal(common_instants(time, np.nextafter(time, 1.0)), time)
    moved = common_instants(time, time + 0.004)
    assert len(moved) == 2 * 100 - 2
    np.testing.assert_array_equal(common_instants(time, time[::5]), time[::5])


def _named(**channels):
    group = Group("", {"time": np.arange(3.0), **channels}, {"time": "s", **dict.fromkeys(channels, "1")})
    return recording_of(Contents((group,)), {})


def test_names_of_states_are_read_as_their_numbers():
    read = _named(valve_command_2=np.array(["vent", "", "1"]), speed_valid=np.array(["no", "yes", "no"]))
    np.testing.assert_array_equal(read["valve_command_2"], [2.0, np.nan, 1.0])
    np.testing.assert_array_equal(read["speed_valid"], [0.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("channel", "accepted"), [("valve_command_1", "numbers, fill, hold, vent"), ("speed", "numbers")]
)
def test_a_text_that_names_no_state_is_refused_with_what_is_accepted(channel, accepted):
    with pytest.raises(UnreadableError, match=rf"'{channel}' contains texts: 'lösen'; accepted: {accepted}$"):
        _named(**{channel: np.array(["1", "lösen", "2"])})

"""A comparison says the same whichever side is named first, and an export agrees with what was exported."""

import tempfile
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra import numpy as arrays

from uictest.analysis.comparison import Tolerances, compare_recordings
from uictest.core.recording import Recording, recording_of
from uictest.core.recording.formats import FORMATS, Dialect, encoded
from uictest.core.recording.formats.isolation import read_here

INTERVALS = st.sampled_from([0.001, 0.01, 0.01 / 3.0, 0.1, 0.25])
STARTS = st.sampled_from([0.0, 0.07, 12.3, 86_399.99, 1.7e9])
UNITS = {"time": "s", "speed": "m/s", "slide_1": "1"}


@st.composite
def time_axes(draw):
    """An even raster or an uneven one, from a stop of its own to the clock of a computer."""
    count, interval, start = draw(st.integers(2, 40)), draw(INTERVALS), draw(STARTS)
    if draw(st.booleans()):
        return start + interval * np.arange(count)
    steps = draw(arrays.arrays(np.float64, count, elements=st.floats(0.5, 2.0)))
    return start + interval * np.cumsum(steps)


def _samples(draw, count, values, kind=np.float64):
    return draw(arrays.arrays(kind, count, elements=values))


@st.composite
def recordings(draw, times=None):
    """Signals with gaps, named states, one that has no name at times, and bits. CSV has ten digits."""
    time = draw(time_axes()) if times is None else times
    states = st.sampled_from([0.0, 1.0, 2.0, np.nan])
    channels = {
        "time": time,
        "speed": _samples(draw, len(time), st.just(np.nan) | st.floats(-200.0, 200.0)),
        "slide_1": _samples(draw, len(time), st.floats(0.0, 1.0, width=32), np.float32),
        "valve_command_1": _samples(draw, len(time), states),
        "valve_command_2": _samples(draw, len(time), states | st.just(0.5)),
        "vent_magnet_1": _samples(draw, len(time), st.integers(0, 1), np.int8),
        "brake_command": _samples(draw, len(time), st.booleans(), np.bool_),
        "diagnosis": _samples(draw, len(time), st.sampled_from([0.0, 1.0, 2.0**31, 2.0**32 - 1.0])),
    }
    return Recording(channels, {name: UNITS.get(name, "1") for name in channels}, {"case": "made"})


def exported(record, name):
    """Return what is read of a recording that was written in a format."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"stop{FORMATS[name].suffix}")
        path.write_bytes(encoded(record, name))
        return recording_of(read_here(name, path, Dialect()), {})


def compared(first, second):
    return compare_recordings(first, second, ("a", "b"), Tolerances())


def told(comparison, *, swapped=False):
    """Return what a comparison says of each quantity, for the eyes of a test: NaN is NaN there."""
    return {
        each.quantity: repr(
            (
                *((each.second, each.first) if swapped else (each.first, each.second)),
                *(each.within, each.deviation, each.allowed, each.remark),
            )
        )
        for each in comparison.differences
    }


@settings(max_examples=25)
@given(recordings())
def test_exports_agree_with_the_recording_and_with_each_other_in_either_order(record):
    sides = {"as it was": record, **{name: exported(record, name) for name in FORMATS}}
    for (one, first), (other, second) in permutations(sides.items(), 2):
        found = compared(first, second)
        assert found.agrees, (one, other, found.beyond)
        # Ten digits of a signal are those of rounding; states and bits are whole.
        assert {each.quantity for each in found.differences} <= {"duration", "speed", "slide_1"}, (one, other)
        assert found.compared == len(record.channels)


@given(st.data(), recordings(), st.booleans())
def test_which_side_is_named_first_changes_no_number(data, first, shifted):
    time = data.draw(time_axes())
    if shifted:  # by less than a sample, of another length
        time = first["time"][: data.draw(st.integers(1, len(first)))] + data.draw(st.floats(0.0, 0.01))
    second = data.draw(recordings(time))
    assert told(compared(first, second)) == told(compared(second, first), swapped=True)


@pytest.mark.parametrize("share", [1e-7, 0.3, 0.999])
def test_a_recording_and_the_same_moved_by_less_than_a_sample(share):
    time = 0.01 * np.arange(1000)
    valve = np.where(time >= 5.0, 2.0, 0.0)
    first, second = (
        Recording({"time": at, "valve_command_1": valve}, {"time": "s", "valve_command_1": "1"})
        for at in (time, time + share * 0.01)
    )
    # Between the two changes the sides differ, unless they are one but for rounding.
    both = compared(first, second), compared(second, first)
    assert [found.agrees for found in both] == [share < 1e-6] * 2
    assert told(both[0]) == told(both[1], swapped=True)


@settings(max_examples=25)
@given(st.data(), recordings(), st.sampled_from([*FORMATS]))
def test_an_export_in_place_of_a_recording_shows_the_same_states(data, first, name):
    second = data.draw(recordings(data.draw(time_axes())))
    states = ("valve_command_1", "valve_command_2", "vent_magnet_1", "brake_command", "diagnosis")
    one, other = (
        {k: v for k, v in told(compared(side, second)).items() if k in states}
        for side in (first, exported(first, name))
    )
    assert one == other

"""Simulated stops as recordings, and what a measurement makes of them."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import TIME
from uictest.recorded.field_data import Preparation, RawChannel, judge_recording, prepare, stated_case
from uictest.rig import simulate

STATEMENTS = (
    "rail.condition=wet",
    "rail.friction=0.08",
    "brake.position=R",
    "rig.wsp=active",
    "criteria=[uictest-stop, uic-541-05-appendix-b]",
)


def judge_stop(case, stop):
    """Return the result of a recorded stop."""
    result, _ = judge_recording(case, stop)
    return result


@cache
def _case():
    return replace(stated_case("slides-40", 40.0 / 3.6, STATEMENTS), path=Path("stop"))


@cache
def _stop(rate):
    return simulate(_case(), record_every=1.0 / rate)


@pytest.fixture(scope="session")
def case():
    """A stop from 40 km/h on a rail so wet that every wheelset slides."""
    return _case()


@pytest.fixture(scope="session")
def simulated():
    """The stop, recorded at a rate in Hz."""
    return _stop


@pytest.fixture(scope="session")
def recording():
    """The stop's recording at 100 Hz."""
    recording = _stop(100.0).recording
    assert recording is not None
    return recording


@pytest.fixture
def channels(recording):
    """Every channel of the recording, free to be damaged."""
    return channels_of(recording)


def channels_of(recording):
    """Return every channel of a recording, free to be damaged."""
    time = np.array(recording[TIME])
    return {
        name: RawChannel(name, name, time, np.array(samples, dtype=np.float64))
        for name, samples in recording.channels.items()
        if name != TIME
    }


def kept(channels, chosen):
    """Return channels of one time axis with some of their samples."""
    time = next(iter(channels.values())).time[chosen]
    return {name: replace(each, time=time, samples=each.samples[chosen]) for name, each in channels.items()}


@pytest.fixture(scope="session")
def prepared(recording):
    """Prepare channels with the facts of the recording, or others."""

    def make(channels, facts=None, **choices):
        preparation = Preparation.model_validate(choices)
        return prepare(channels, recording.metadata if facts is None else facts, preparation)

    return make

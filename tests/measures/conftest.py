"""A stop as columns of samples, fed to the streaming measures one row at a time."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    MeasureDefinition,
    begin_slides,
    begin_train,
    begin_wheelset,
    begin_window,
)
from uictest.core.measures.train import keep_window, observe_train
from uictest.core.measures.wheelset import keep_slide, observe_wheelset
from uictest.core.record import fields_of

Column = NDArray[np.float64]

STANDARD = {
    "sliding_slide": 0.05,
    "sliding_slip": 0.3,
    "locked_speed": 0.1,
    "moving_speed": 2.8,
    "deceleration_filter": 0.5,
    "developed_time": 2.0,
    "rising_share": 0.05,
    "developed_share": 0.95,
    "reduced_share": 0.9,
}


@dataclass(frozen=True)
class Samples:
    """Columns of a stop; those of the wheelsets have four columns of their own."""

    time: Column
    distance: Column
    speed: Column
    wheel_speed: Column
    venting: Column
    clamping_force: Column
    disc_temperature: Column
    reservoir_pressure: Column


def _samples():
    """Half a minute of braking from 30 m/s with slides, a lock and vents, none of them regular."""
    random = np.random.default_rng(5)
    time = np.arange(2601) * 0.01
    speed = 30.0 - 1.1 * np.maximum(time - 0.7, 0.0) + 0.02 * np.sin(9.0 * time)
    slide = np.zeros((time.size, 4))
    for i, (begin_at, depth) in enumerate(((4.0, 0.2), (2.5, 0.6), (6.0, 0.03), (3.0, 1.5))):
        slide[:, i] = np.clip(depth * np.sin((time - begin_at) * (0.5 + 0.3 * i)), 0.0, 1.0) * (
            time > begin_at
        )
    noise = 1.0 - 0.002 * random.random((time.size, 4))
    return Samples(
        time=time,
        distance=np.concatenate([[0.0], np.cumsum(0.005 * (speed[1:] + speed[:-1]))]),
        speed=speed,
        wheel_speed=speed[:, None] * (1.0 - slide) * noise,
        venting=(np.sin(time[:, None] * np.array([1.1, 2.3, 3.1, 0.7])) > 0.6).astype(float),
        clamping_force=14e3
        * np.minimum(time[:, None] / 2.0, 1.0)
        * random.uniform(0.95, 1.0, (time.size, 4)),
        disc_temperature=293.15
        + 80.0 * np.sqrt(time[:, None]) * (1.0 - time[:, None] / 30.0) * np.array([1.0, 0.99, 0.97, np.nan]),
        reservoir_pressure=8e5 - 3e4 * np.sin(time / 8.0),
    )


def _measured(samples):
    """Measures of the train and of its wheelsets after all samples but the first, which begins them."""
    definition = SimpleNamespace(**dict.fromkeys(fields_of(MeasureDefinition), 0.0) | STANDARD)
    # Plain numbers, a record's of numpy take three times as long.
    train, *wheelsets = map(_blank, (STOP_MEASURES, *[WHEELSET_MEASURES] * 4))
    first = (samples.time[0], samples.distance[0], samples.speed[0], samples.reservoir_pressure[0])
    begin_train(train, *map(float, first), 3.8e5, 0.0)
    begin_window(train)
    for i in range(4):
        begin_wheelset(wheelsets[i])
        begin_slides(wheelsets[i])
    for k in range(1, samples.time.size):
        time, speed = float(samples.time[k]), float(samples.speed[k])
        for i in range(4):
            columns = (
                *(samples.wheel_speed, samples.venting),
                *(samples.clamping_force, samples.disc_temperature),
            )
            row = [float(column[k, i]) for column in columns]
            observe_wheelset(wheelsets[i], train, definition, i + 1, time, speed, *row)
            keep_slide(wheelsets[i], wheelsets[i], definition, speed)
        observe_train(
            train, definition, time, float(samples.distance[k]), speed, float(samples.reservoir_pressure[k])
        )
        keep_window(train, train)
    return _records(STOP_MEASURES, [train])[0], _records(WHEELSET_MEASURES, wheelsets)


def _blank(layout):
    zero = np.zeros(1, layout)[0]
    return SimpleNamespace(**{name: zero[name].tolist() for name in layout.names})


def _records(layout, measures):
    records = np.zeros(len(measures), layout).view(np.recarray)
    for name in layout.names:
        records[name] = [getattr(each, name) for each in measures]
    return records


@pytest.fixture(name="measured", scope="session")
def _measured_fixture():
    """Measure samples: the record of the train and four of wheelsets."""
    return _measured


@pytest.fixture(name="samples", scope="session")
def _samples_fixture():
    """A stop with slides."""
    return _samples()


@pytest.fixture(name="stop", scope="session")
def _stop_fixture(samples):
    """The measures of that stop."""
    return _measured(samples)

"""The measures of a recorded stop, and the work and force of the rail in it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import inf, isnan
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import (
    END_SPEEDS,
    SLOW_TIMES,
    SPEED_CLASSES,
    STOP_MEASURES,
    WHEELSET_MEASURES,
    WINDOW_SECONDS,
    MeasureDefinition,
    begin_build_up,
    begin_contact,
    begin_slides,
    begin_slow_times,
    begin_train,
    begin_utilisation,
    begin_wheelset,
    begin_window,
    close_contacts,
    keep_slide,
    keep_slow_times,
    keep_window,
    note_standstill,
    observe_build_up,
    observe_contact,
    observe_reservoir_margin,
    observe_train,
    observe_wheelset,
)
from uictest.core.physics import VENT
from uictest.core.record import fields_of
from uictest.core.recording import TIME, Recording
from uictest.core.units import STANDARD_GRAVITY
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.recorded.field_data.channels import WHEELSETS
from uictest.recorded.field_data.recorded_stop import RecordedStop
from uictest.recorded.field_data.support import coverage_of
from uictest.rig import highest_creep_forces

Array = NDArray[np.float64]
_WHEELS: Final = 2.0
"""Of a wheelset: adhesion and wheel load are those of one."""


@dataclass(frozen=True, slots=True)
class RailContact:
    """Contacts of the four wheelsets at every sample, shape (n, 4); NaN where a channel is missing.

    Args:
        rail_work: of the rail on the wheelset since the first sample, against its motion, J.
        contact_loss: energy turned into heat in its contacts since then, J.
        highest_force: that both contacts could transmit, N.
        mass: of the train, kg.

    """

    rail_work: Array
    contact_loss: Array
    highest_force: Array
    mass: float


def rail_contact(recording: Recording, condition: scenario.RailCondition) -> RailContact:
    """Return the contacts of a recorded stop.

    Work is integrated by trapezoids; a gap adds none. The mass is that of the mean wheel loads.
    """
    speed = recording["speed"]
    load, friction = _channels(recording, "wheel_load"), _channels(recording, "friction")
    force = _WHEELS * _channels(recording, "adhesion") * load
    slip = speed[:, None] - _channels(recording, "wheel_speed")
    time = recording[TIME]
    highest = partial(highest_creep_forces, condition, speed)
    mean_load = np.nanmean(load, axis=0) if np.isfinite(load).any(axis=0).all() else np.full(4, np.nan)
    return RailContact(
        _integrated(force * speed[:, None], time),
        _integrated(force * slip, time),
        _WHEELS * np.stack([highest(load[:, i], friction[:, i]) for i in range(len(WHEELSETS))], axis=1),
        _WHEELS * float(mean_load.sum()) / STANDARD_GRAVITY,
    )


def _channels(recording: Recording, kind: str) -> Array:
    """Return a channel of each wheelset, shape (n, 4)."""
    unknown = np.full(len(recording), np.nan)
    return np.stack([recording.channels.get(f"{kind}_{n}", unknown) for n in WHEELSETS], axis=1)


def _integrated(power: Array, time: Array) -> Array:
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(time)[:, None]
    return np.concatenate((np.zeros((1, power.shape[1])), np.cumsum(np.nan_to_num(steps), axis=0)))


@dataclass(frozen=True, slots=True)
class Observed:
    """Measures of a stop and of its wheelsets, SI, over the recorded samples, and what is missing."""

    measures: Any
    wheelset_measures: Any
    coverage: evaluation.Coverage


def observe(stop: RecordedStop, judged_under: scenario.Scenario) -> Observed:
    """Return the measures of a recorded stop under the definitions and the conditions of a scenario.

    The rail condition gives the creep curve of the wheelsets, brake command and position the pressure that is
    commanded.
    """
    # Plain objects in the loop: attributes of numpy records take ten times as long outside compiled code.
    train: Any = SimpleNamespace(
        speed_after_sliding=[0.0] * (WINDOW_SECONDS + 1),
        reached_time=[0.0] * len(END_SPEEDS),
        half_slow_time=[0.0] * SLOW_TIMES,
    )
    wheelsets: list[Any] = [
        SimpleNamespace(maximum_slide_above=[0.0] * SPEED_CLASSES, slow_time=[0.0] * SLOW_TIMES)
        for _ in WHEELSETS
    ]
    defined = SimpleNamespace(
        **{name: float(getattr(judged_under.measures, name)) for name in fields_of(MeasureDefinition)}
    )
    contact = rail_contact(stop.recording, judged_under.rail.condition)
    samples = _samples_of(stop.recording, contact)
    commanded = float(judged_under.brake.commanded_pressure)
    _begin(samples, train, wheelsets, commanded)
    _observe(stop, samples, train, wheelsets, defined)
    close_contacts(train, wheelsets, contact.mass)
    records = np.zeros(len(WHEELSETS), WHEELSET_MEASURES)
    for record, wheelset in zip(records, wheelsets, strict=True):
        _copy(wheelset, record)
    stop_measures = np.zeros(1, STOP_MEASURES)
    _copy(train, stop_measures[0])
    return Observed(stop_measures[0], records.view(np.recarray), coverage_of(stop))


@dataclass(frozen=True, slots=True)
class _Samples:
    """Samples of a recording as lists, which plain Python reads fastest; NaN where nothing was recorded."""

    time: list[float]
    distance: list[float]
    speed: list[float]
    reservoir: list[float]
    line: list[float]
    highest_cylinder: list[float]
    wheel_speed: list[list[float]]
    venting: list[list[float]]
    force: list[list[float]]
    disc_temperature: list[list[float]]
    tank: list[list[float]]
    rail_work: list[list[float]]
    contact_loss: list[list[float]]
    highest_force: list[list[float]]


def _samples_of(recording: Recording, contact: RailContact) -> _Samples:
    time, distance, speed = (recording[name].tolist() for name in (TIME, "distance", "speed"))
    cylinders = [_channel(recording, f"cylinder_pressure_{n}") for n in WHEELSETS]
    return _Samples(
        time,
        distance,
        speed,
        _channel(recording, "reservoir_pressure").tolist(),
        _channel(recording, "brake_line_pressure").tolist(),
        np.fmax.reduce(cylinders).tolist(),
        [_channel(recording, f"wheel_speed_{n}").tolist() for n in WHEELSETS],
        [_venting(_channel(recording, f"valve_command_{n}")).tolist() for n in WHEELSETS],
        [_channel(recording, f"clamping_force_{n}").tolist() for n in WHEELSETS],
        [_channel(recording, f"disc_surface_temperature_{n}").tolist() for n in WHEELSETS],
        [_channel(recording, f"tank_pressure_{n}").tolist() for n in WHEELSETS],
        contact.rail_work.T.tolist(),
        contact.contact_loss.T.tolist(),
        contact.highest_force.T.tolist(),
    )


def _observe(
    stop: RecordedStop, samples: _Samples, train: Any, wheelsets: list[Any], definition: Any
) -> None:
    end = inf if stop.standstill is None else stop.standstill[0]
    for k in range(1, len(samples.time)):
        time, speed = samples.time[k], samples.speed[k]
        if time >= end:
            break
        for i, wheelset in enumerate(wheelsets):
            _observe_wheelset(samples, k, i, wheelset, train, definition)
        observe_reservoir_margin(train, samples.reservoir[k], samples.highest_cylinder[k])
        observe_build_up(train, definition, time, samples.distance[k], speed, samples.line[k])
        observe_train(train, definition, time, samples.distance[k], speed, samples.reservoir[k])
        keep_window(train, train)
        keep_slow_times(train, wheelsets, train, wheelsets)
    if stop.standstill is not None:
        observe_train(train, definition, *stop.standstill, 0.0, train.reservoir_minimum_pressure)
        keep_window(train, train)
        keep_slow_times(train, wheelsets, train, wheelsets)
        note_standstill(train, True, *stop.standstill)


def _begin(samples: _Samples, train: Any, wheelsets: list[Any], commanded_pressure: float) -> None:
    begin_train(train, samples.time[0], samples.distance[0], samples.speed[0], samples.reservoir[0])
    begin_build_up(train, commanded_pressure, samples.line[0])
    begin_utilisation(train)
    begin_window(train)
    begin_slow_times(train, wheelsets)
    for wheelset in wheelsets:
        begin_wheelset(wheelset)
        begin_contact(wheelset)
        begin_slides(wheelset)


def _observe_wheelset(samples: _Samples, k: int, i: int, wheelset: Any, train: Any, definition: Any) -> None:
    speed, wheel_speed = samples.speed[k], samples.wheel_speed[i][k]
    observe_wheelset(
        wheelset,
        train,
        definition,
        i + 1,
        samples.time[k],
        speed,
        wheel_speed,
        samples.venting[i][k],
        samples.force[i][k],
        samples.disc_temperature[i][k],
    )
    observe_contact(
        wheelset,
        train,
        definition,
        samples.time[k],
        speed,
        samples.tank[i][k],
        samples.line[k],
        samples.rail_work[i][k],
        samples.contact_loss[i][k],
        samples.highest_force[i][k],
    )
    if isnan(speed - wheel_speed):
        # A lock before a gap and one after it need not be the same lock.
        wheelset.lock = 0.0
    else:
        keep_slide(wheelset, wheelset, definition, speed)


def _channel(recording: Recording, name: str) -> NDArray[np.float64]:
    if name in recording.channels:
        return np.asarray(recording[name], dtype=np.float64)
    return np.full(len(recording), np.nan)


def _venting(command: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return 1 while the valve is commanded to vent. A gap keeps the state before it: one vent is not two."""
    last_known = np.maximum.accumulate(np.where(np.isnan(command), 0, np.arange(len(command))))
    return np.where(command[last_known] == VENT, 1.0, 0.0)


def _copy(source: Any, record: Any) -> None:
    for name in record.dtype.names:
        record[name] = getattr(source, name)

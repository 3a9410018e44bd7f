"""The measures of a recorded stop, taken sample by sample as the simulator takes its own."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest import evaluation, scenario
from uictest.field_data.channels import WHEELSETS
from uictest.field_data.recorded_stop import RecordedStop
from uictest.field_data.support import coverage_of
from uictest.measures import (
    SPEED_CLASSES,
    STOP_MEASURES,
    WHEELSET_MEASURES,
    WINDOW_SECONDS,
    MeasureDefinition,
    begin,
    begin_slides,
    begin_wheelset,
    begin_window,
    finish,
    keep_slide,
    keep_window,
    observe_train,
    observe_wheelset,
)
from uictest.record import fields_of
from uictest.recording import TIME, Recording

_VENT = 2.0
"""State of the valve command that vents."""


@dataclass(frozen=True, slots=True)
class Observed:
    """Measures of a stop and of its wheelsets, SI, over the samples that there are, and what is missing."""

    measures: Any
    wheelset_measures: Any
    coverage: evaluation.Coverage


def observe(stop: RecordedStop, definition: scenario.MeasureDefinitions) -> Observed:
    """Return the measures of a recorded stop under a scenario's definitions."""
    # Plain objects in the loop: attributes of numpy records take ten times as long outside compiled code.
    train = SimpleNamespace(speed_after_sliding=[float("nan")] * (WINDOW_SECONDS + 1))
    wheelsets = [SimpleNamespace(maximum_slide_above=[0.0] * SPEED_CLASSES) for _ in WHEELSETS]
    defined = SimpleNamespace(
        **{name: float(getattr(definition, name)) for name in fields_of(MeasureDefinition)}
    )
    _observe(stop, train, wheelsets, defined)
    records = np.zeros(len(WHEELSETS), WHEELSET_MEASURES)
    for record, wheelset in zip(records, wheelsets, strict=True):
        _copy(wheelset, record)
    whole = np.zeros(1, STOP_MEASURES)
    _copy(train, whole[0])
    return Observed(whole[0], records.view(np.recarray), coverage_of(stop))


def _observe(stop: RecordedStop, train: Any, wheelsets: list[Any], definition: Any) -> None:
    recording = stop.recording
    time, distance, speed = (recording[name].tolist() for name in (TIME, "distance", "speed"))
    reservoir = _samples(recording, "reservoir_pressure").tolist()
    wheels = [_samples(recording, f"wheel_speed_{n}").tolist() for n in WHEELSETS]
    venting = [_venting(_samples(recording, f"valve_command_{n}")).tolist() for n in WHEELSETS]
    force = [_samples(recording, f"clamping_force_{n}").tolist() for n in WHEELSETS]
    begin(train, time[0], distance[0], speed[0], reservoir[0])
    begin_window(train)
    for wheelset in wheelsets:
        begin_wheelset(wheelset)
        begin_slides(wheelset)
    rest = stop.standstill
    for k in range(1, len(time)):
        if rest is not None and time[k] >= rest[0]:
            break
        for i, wheelset in enumerate(wheelsets):
            observe_wheelset(
                wheelset,
                train,
                definition,
                i + 1,
                time[k],
                speed[k],
                wheels[i][k],
                venting[i][k],
                force[i][k],
            )
            if isnan(speed[k] - wheels[i][k]):
                # A lock before a gap and one after it need not be the same lock.
                wheelset.lock = 0.0
            else:
                keep_slide(wheelset, wheelset, definition, speed[k])
        observe_train(train, definition, time[k], distance[k], speed[k], reservoir[k])
        keep_window(train, train)
    if rest is not None:
        observe_train(train, definition, rest[0], rest[1], 0.0, train.reservoir_minimum_pressure)
        keep_window(train, train)
        finish(train, True, *rest)


def _samples(recording: Recording, name: str) -> NDArray[np.float64]:
    if name in recording.channels:
        return np.asarray(recording[name], dtype=np.float64)
    return np.full(len(recording), np.nan)


def _venting(command: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return 1 while the valve is commanded to vent. A gap keeps the state before it: one vent is not two."""
    last_known = np.maximum.accumulate(np.where(np.isnan(command), 0, np.arange(len(command))))
    return np.where(command[last_known] == _VENT, 1.0, 0.0)


def _copy(source: Any, record: Any) -> None:
    for name in record.dtype.names:
        record[name] = getattr(source, name)

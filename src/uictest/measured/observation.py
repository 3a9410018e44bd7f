"""The measures of a recorded stop, taken sample by sample as the simulator takes its own."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from uictest.measured.channels import WHEELSETS
from uictest.measured.prepare import MeasuredStop
from uictest.measured.support import unsupported
from uictest.measures import (
    DEFINITION,
    MEASURES,
    SPEED_CLASSES,
    WHEELSET_MEASURES,
    WINDOW_SECONDS,
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
from uictest.recording import TIME, Recording

if TYPE_CHECKING:
    from uictest.scenario.parts.measures import MeasureDefinitions

_VENT = 2.0
"""State of the valve command that vents."""
_OF_STOP = frozenset(
    {
        "minimum_deceleration",
        "maximum_deceleration",
        "reservoir_minimum_pressure",
        "braking_distance",
        "braking_time",
    }
)
_OF_WHEELSETS = frozenset(
    {"maximum_slide", "locked_time", "longest_lock", "sliding_duration", "maximum_clamping_force"}
)


@dataclass(frozen=True, slots=True)
class Observed:
    """Measures of a stop and of its wheelsets, SI, and why those are missing that are."""

    measures: Any
    wheelset_measures: Any
    missing: dict[str, str]


def observe(stop: MeasuredStop, definition: MeasureDefinitions) -> Observed:
    """Return the measures of a recorded stop under a scenario's definitions."""
    # Plain objects in the loop: attributes of numpy records take ten times as long outside compiled code.
    train = SimpleNamespace(speed_after_sliding=[float("nan")] * (WINDOW_SECONDS + 1))
    wheelsets = [SimpleNamespace(maximum_slide_above=[0.0] * SPEED_CLASSES) for _ in WHEELSETS]
    defined = SimpleNamespace(**{name: float(getattr(definition, name)) for name, _ in DEFINITION})
    _observe(stop, train, wheelsets, defined)
    missing = unsupported(stop)
    _forget_unsupported(train, wheelsets, missing)
    records = np.zeros(len(WHEELSETS), WHEELSET_MEASURES)
    for record, wheelset in zip(records, wheelsets, strict=True):
        _copy(wheelset, record)
    whole = np.zeros(1, MEASURES)
    _copy(train, whole[0])
    return Observed(measures=whole[0], wheelset_measures=records.view(np.recarray), missing=missing)


def _observe(stop: MeasuredStop, train: Any, wheelsets: list[Any], definition: Any) -> None:
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
    return np.where(command == _VENT, 1.0, 0.0)


def _forget_unsupported(train: Any, wheelsets: list[Any], missing: dict[str, str]) -> None:
    """Leave no number where a record does not support one: what was added up may be of any size."""
    for name in _OF_STOP & missing.keys():
        setattr(train, name, float("nan"))
    if "initial_adhesion" in missing:
        train.sliding_time = float("nan")
        train.speed_after_sliding = [float("nan")] * (WINDOW_SECONDS + 1)
    for wheelset in wheelsets:
        for name in _OF_WHEELSETS & missing.keys():
            setattr(wheelset, name, float("nan"))
        if "maximum_slide" in missing:
            wheelset.maximum_slide_above = [float("nan")] * SPEED_CLASSES
            wheelset.first_sliding_time = float("nan")
        if "valve_actuations" in missing:
            wheelset.valve_actuations = float("nan")


def _copy(source: Any, record: Any) -> None:
    for name in record.dtype.names:
        record[name] = getattr(source, name)

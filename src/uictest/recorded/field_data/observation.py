"""The measures of a recorded stop."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    MeasureDefinition,
    Replay,
    close_contacts,
    samples_of,
)
from uictest.core.record import fields_of
from uictest.core.recording import Recording
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


def _highest_forces(recording: Recording, condition: scenario.RailCondition) -> Array:
    """Return what both contacts of each wheelset could transmit at every sample, N, shape (n, 4)."""
    friction, load = _channels(recording, "friction"), _channels(recording, "wheel_load")
    highest = [
        highest_creep_forces(condition, recording["speed"], *each)
        for each in zip(load.T, friction.T, strict=True)
    ]
    return _WHEELS * np.stack(highest, axis=1)


def _mass(recording: Recording) -> float:
    """Return the mass of the train by the mean wheel loads, kg; NaN where one of them is not known."""
    load = _channels(recording, "wheel_load")
    known = np.isfinite(load).any(axis=0).all()
    return _WHEELS * float(np.nanmean(load, axis=0).sum()) / STANDARD_GRAVITY if known else np.nan


def _channels(recording: Recording, kind: str) -> Array:
    """Return a channel of each wheelset, shape (n, 4); NaN where it is missing."""
    unknown = np.full(len(recording), np.nan)
    return np.stack([recording.channels.get(f"{kind}_{n}", unknown) for n in WHEELSETS], axis=1)


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
    recording, measures = stop.recording, judged_under.measures
    definition = SimpleNamespace(
        **{name: float(getattr(measures, name)) for name in fields_of(MeasureDefinition)}
    )
    highest_forces = _highest_forces(recording, judged_under.rail.condition)
    replay = Replay(
        samples_of(recording.channels, highest_forces),
        definition,
        float(judged_under.brake.commanded_pressure),
    )
    for _ in replay.pass_samples(inf if stop.standstill is None else stop.standstill[0]):
        pass
    if stop.standstill is not None:
        replay.stop_at(*stop.standstill)
    train, wheelsets = replay.train, replay.wheelsets
    close_contacts(train, wheelsets, _mass(recording))
    records = np.zeros(len(WHEELSETS), WHEELSET_MEASURES)
    for record, wheelset in zip(records, wheelsets, strict=True):
        _copy(wheelset, record)
    stop_measures = np.zeros(1, STOP_MEASURES)
    _copy(train, stop_measures[0])
    return Observed(stop_measures[0], records.view(np.recarray), coverage_of(stop))


def _copy(source: Any, record: Any) -> None:
    for name in record.dtype.names:
        record[name] = getattr(source, name)

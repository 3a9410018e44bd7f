"""What the measures of a recorded stop are fed with, and its judgement."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest import report
from uictest.core.measures import (
    MeasureDefinition,
    Replay,
    close_contacts,
    samples_of,
)
from uictest.core.record import fields_of
from uictest.core.recording import BRAKE_COMMAND_TIME, TIME, TRACK_BRAKES_BESIDE, Recording
from uictest.core.units import KILOMETRE_PER_HOUR, STANDARD_GRAVITY
from uictest.judging import evaluation
from uictest.judging.evaluation import CaseResult, evaluate
from uictest.plans import scenario
from uictest.plans.scenario import Case, Scenario
from uictest.recorded.field_data.agreement import record_verdicts
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, WHEELSETS
from uictest.recorded.field_data.recorded_stop import RecordedStop
from uictest.recorded.field_data.support import coverage_of
from uictest.rig import highest_creep_forces, pass_samples

Array = NDArray[np.float64]
_WHEELS: Final = 2.0
"""Of a wheelset: adhesion and wheel load are those of one."""


def _highest_forces(recording: Recording, judged_under: scenario.Scenario) -> Array:
    """Return what both contacts of each wheelset could transmit at every sample, N, shape (n, 4).

    Where the curve goes over to that of a clean rail, it is known only with the cleaned share.
    """
    rail = judged_under.rail
    friction, load = _channels(recording, "friction"), _channels(recording, "wheel_load")

    def highest(curve: scenario.CreepCurve | None) -> Array:
        wheels = zip(load.T, friction.T, strict=True)
        forces = [highest_creep_forces(rail.condition, recording["speed"], *each, curve) for each in wheels]
        return _WHEELS * np.stack(forces, axis=1)

    cleaning, found = rail.cleaning_in_force, highest(None)
    if cleaning is None or cleaning.clean_curve is None:
        return found
    return found + _channels(recording, "cleaned_share") * (highest(cleaning.clean_curve) - found)


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
    highest_forces = _highest_forces(recording, judged_under)
    samples = samples_of(recording.channels, highest_forces)
    end = inf if stop.standstill is None else stop.standstill[0]
    replay = Replay(samples, definition, judged_under.developed_pressure, end)
    pass_samples(replay)
    if stop.standstill is not None:
        replay.stop_at(*stop.standstill)
    train, wheelsets = replay.train, replay.wheelsets
    _observe_track_brake(train, recording)
    train.track_brake_time_beside = stop.track_brakes_beside
    close_contacts(train, wheelsets, _mass(recording))
    return Observed(train, wheelsets, coverage_of(stop))


def _observe_track_brake(train: Any, recording: Recording) -> None:
    """Set energy and time of the track brake where its force was recorded; a gap adds none."""
    if "track_brake_force" in recording.channels:
        force = np.nan_to_num(recording["track_brake_force"])
        train.track_brake_energy = float(np.trapezoid(force * recording["speed"], recording[TIME]))
        train.track_brake_time = float(np.diff(recording[TIME])[force[1:] > 0.0].sum())


def judge_recording(case: scenario.Case, stop: RecordedStop) -> tuple[CaseResult, Recording]:
    """Return the result of a recorded stop under the conditions and criteria of a case, and its recording.

    The definition of every verdict states how the record was prepared and what is wrong with it. The
    recording carries the metadata that a simulated one has.
    """
    observed = observe(stop, case.scenario)
    case = case.changed(scenario.with_another_controller)  # that of the train, not of the scenario
    result = evaluate(
        case,
        observed.measures,
        observed.wheelset_measures,
        coverage=observed.coverage,
        of_record=record_verdicts(case, stop),
    )
    preparation = dict(stop.choices)
    if stop.defects:
        preparation["defects"] = "; ".join(map(str, stop.defects))
    criteria = tuple(
        replace(verdict, definition={**verdict.definition, **preparation}) for verdict in result.criteria
    )
    recording = replace(stop.recording, metadata=dict(_metadata(case, stop, observed)))
    return replace(result, criteria=criteria), recording


def _metadata(case: scenario.Case, stop: RecordedStop, observed: Observed) -> Iterator[tuple[str, str]]:
    yield "case", case.id
    if not stop.trigger.late:
        yield BRAKE_COMMAND_TIME, "0 s"
    if stop.track_brakes_beside > 0.0:
        yield TRACK_BRAKES_BESIDE, f"{stop.track_brakes_beside:.6g} s"
    known = "initial_adhesion" not in observed.coverage.missing
    if known and math.isfinite(observed.measures.sliding_time):
        yield "sliding_time", f"{observed.measures.sliding_time:.6g}"


_ASSUMED = " (assumed: not stated)"
_TITLE = "Recorded stop"


def recorded_description(case: Case, stop: RecordedStop | None) -> report.CaseDescription:
    """Return the description of a recorded stop; `stop` is None where the record cannot be used.

    It leaves out what only a simulation has: vehicle, friction, controller and topology. A condition that
    criteria depend on and nobody stated is marked as assumed.
    """
    title = case.scenario.title
    return report.CaseDescription(
        f"{_TITLE}, judged as: {title}" if title else _TITLE,
        tuple(case.scenario.tags),
        dict(_conditions(case.scenario, stop)),
        {"file": case.path.as_posix(), **(dict(_origin(stop)) if stop else {})},
    )


def _conditions(scenario: Scenario, stop: RecordedStop | None) -> Iterator[tuple[str, str]]:
    if stop is not None:
        yield "initial speed", f"{stop.recording['speed'][0] / KILOMETRE_PER_HOUR:.4g} km/h, recorded"
    brake, rail, rig = scenario.brake, scenario.rail, scenario.rig
    yield "brake position", brake.position + _unless_stated("position" in brake.model_fields_set)
    yield "brake command", brake.command_text + _unless_stated("command" in brake.model_fields_set)
    yield "rail", rail.condition.name
    yield "gradient", rail.gradient.text + _unless_stated("gradient" in rail.model_fields_set)
    yield "WSP", rig.wsp + _unless_stated("wsp" in rig.model_fields_set)
    yield "criteria", ", ".join(profile.name for profile in scenario.criteria)


def _unless_stated(stated: bool) -> str:
    return "" if stated else _ASSUMED


def _origin(stop: RecordedStop) -> Iterator[tuple[str, str]]:
    channels = list(stop.recording.channels)
    distance = stop.choices["distance"]
    if distance != "recorded":
        channels.remove("distance")
    yield "channels read", ", ".join(_grouped(channels))
    if distance != "recorded":
        yield "distance", distance
    for name in ("sampling", "raster", "trigger", "standstill", "filter"):
        yield name, stop.choices[name]
    if stop.defects:
        yield "defects", "; ".join(map(str, stop.defects))


def _grouped(channels: list[str]) -> Iterator[str]:
    """Yield channels, those of all wheelsets as one: `slide_1 .. 4`."""
    for name in channels:
        stem, _, number = name.rpartition("_")
        complete = all(f"{stem}_{n}" in channels for n in WHEELSETS)
        if not (name in CHANNEL_UNITS and complete):
            yield name
        elif number == str(WHEELSETS[0]):
            yield f"{name} .. {WHEELSETS[-1]}"

"""What a record lacks of each measure, what the measures of a recorded stop are fed with, its judgement."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest import report
from uictest.core.measures import (
    MEASURES,
    MeasureDefinition,
    RecordedData,
    Replay,
    close_contacts,
    samples_of,
)
from uictest.core.record import fields_of
from uictest.core.recording import BRAKE_COMMAND_TIME, TIME, TRACK_BRAKES_BESIDE, Recording
from uictest.core.units import KILOMETRE_PER_HOUR, STANDARD_GRAVITY
from uictest.judging import evaluation
from uictest.judging.evaluation import CaseResult, Coverage, MissingData, evaluate
from uictest.plans import scenario
from uictest.plans.scenario import (
    EXPANSION_KEYS,
    Case,
    Files,
    Parts,
    Roots,
    Scenario,
    apply_overrides,
    parse_overrides,
    resolve,
    with_default_parts,
)
from uictest.plans.scenario.yaml import SCENARIO_SCHEMA, Document, Map, parse, single_error
from uictest.recorded.field_data.agreement import record_verdicts
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, WHEELSETS
from uictest.recorded.field_data.defects import is_coarse
from uictest.recorded.field_data.recorded_stop import RecordedStop
from uictest.rig import highest_creep_forces, pass_samples

Array = NDArray[np.float64]

Channels = tuple[str, ...]

_NEEDS: Final = MappingProxyType(
    {name: measure.recorded for name, measure in MEASURES.items() if measure.recorded is not None}
)
"""Measure -> the channels that it needs."""


def _channels_per_value(measure: str, data: RecordedData) -> tuple[Channels, ...]:
    per_wheelset = tuple(tuple(name.format(n=n) for name in data.channels) for n in WHEELSETS)
    if MEASURES[measure].of_wheelsets:
        return per_wheelset
    return (tuple(dict.fromkeys(name for names in per_wheelset for name in names)),)


_CHANNELS_OF_VALUES: Final = MappingProxyType(
    {name: _channels_per_value(name, data) for name, data in _NEEDS.items()}
)
"""Measure -> for each of its values the channels that must be known."""

_NEVER: Final = {
    name: tuple(MissingData(f"not recorded: {', '.join(names)}", bounded=False) for names in values)
    for name, values in _CHANNELS_OF_VALUES.items()
    if _NEEDS[name].when == "never"
}
"""Measures whose data no record holds -> what their values lack."""

_LATE: Final = "the record begins after the brake command"


def coverage_of(stop: RecordedStop) -> Coverage:
    """Return the data that each measure lacks between the brake command and the end of a record."""
    missing = {
        measure: tuple(_missing_data(stop, measure, channels) for channels in values)
        for measure, values in _CHANNELS_OF_VALUES.items()
        if measure not in _NEVER
    }
    lacking = {measure: gaps for measure, gaps in missing.items() if any(gaps)}
    return Coverage(
        {**_NEVER, **lacking},
        f"{_LATE}: no initial speed" if stop.trigger.late else "",
        dict(_not_computed(stop)),
    )


def _not_computed(stop: RecordedStop) -> Iterator[tuple[str, str]]:
    """Yield the measures for which a record lacks a computed channel of all wheelsets, and that channel."""
    for measure in (name for name, data in _NEEDS.items() if data.computed):
        for pattern in _NEEDS[measure].channels:
            if not any(pattern.format(n=n) in stop.recording.channels for n in WHEELSETS):
                ends = dict.fromkeys(pattern.format(n=n) for n in (WHEELSETS[0], WHEELSETS[-1]))
                yield measure, " .. ".join(ends)


def _missing_data(stop: RecordedStop, measure: str, channels: Channels) -> MissingData | None:
    if unusable := list(_unusable_reasons(stop, measure, channels)):
        return MissingData("; ".join(unusable), bounded=False)
    if gaps := dict.fromkeys(_gap_reasons(stop, measure, channels)):
        return MissingData("; ".join(gaps), bounded=_NEEDS[measure].bounded)
    return None


def measures_of(channel: str) -> tuple[str, ...]:
    """Return the measures that need a channel; none need `distance`, which the speed gives, too."""
    if channel == "distance":
        return ()
    return tuple(
        measure
        for measure, values in _CHANNELS_OF_VALUES.items()
        if any(channel in value for value in values)
    )


def _unusable_reasons(stop: RecordedStop, measure: str, channels: Channels) -> Iterator[str]:
    """Yield the reasons for which a value cannot even be bounded; wheelsets that lack a channel share one."""
    recorded = stop.recording.channels
    if any(name not in recorded for name in channels):
        needed = dict.fromkeys(name for value in _CHANNELS_OF_VALUES[measure] for name in value)
        yield f"not recorded: {', '.join(name for name in needed if name not in recorded)}"
    for defect in stop.defects:
        if defect.makes_unusable and defect.channel in channels:
            yield str(defect)


def _gap_reasons(stop: RecordedStop, measure: str, channels: Channels) -> Iterator[str]:
    data = _NEEDS[measure]
    throughout = data.when == "throughout"
    if stop.trigger.late and data.from_command:
        yield _LATE
    for name in channels:
        yield from _unknown_reasons(stop, name, throughout=throughout)
        interval = stop.intervals.get(name, 0.0)
        if throughout and is_coarse(interval):
            yield f"samples are {interval:.6g} s apart"


def _unknown_reasons(stop: RecordedStop, name: str, *, throughout: bool) -> Iterator[str]:
    unknown = ~np.isfinite(stop.recording[name])
    time = stop.recording[TIME]
    if throughout and unknown.any():
        first, last = time[unknown][[0, -1]]
        yield f"{name} is not known from {first:.6g} to {last:.6g} s after the brake command"
    elif name == "distance" and (
        unknown[0] or (stop.standstill is not None and not np.isfinite(stop.standstill[1]))
    ):
        if unknown[0]:
            yield "distance is not known at the brake command"
        else:
            yield "the distance is not known: the speed it is integrated from has a gap"


REQUIRED_STATEMENTS: Final = ("rail.condition", "brake.position", "rig.wsp", "criteria")
"""Keys of a scenario that must be stated for a recording that has none."""


def stated_case(
    name: str, initial_speed: float, statements: Sequence[str], trusted: Sequence[Path] = ()
) -> Case:
    """Return the case that `key=value` statements make of a stop from `initial_speed` (m/s).

    References stay at or below the files stated, the working folder and the `trusted` folders.

    Raises ScenarioErrors where a statement is no key of a scenario, or not acceptable.
    """
    begin = {"schema": SCENARIO_SCHEMA, "name": name, "initial_speed": f"{initial_speed:.9g} m/s"}
    document = Document("what is stated about the stop", Path(), json.dumps(begin))
    tree = parse(document)
    assert isinstance(tree, Map)
    tree = apply_overrides(with_default_parts(tree), parse_overrides(statements, None))
    for section in EXPANSION_KEYS:
        if (entry := tree.entries.get(section)) is not None:
            raise single_error(entry.key, "a recording is one stop: several values make no sense", section)
    scenario, documents = resolve(tree, Parts(Files(Roots.of((), trusted))))
    inputs = {document.display: document.sha256 for document in documents if document.sha256}
    of_vehicle = any(text.partition("=")[0].strip().partition(".")[0] == "vehicle" for text in statements)
    return Case(name, scenario, Path(document.display), {}, inputs, vehicle_stated=of_vehicle)


_WHEELS: Final = 2.0
"""Of a wheelset: adhesion and wheel load are those of one."""


def _highest_forces(recording: Recording, judged_under: scenario.Scenario) -> Array:
    """Return the largest force of both contacts of each wheelset at every sample, N, shape (n, 4).

    Where the curve goes over to that of a clean rail, it is known only with the cleaned share.
    """
    rail = judged_under.rail
    friction, load = _wheelset_samples(recording, "friction"), _wheelset_samples(recording, "wheel_load")

    def highest(curve: scenario.CreepCurve | None) -> Array:
        wheels = zip(load.T, friction.T, strict=True)
        speed = recording["speed"]
        forces = [
            highest_creep_forces(rail.condition, speed, *load_friction, curve) for load_friction in wheels
        ]
        return _WHEELS * np.stack(forces, axis=1)

    cleaning, as_found = rail.cleaning_in_force, highest(None)
    if cleaning is None or cleaning.clean_curve is None:
        return as_found
    return as_found + _wheelset_samples(recording, "cleaned_share") * (
        highest(cleaning.clean_curve) - as_found
    )


def _train_mass(recording: Recording) -> float:
    """Return the mass of the train by the mean wheel loads, kg; NaN where one of them is not known."""
    load = _wheelset_samples(recording, "wheel_load")
    known = np.isfinite(load).any(axis=0).all()
    return _WHEELS * float(np.nanmean(load, axis=0).sum()) / STANDARD_GRAVITY if known else np.nan


def _wheelset_samples(recording: Recording, kind: str) -> Array:
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
    close_contacts(train, wheelsets, _train_mass(recording))
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
    recording = replace(stop.recording, metadata=dict(_recording_metadata(case, stop, observed)))
    return replace(result, criteria=criteria), recording


def _recording_metadata(
    case: scenario.Case, stop: RecordedStop, observed: Observed
) -> Iterator[tuple[str, str]]:
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
        dict(_condition_rows(case.scenario, stop)),
        {"file": case.path.as_posix(), **(dict(_origin_rows(stop)) if stop else {})},
    )


def _condition_rows(scenario: Scenario, stop: RecordedStop | None) -> Iterator[tuple[str, str]]:
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


def _origin_rows(stop: RecordedStop) -> Iterator[tuple[str, str]]:
    channels = list(stop.recording.channels)
    distance = stop.choices["distance"]
    if distance != "recorded":
        channels.remove("distance")
    yield "channels read", ", ".join(_channel_ranges(channels))
    if distance != "recorded":
        yield "distance", distance
    for name in ("sampling", "raster", "trigger", "standstill", "filter"):
        yield name, stop.choices[name]
    if stop.defects:
        yield "defects", "; ".join(map(str, stop.defects))


def _channel_ranges(channels: list[str]) -> Iterator[str]:
    """Yield channels, those of all wheelsets as one: `slide_1 .. 4`."""
    for name in channels:
        stem, _, number = name.rpartition("_")
        complete = all(f"{stem}_{n}" in channels for n in WHEELSETS)
        if not (name in CHANNEL_UNITS and complete):
            yield name
        elif number == str(WHEELSETS[0]):
            yield f"{name} .. {WHEELSETS[-1]}"

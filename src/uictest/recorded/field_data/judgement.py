"""A recorded stop judged by the code that judges simulated ones, and described."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from uictest import report
from uictest.core.recording import BRAKE_COMMAND_TIME, Recording
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult, error_result, evaluate
from uictest.plans import scenario
from uictest.plans.scenario import Case, Scenario
from uictest.recorded.field_data.channels import CHANNEL_UNITS, WHEELSETS
from uictest.recorded.field_data.observation import Observed, observe
from uictest.recorded.field_data.recorded_stop import RecordedStop
from uictest.recorded.field_data.time_axis import Defect


def judge_recording(case: scenario.Case, stop: RecordedStop) -> tuple[CaseResult, Recording]:
    """Return the result of a recorded stop under the conditions and criteria of a case, and its recording.

    The definition of every verdict states how the record was prepared and what is wrong with it. The
    recording carries the metadata that a simulated one has.
    """
    observed = observe(stop, case.scenario)
    result = evaluate(case, observed.measures, observed.wheelset_measures, coverage=observed.coverage)
    preparation = {**stop.choices, **_defects(stop.defects)}
    criteria = tuple(
        replace(verdict, definition={**verdict.definition, **preparation}) for verdict in result.criteria
    )
    recording = replace(stop.recording, metadata=dict(_metadata(case, stop, observed)))
    return replace(result, criteria=criteria), recording


def _metadata(case: scenario.Case, stop: RecordedStop, observed: Observed) -> Iterator[tuple[str, str]]:
    yield "case", case.id
    if not stop.trigger.late:
        yield BRAKE_COMMAND_TIME, "0 s"
    known = "initial_adhesion" not in observed.coverage.missing
    if known and math.isfinite(observed.measures.sliding_time):
        yield "sliding_time", f"{observed.measures.sliding_time:.6g}"


def unusable_result(case: scenario.Case, defects: tuple[Defect, ...]) -> CaseResult:
    """Return the result of a record that cannot be used at all: an error that names every defect."""
    return error_result(case, "; ".join(map(str, defects)))


def _defects(defects: tuple[Defect, ...]) -> dict[str, str]:
    return {"defects": "; ".join(map(str, defects))} if defects else {}


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
    yield "brake command", brake.command.text + _unless_stated("command" in brake.model_fields_set)
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

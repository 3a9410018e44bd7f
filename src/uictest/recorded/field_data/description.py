"""Description of a recorded stop: where its samples come from, and the conditions it was judged by."""

from __future__ import annotations

from collections.abc import Iterator

from uictest import report
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.plans.scenario import Case, Scenario
from uictest.recorded.field_data.channels import CHANNEL_UNITS, WHEELSETS
from uictest.recorded.field_data.recorded_stop import RecordedStop

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

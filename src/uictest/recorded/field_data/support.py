"""What a record lacks of each measure, and what its user must state."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from uictest.core.measures import MEASURES, RecordedData
from uictest.core.recording import TIME
from uictest.judging.evaluation import Coverage, MissingData
from uictest.plans.scenario import (
    EXPANSION_KEYS,
    Case,
    Files,
    Parts,
    Roots,
    apply_overrides,
    parse_overrides,
    resolve,
    with_default_parts,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    Document,
    Map,
    parse,
    single_error,
)
from uictest.recorded.field_data.channel_map import WHEELSETS
from uictest.recorded.field_data.recorded_stop import RecordedStop
from uictest.recorded.field_data.time_axis import is_coarse

Channels = tuple[str, ...]

_NEEDS: Final = MappingProxyType(
    {name: measure.recorded for name, measure in MEASURES.items() if measure.recorded is not None}
)
"""Measure -> the channels that it needs."""


def _values(measure: str, data: RecordedData) -> tuple[Channels, ...]:
    """Return for each value of a measure the channels that it needs."""
    per_wheelset = tuple(tuple(name.format(n=n) for name in data.channels) for n in WHEELSETS)
    if MEASURES[measure].of_wheelsets:
        return per_wheelset
    return (tuple(dict.fromkeys(name for names in per_wheelset for name in names)),)


_VALUES: Final = MappingProxyType({name: _values(name, data) for name, data in _NEEDS.items()})
"""Measure -> for each of its values the channels that must be known."""

_NEVER: Final = {
    name: tuple(MissingData(f"not recorded: {', '.join(names)}", bounded=False) for names in values)
    for name, values in _VALUES.items()
    if _NEEDS[name].when == "never"
}
"""Measures whose data no record holds -> what their values lack."""

_LATE: Final = "the record begins after the brake command"


def coverage_of(stop: RecordedStop) -> Coverage:
    """Return what a record lacks of each measure between brake command and its end."""
    missing = {
        measure: tuple(_missing(stop, measure, channels) for channels in values)
        for measure, values in _VALUES.items()
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


def _missing(stop: RecordedStop, measure: str, channels: Channels) -> MissingData | None:
    if unusable := list(_unusable(stop, measure, channels)):
        return MissingData("; ".join(unusable), bounded=False)
    if gaps := dict.fromkeys(_gaps(stop, measure, channels)):
        return MissingData("; ".join(gaps), bounded=_NEEDS[measure].bounded)
    return None


def measures_of(channel: str) -> tuple[str, ...]:
    """Return the measures that need a channel; none need `distance`, which the speed gives, too."""
    if channel == "distance":
        return ()
    return tuple(measure for measure, values in _VALUES.items() if any(channel in value for value in values))


def _unusable(stop: RecordedStop, measure: str, channels: Channels) -> Iterator[str]:
    """Yield why a value cannot even be bounded; all wheelsets that lack a channel are named together."""
    recorded = stop.recording.channels
    if any(name not in recorded for name in channels):
        needed = dict.fromkeys(name for value in _VALUES[measure] for name in value)
        yield f"not recorded: {', '.join(name for name in needed if name not in recorded)}"
    for defect in stop.defects:
        if defect.spoils and defect.channel in channels:
            yield str(defect)


def _gaps(stop: RecordedStop, measure: str, channels: Channels) -> Iterator[str]:
    data = _NEEDS[measure]
    throughout = data.when == "throughout"
    if stop.trigger.late and data.from_command:
        yield _LATE
    for name in channels:
        yield from _unknown(stop, name, throughout=throughout)
        interval = stop.intervals.get(name, 0.0)
        if throughout and is_coarse(interval):
            yield f"samples are {interval:.6g} s apart"


def _unknown(stop: RecordedStop, name: str, *, throughout: bool) -> Iterator[str]:
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
    inputs = {each.display: each.sha256 for each in documents if each.sha256}
    of_vehicle = any(each.partition("=")[0].strip().partition(".")[0] == "vehicle" for each in statements)
    return Case(name, scenario, Path(document.display), {}, inputs, vehicle_stated=of_vehicle)

"""Channels of a file under their canonical names and in SI units; commands from two magnets."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import FILL, HOLD, VENT
from uictest.core.recording import (
    LONGEST_RECORD,
    STATES,
    TIME,
    Contents,
    Group,
    Implausible,
    implausible_time,
    implausible_unit,
    state_kind,
)
from uictest.core.units import recorded_spellings, recorded_unit_size
from uictest.plans.scenario.yaml import quoted, suggestion
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, WHEELSETS, ChannelMap, ChannelSource

_GROUPED = re.compile(r"[-+]?\d{1,3}(?:([., '])\d{3}(?:\1\d{3})+(?:[.,]\d+)?|([., '])\d{3}[.,]\d+)")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+")
_DATE = re.compile(r"\d{1,4}[-./]\d\d?[-./]\d{1,4}\b")
Array = NDArray[np.float64]


class MapError(ValueError):
    """A channel map that does not fit a file; the message names the channel."""


@dataclass(frozen=True, slots=True, eq=False)
class RawChannel:
    """One channel as recorded: time in s, samples in SI, neither sorted nor filled.

    `source` is its name in the file.
    """

    name: str
    source: str
    time: Array
    samples: Array

    @property
    def is_state(self) -> bool:
        """Whether its samples are states, which hold until the next sample."""
        return state_kind(self.name) is not None


def select_channels(
    contents: Contents, channel_map: ChannelMap, longest: float | None = LONGEST_RECORD.value
) -> dict[str, RawChannel]:
    """Return the channels of a file that a map selects; a channel without a source in the file is omitted.

    Its times may span `longest`, s; None: these are a part of a file whose units are known, all numbers are
    taken as they are, and a text that is no state is NaN.

    Raises MapError where a name stands for several channels, a unit is unknown or not the channel's, a text
    is no state, or a channel has no time axis.
    """
    sources = channel_map.sources
    times: dict[int, Array] = {}
    selected: dict[str, RawChannel] = {}
    for name, source in sources.items():
        if name == TIME:
            continue
        place = _find(contents, name, source)
        if place is not None:
            group, original = place
            samples = _in_si(name, source, original, group, longest)
            if id(group) not in times:
                times[id(group)] = _time_of(group, sources.get(TIME), original, longest)
            selected[name] = RawChannel(name, original, times[id(group)], samples)
    if "speed" not in selected:
        raise MapError(_no_speed(contents, sources))
    return selected


def _no_speed(contents: Contents, sources: Mapping[str, ChannelSource]) -> str:
    names = [name for group in contents.groups for name in group.channels]
    looked_for = sources["speed"].source if "speed" in sources else ("speed",)
    hint = suggestion(looked_for[0], names) if len(names) <= 40 else ""
    return (
        f"no channel for 'speed' (train speed): looked for {', '.join(map(quoted, looked_for))}"
        f"{'; ' + hint if hint else ''}; 'uictest evaluate FILE --list' shows its channels"
    )


def _find(contents: Contents, name: str, source: ChannelSource) -> tuple[Group, str] | None:
    for alias in source.source:
        matches = list(_matches(contents, alias))
        if len(matches) > 1:
            groups = ", ".join(quoted(group.name) for group, _ in matches)
            raise MapError(f"{name}: {quoted(alias)} is in several groups ({groups}): write group/name")
        if matches:
            return matches[0]
    return None


def _matches(contents: Contents, alias: str) -> Iterator[tuple[Group, str]]:
    for group in contents.groups:
        for name in group.channels:
            if alias in (name, f"{group.name}/{name}"):
                yield group, name


def _time_of(group: Group, source: ChannelSource | None, beside: str, longest: float | None) -> Array:
    if group.time is not None:
        time = np.asarray(group.time, dtype=np.float64)
        implausible = None if longest is None else implausible_time(time, "s", {"s": 1.0}, longest)
        return _require_plausible(implausible, TIME, f"of {quoted(beside)}", time)
    for alias in source.source if source else ():
        if source and alias in group.channels:
            return _in_si(TIME, source, alias, group, longest)
    raise MapError(f"{quoted(beside)} has no time axis: map `time` to a channel of its group")


def _in_si(
    name: str,
    source: ChannelSource,
    original: str,
    group: Group,
    longest: float | None,
) -> Array:
    samples = group.channels[original]
    if samples.dtype.kind == "U":
        samples = _numbered(name, source, original, group, strict=longest is not None)
        if state_kind(name) is not None:
            return samples
    unit = source.unit or group.units.get(original, "")
    size = _size(name, unit, original)
    # What overflows becomes infinite, which is reported as a sample that is no number.
    with np.errstate(over="ignore", invalid="ignore"):
        converted: Array = source.sign * (source.scale * samples + source.offset) * size
    if longest is None:
        return converted
    return _require_plausible(_implausible(name, converted, unit, longest), name, quoted(original), converted)


def _implausible(name: str, converted: Array, unit: str, longest: float) -> Implausible | None:
    si = CHANNEL_UNITS[name]
    sizes = {**recorded_spellings(si), unit: recorded_unit_size(unit, si) or 1.0}
    if name == TIME:
        return implausible_time(converted, unit, sizes, longest)
    return implausible_unit(converted, si, unit, sizes)


def _require_plausible(implausible: Implausible | None, name: str, original: str, samples: Array) -> Array:
    if implausible is not None:
        unit = implausible.likely_unit
        question = f"; is it in {unit}? write `unit: {unit}` in a channel map" if unit else ""
        raise MapError(f"{name}: {original} {implausible.reason}{question}")
    return samples


def _size(name: str, unit: str, original: str) -> float:
    si = CHANNEL_UNITS[name]
    if not unit and si == "1":
        return 1.0
    if not unit:
        raise MapError(
            f"{name}: the file does not state the unit of {quoted(original)}:"
            " write `unit:` in the channel map"
        )
    size = recorded_unit_size(unit, si)
    if size is None:
        raise MapError(
            f"{name}: {quoted(original)} has the unit {quoted(unit)};"
            f" accepted: {', '.join(recorded_spellings(si))}; write `unit:` in the channel map"
        )
    return size


def _numbered(name: str, source: ChannelSource, original: str, group: Group, *, strict: bool) -> Array:
    samples = group.channels[original]
    kind = state_kind(name)
    known: dict[str, int] = {**(STATES[kind] if kind else {}), **source.states}
    numbers = {str(text): _number(str(text), known) for text in np.unique(samples)}
    strange = [text for text, number in numbers.items() if number is None]
    if strange and strict:
        listed = ", ".join(map(quoted, strange[:3]))
        place = f", the first in {group.first_texts[original]}" if original in group.first_texts else ""
        raise MapError(
            f"{name}: {quoted(original)} contains texts that are not numbers: {listed}{place};"
            f" {_remedy(strange[0])}"
        )
    numbers |= dict.fromkeys(strange, math.nan)
    values: Any = np.vectorize(lambda text: numbers[str(text)], otypes=[np.float64])(samples)
    return np.asarray(values, dtype=np.float64)


def _remedy(text: str) -> str:
    if grouped := _GROUPED.fullmatch(text.strip()):
        separator = grouped[1] or grouped[2]
        return (
            f"for thousands separators, write csv: {{thousands: {json.dumps(separator)}}} in the channel map"
        )
    if _DECIMAL_COMMA.fullmatch(text.strip()):
        return 'for decimal commas, write csv: {decimal: ","} in the channel map, and numbers without quotes'
    if _DATE.match(text.strip()):
        return "write dates as 2026-05-31T12:00:00.000"
    return "name them in `states` of the channel map"


def _number(text: str, known: Mapping[str, int]) -> float | None:
    if text in known:
        return float(known[text])
    if not text.strip() or text.strip().lower() == "nan":
        return float("nan")
    try:
        return float(text)
    except ValueError:
        return None


_ON = 0.5


def with_valve_commands(channels: Mapping[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels with the valve command of every wheelset whose two magnets have common times."""
    return {**dict(_commands(channels)), **channels}


def _commands(channels: Mapping[str, RawChannel]) -> Iterator[tuple[str, RawChannel]]:
    for n in WHEELSETS:
        hold, vent = (channels.get(f"{magnet}_{n}") for magnet in ("hold_magnet", "vent_magnet"))
        if hold is not None and vent is not None and np.array_equal(hold.time, vent.time):
            name, sources = f"valve_command_{n}", f"{hold.source}, {vent.source}"
            yield name, RawChannel(name, sources, hold.time, _command(hold.samples, vent.samples))


def _command(hold: Array, vent: Array) -> Array:
    """Return the commands; a valve that vents does so whatever its other magnet shows."""
    command = np.where(vent > _ON, VENT, np.where(hold > _ON, HOLD, FILL))
    return np.where(np.isfinite(hold) & np.isfinite(vent), command, np.nan)

"""The channels of a file, and a proposed channel map: by name, or by unit where only one channel fits."""

from __future__ import annotations

import itertools
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from uictest.core.recording import TIME, Contents, Group, Samples, implausible_time
from uictest.core.recording.formats import INTERVAL, Cells, Dialect, are_dates, written_as
from uictest.core.units import ROTATIONAL_SPEEDS, recorded_spellings, recorded_unit_size
from uictest.recorded.field_data.channel_map import (
    CHANNEL_UNITS,
    DEFAULT,
    NUMBER,
    WHEELSETS,
    load_map,
    of_wheelsets,
)
from uictest.recorded.field_data.judgement import measures_of
from uictest.recorded.field_data.raw_channels import holds_dates, is_empty

_COMMON = "common-names"
_ESSENTIAL = ("speed", *of_wheelsets("wheel_speed"))
_MOST_LISTED = 20
_LIKELY_UNITS: Final = MappingProxyType(
    {
        "m/s": ((45.0, "m/s"), (math.inf, "km/h")),
        "Pa": ((16.0, "bar"), (1200.0, "kPa"), (12_000.0, "mbar"), (math.inf, "Pa")),
        "N": ((200.0, "kN"), (math.inf, "N")),
        "N m": ((100.0, "kN m"), (math.inf, "N m")),
    }
)
"""SI unit -> up to which largest magnitude samples without a unit are likely in which; chosen."""
_BY_UNIT: Final = "by its unit alone"
_ELEMENT: Final = re.compile(r"(.*)[\[(](\d+)[\])]")
"""Name of an element of an array."""
_SAMPLED: Final = 200
"""Texts by which a way of writing dates is proposed; chosen."""
_DATE_COLUMNS: Final = 6
"""Columns of texts among which a date and a clock are looked for; chosen."""


class _Source(NamedTuple):
    """Where a channel comes from, as a map writes it, and why it is a guess; empty where it is none."""

    text: str
    guess: str = ""

    def __str__(self) -> str:
        return f"{self.text}  # guessed: {self.guess}" if self.guess else self.text


def channel_rows(contents: Contents) -> Iterator[tuple[str, ...]]:
    """Yield a row per channel (name, unit, number of samples, range), and one per skipped item."""
    for group in contents.groups:
        for name, samples in group.channels.items():
            full = f"{group.name}/{name}" if group.name else name
            yield full, group.units.get(name, ""), str(len(samples)), _range_text(samples)
    for name, reason in contents.skipped.items():
        yield name, "", "-", f"skipped: {reason}"


def proposed_map(contents: Contents, name: str = "proposed") -> str:
    """Return a channel map as YAML: channels with common names, then those that their unit identifies.

    What is not certain is marked as guessed.
    """
    assigned = _assigned_channels(contents)
    time, written = _time_source(contents, assigned)
    lines = ["schema: uictest/channel-map/1", f"name: {_map_name(name)}", *_csv_section(contents, written)]
    lines.append(f"time: {time}" if time else "channels:")
    lines += ["channels:"] if time else []
    named = [canonical for canonical in CHANNEL_UNITS if canonical in assigned and canonical != TIME]
    by_name = dict(_identified_by_name(contents))
    for canonical in named:
        guess = "" if canonical in by_name else _BY_UNIT
        lines.append(f"  {canonical}: {_source_text(contents, canonical, assigned[canonical], guess)}")
    if not named:
        lines[-1] = "channels: {}  # no known name or unit"
    return "\n".join(lines)


def _map_name(name: str) -> str:
    return re.sub(r"[^a-z0-9._-]+", "-", name.lower()).strip("-._")[:60] or "proposed"


def _csv_section(contents: Contents, written: Sequence[str]) -> Iterator[str]:
    """Yield the section of a text table: what differs from the default, and how its dates are written."""
    settings = {} if contents.dialect is None else contents.dialect.settings(Dialect())
    settings = {name: getattr(contents.dialect, name) for name in contents.guesses} | settings
    if not settings and not written:
        return
    yield "csv:"
    for name, value in settings.items():
        yield f"  {name}: {_Source(_quoted(value), contents.guesses.get(name, ''))}"
    if written:
        yield f"  dates: {_Source(_quoted(written[0]), ''.join(f'or {_quoted(way)}' for way in written[1:]))}"


def _time_source(contents: Contents, assigned: Mapping[str, str]) -> tuple[_Source | None, Sequence[str]]:
    """Return the source of the time, and the likely formats of its dates; none: ISO 8601."""
    group = _group_of(assigned.get("speed", assigned.get(TIME, "")), contents) or contents.groups[0]
    if group.time is not None:
        return None, ()
    name = assigned.get(TIME, "")
    if name and group.channels.get(name, np.zeros(0)).dtype.kind != "U":
        by_unit = "" if TIME in dict(_identified_by_name(contents)) else _BY_UNIT
        return _source_text(contents, TIME, name, by_unit), ()
    if columns := _time_columns(contents, assigned):
        texts = _joined_texts(group, columns)
        listed = _quoted(columns[0]) if len(columns) == 1 else f"{{source: {json.dumps(columns)}}}"
        ways = () if are_dates(np.array(texts)) else tuple(itertools.islice(written_as(texts), 2))
        return _Source(listed), ways
    interval = contents.metadata.get(INTERVAL, "")
    if Cells().is_number(interval):
        return _Source(f"{{interval: {interval} s}}", f"{INTERVAL} of the file"), ()
    return None, ()


def _time_columns(contents: Contents, assigned: Mapping[str, str]) -> list[str]:
    """Return the columns of dates and clocks in the group of the train speed that make its time."""
    group = _group_of(assigned.get("speed", ""), contents) or contents.groups[0]
    numbers = group.channels.get(assigned.get(TIME, ""))
    if group.time is not None or (numbers is not None and numbers.dtype.kind != "U"):
        return []
    candidates = _date_columns(group)
    return next(
        (columns for columns in candidates if next(written_as(_joined_texts(group, columns)), "")), []
    )


def _joined_texts(group: Group, columns: Sequence[str]) -> list[str]:
    sampled = (group.channels[name][:_SAMPLED].tolist() for name in columns)
    return [" ".join(texts) for texts in zip(*sampled, strict=True)]


def _date_columns(group: Group) -> Iterator[list[str]]:
    """Yield columns of texts that may be a date and a clock, then those that may be either."""
    texts = [name for name in group.channels if holds_dates(group, name)][:_DATE_COLUMNS]
    yield from ([name] for name in texts if are_dates(group.channels[name]))
    yield from map(list, itertools.permutations(texts, 2))
    yield from ([name] for name in texts)


def remarks(contents: Contents) -> Iterator[str]:
    """Yield measures for which the proposed map lacks channels, and channels that it does not use."""
    assigned = _assigned_channels(contents)
    missing: dict[tuple[str, ...], list[str]] = {}
    for canonical in CHANNEL_UNITS:
        if canonical not in assigned and (measures := measures_of(canonical)):
            missing.setdefault(measures, []).append(canonical)
    for measures, channels in missing.items():
        yield f"not assigned: {', '.join(_joined_wheelsets(channels))}; needed for {', '.join(measures)}"
    if (
        TIME not in assigned
        and _time_source(contents, assigned)[0] is None
        and contents.groups[0].time is None
    ):
        yield "no time: write time: {source: NAME}, or the sampling interval as in time: {interval: 20 ms}"
    used = {*assigned.values(), *_time_columns(contents, assigned)}
    unused = [name for group in contents.groups for name in group.channels if name not in used]
    if unused:
        more = f" and {len(unused) - _MOST_LISTED} more" if len(unused) > _MOST_LISTED else ""
        yield f"not used: {', '.join(map(_quoted, unused[:_MOST_LISTED]))}{more}"


def _joined_wheelsets(channels: Sequence[str]) -> list[str]:
    """Return channels with one name for those of all wheelsets."""
    kinds = dict.fromkeys(name[:-2] for name in channels if set(of_wheelsets(name[:-2])) <= set(channels))
    single = [name for name in channels if name[:-2] not in kinds]
    return [*(f"{kind}_{NUMBER}" for kind in kinds), *single]


def lacks_speeds(contents: Contents) -> bool:
    """Return whether a proposed map leaves the speed of the train or of a wheelset unassigned."""
    assigned = _assigned_channels(contents)
    return any(name not in assigned for name in _ESSENTIAL)


def fitting_preset(contents: Contents) -> str | None:
    """Return the preset that reads all channels of the proposed map unchanged; None if there is none."""
    assigned = _assigned_channels(contents)
    return next(
        (preset for preset in (DEFAULT, _COMMON) if assigned and _preset_fits(preset, contents, assigned)),
        None,
    )


def _preset_fits(preset: str, contents: Contents, assigned: Mapping[str, str]) -> bool:
    sources = load_map(preset)[0].sources
    return all(
        canonical in sources
        and next((alias for alias in sources[canonical].source if _group_of(alias, contents)), None) == name
        and _has_unit(_group_of(name, contents), canonical, name)
        for canonical, name in assigned.items()
    )


def _assigned_channels(contents: Contents) -> dict[str, str]:
    """Return the channels that names or units identify, each with its name in the file."""
    assigned = dict(_identified_by_name(contents))
    return assigned | {
        name: source
        for name, source in _identified_by_unit(contents, set(assigned.values()))
        if name not in assigned
    }


def _identified_by_name(contents: Contents) -> Iterator[tuple[str, str]]:
    names: dict[str, list[tuple[Group, str]]] = {}
    for group in contents.groups:
        for name in (name for name, samples in group.channels.items() if not is_empty(samples)):
            names.setdefault(_normalized_name(_counted_from_one(name, group)), []).append((group, name))
    for canonical, source in load_map(_COMMON)[0].sources.items():
        alike = (channel for alias in source.source for channel in names.get(_normalized_name(alias), ()))
        fitting = (
            name
            for group, name in alike
            if not (unit := group.units.get(name))
            or _has_unit(group, canonical, name)
            or (CHANNEL_UNITS[canonical] == "m/s" and unit in ROTATIONAL_SPEEDS)
        )
        if (match := next(fitting, None)) is not None:
            yield canonical, match


def _counted_from_one(name: str, group: Group) -> str:
    """Return the name of an element of an array, `v[0]`, with the number that its wheelset would have."""
    match = _ELEMENT.fullmatch(name)
    if match is None:
        return name
    elements = map(_ELEMENT.fullmatch, group.channels)
    numbers = [int(element[2]) for element in elements if element and element[1] == match[1]]
    # Five are the train and its wheelsets, in whatever order.
    return f"{match[1]}{int(match[2]) + (0 in numbers)}" if len(numbers) <= len(WHEELSETS) else name


def _identified_by_unit(contents: Contents, used: set[str]) -> Iterator[tuple[str, str]]:
    """Yield time, distance and train speed where exactly one unused channel has a unit of that kind."""
    for canonical in ("time", "distance", "speed"):
        fitting = [
            name
            for group in contents.groups
            for name, unit in group.units.items()
            if name not in used and recorded_unit_size(unit, CHANNEL_UNITS[canonical]) is not None
        ]
        if len(fitting) == 1:
            yield canonical, fitting[0]


def _source_text(contents: Contents, canonical: str, name: str, guess: str = "") -> _Source:
    group, si = _group_of(name, contents), CHANNEL_UNITS[canonical]
    assert group is not None
    several = sum(name in any_group.channels for any_group in contents.groups) > 1
    label = group.name or f"group {contents.groups.index(group) + 1}"
    source = _quoted(f"{label}/{name}" if several else name)
    guesses = [guess, *_uncertainties(canonical, name, group.channels[name])]
    if group.units.get(name, "") in ROTATIONAL_SPEEDS:
        source = f"{{source: {source}, wheel_radius: 0.46 m}}"
        guesses.append("the radius: state that of the wheel")
    elif not _has_unit(group, canonical, name):
        source = f"{{source: {source}, unit: {_likely_unit(si, group.channels[name])}}}"
        guesses.append("the file does not state the unit: check it")
    return _Source(source, "; ".join(filter(None, guesses)))


def _uncertainties(canonical: str, name: str, samples: Samples) -> Iterator[str]:
    """Yield the uncertainties of a channel that has the right name."""
    if _ELEMENT.fullmatch(name):
        yield "elements in the order of the wheelsets"
    if canonical.startswith("valve_command") and samples.dtype.kind != "U" and not np.any(samples > 1.0):
        yield "0 and 1 alone: fill and hold, unless it is the signal of a magnet"


def _likely_unit(si: str, samples: Samples) -> str:
    if samples.dtype.kind == "U" or not np.isfinite(samples).any():
        return si
    if si == "s":
        implausible = implausible_time(samples, "s", recorded_spellings("s"))
        return implausible.likely_unit or "s" if implausible else "s"
    largest = float(np.nanmax(np.abs(samples)))
    return next((unit for limit, unit in _LIKELY_UNITS.get(si, ()) if largest <= limit), si)


def _group_of(name: str, contents: Contents) -> Group | None:
    return next((group for group in contents.groups if name in group.channels), None)


def _has_unit(group: Group | None, canonical: str, name: str) -> bool:
    unit = "" if group is None else group.units.get(name, "")
    return CHANNEL_UNITS[canonical] == "1" or recorded_unit_size(unit, CHANNEL_UNITS[canonical]) is not None


def _range_text(samples: Samples) -> str:
    if samples.dtype.kind == "U":
        return "texts: " + ", ".join(str(text) for text in np.unique(samples) if text)
    finite = samples[np.isfinite(samples)]
    if not len(finite):
        return "no number"
    missing = f", {len(samples) - len(finite)} missing" if len(finite) < len(samples) else ""
    return f"{finite.min():.6g} .. {finite.max():.6g}{missing}"


def _quoted(value: object) -> str:
    # JSON's quoting is YAML's, too.
    return json.dumps(value, ensure_ascii=False)


def _normalized_name(name: str) -> str:
    """Return a name without signs and case; of a single letter the case counts: T is not time."""
    return name if len(name) == 1 else re.sub(r"[\s_\-.]", "", name).casefold()

"""The channels of a file, and a proposed channel map: by name, or by unit where only one channel fits."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping

import numpy as np

from uictest.core.recording import Contents, Group, Samples
from uictest.core.recording.formats import Dialect
from uictest.core.units import recorded_unit_size
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, DEFAULT, load_map, of_wheelsets
from uictest.recorded.field_data.support import measures_of

_COMMON = "common-names"
_ESSENTIAL = ("speed", *of_wheelsets("wheel_speed"))
_MOST_LISTED = 20


def channel_rows(contents: Contents) -> Iterator[tuple[str, ...]]:
    """Yield a row per channel (name, unit, number of samples, range), and one per skipped item."""
    for group in contents.groups:
        for name, samples in group.channels.items():
            full = f"{group.name}/{name}" if group.name else name
            yield full, group.units.get(name, ""), str(len(samples)), _span(samples)
    for name, reason in contents.skipped.items():
        yield name, "", "-", f"skipped: {reason}"


def proposed_map(contents: Contents, dialect: Dialect | None = None) -> str:
    """Return a channel map as YAML: channels with common names, then those that their unit identifies.

    `dialect` is the one with which a text file was read.
    """
    assigned = _assigned(contents)
    lines = ["schema: uictest/channel-map/1", "name: proposed", "channels:"]
    order = ("time", *(name for name in CHANNEL_UNITS if name != "time"))
    lines += [f"  {name}: {_entry(contents, name, assigned[name])}" for name in order if name in assigned]
    if len(lines) == 3:
        lines[-1] = "channels: {}  # no known name or unit"
    if dialect not in (None, Dialect()):
        lines.append(Dialect().changes_to(dialect))
    return "\n".join(lines)


def remarks(contents: Contents) -> Iterator[str]:
    """Yield measures for which the proposed map lacks channels, and channels that it does not use."""
    assigned = _assigned(contents)
    missing: dict[tuple[str, ...], list[str]] = {}
    for canonical in CHANNEL_UNITS:
        if canonical not in assigned and (measures := measures_of(canonical)):
            missing.setdefault(measures, []).append(canonical)
    for measures, channels in missing.items():
        yield f"not assigned: {', '.join(channels)}; needed for {', '.join(measures)}"
    used = set(assigned.values())
    unused = [name for group in contents.groups for name in group.channels if name not in used]
    if unused:
        more = f" and {len(unused) - _MOST_LISTED} more" if len(unused) > _MOST_LISTED else ""
        yield f"not used: {', '.join(map(_quoted, unused[:_MOST_LISTED]))}{more}"


def lacks_speeds(contents: Contents) -> bool:
    """Return whether a proposed map leaves the speed of the train or of a wheelset unassigned."""
    assigned = _assigned(contents)
    return any(name not in assigned for name in _ESSENTIAL)


def fitting_preset(contents: Contents) -> str | None:
    """Return the preset that reads all channels of the proposed map unchanged; None if there is none."""
    assigned = _assigned(contents)
    return next(
        (preset for preset in (DEFAULT, _COMMON) if assigned and _fits(preset, contents, assigned)), None
    )


def _fits(preset: str, contents: Contents, assigned: Mapping[str, str]) -> bool:
    sources = load_map(preset)[0].sources
    return all(
        canonical in sources
        and next((each for each in sources[canonical].source if _group_of(each, contents)), None) == name
        and _has_unit(_group_of(name, contents), canonical, name)
        for canonical, name in assigned.items()
    )


def _assigned(contents: Contents) -> dict[str, str]:
    """Return the channels that names or units identify, each with its name in the file."""
    assigned = dict(_by_name(contents))
    return assigned | {
        name: source for name, source in _by_unit(contents, set(assigned.values())) if name not in assigned
    }


def _by_name(contents: Contents) -> Iterator[tuple[str, str]]:
    names: dict[str, list[tuple[Group, str]]] = {}
    for group in contents.groups:
        for name in group.channels:
            names.setdefault(_plain(name), []).append((group, name))
    for canonical, source in load_map(_COMMON)[0].sources.items():
        alike = (each for alias in source.source for each in names.get(_plain(alias), ()))
        fitting = (
            name for group, name in alike if not group.units.get(name) or _has_unit(group, canonical, name)
        )
        if (match := next(fitting, None)) is not None:
            yield canonical, match


def _by_unit(contents: Contents, used: set[str]) -> Iterator[tuple[str, str]]:
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


def _entry(contents: Contents, canonical: str, name: str) -> str:
    if _has_unit(_group_of(name, contents), canonical, name):
        return _quoted(name)
    source = f"{{source: {_quoted(name)}, unit: {CHANNEL_UNITS[canonical]}}}"
    return f"{source}  # the file does not state the unit: check it"


def _group_of(name: str, contents: Contents) -> Group | None:
    return next((group for group in contents.groups if name in group.channels), None)


def _has_unit(group: Group | None, canonical: str, name: str) -> bool:
    unit = "" if group is None else group.units.get(name, "")
    return CHANNEL_UNITS[canonical] == "1" or recorded_unit_size(unit, CHANNEL_UNITS[canonical]) is not None


def _span(samples: Samples) -> str:
    if samples.dtype.kind == "U":
        return "texts: " + ", ".join(str(text) for text in np.unique(samples)[:4])
    finite = samples[np.isfinite(samples)]
    if not len(finite):
        return "no number"
    missing = f", {len(samples) - len(finite)} missing" if len(finite) < len(samples) else ""
    return f"{finite.min():.6g} .. {finite.max():.6g}{missing}"


def _quoted(text: str) -> str:
    # JSON's quoting is YAML's, too.
    return json.dumps(text)


def _plain(name: str) -> str:
    return re.sub(r"[\s_\-.]", "", name).casefold()

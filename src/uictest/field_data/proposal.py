"""What a file holds, and a channel map to start from: by name, and by unit where one channel alone fits."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping

import numpy as np

from uictest.field_data.channel_map import DEFAULT, load_map
from uictest.field_data.channels import UNITS, of_wheelsets
from uictest.field_data.support import measures_of
from uictest.recording import Contents, Group, Samples
from uictest.recording.formats import Dialect
from uictest.units import recorded_unit_size

_COMMON = "common-names"
_ESSENTIAL = ("speed", *of_wheelsets("wheel_speed"))
_MOST_LISTED = 20


def listing(contents: Contents) -> Iterator[tuple[str, ...]]:
    """Yield a row per channel: name, unit, samples, range; and one per thing that is no channel."""
    for group in contents.groups:
        for name, samples in group.channels.items():
            full = f"{group.name}/{name}" if group.name else name
            yield full, group.units.get(name, ""), str(len(samples)), _span(samples)
    for name, reason in contents.skipped.items():
        yield name, "", "-", f"left out: {reason}"


def proposed_map(contents: Contents, dialect: Dialect | None = None) -> str:
    """Return a channel map as YAML: what common names find, then what a unit alone tells.

    `dialect` is the one by which a text file was read.
    """
    found = _found(contents)
    lines = ["schema: uictest/channel-map/1", "name: proposed", "channels:"]
    order = ("time", *(name for name in UNITS if name != "time"))
    lines += [f"  {name}: {_entry(contents, name, found[name])}" for name in order if name in found]
    if len(lines) == 3:
        lines[-1] = "channels: {}  # no name or unit gives a hint"
    if dialect not in (None, Dialect()):
        lines.append(Dialect().changes_to(dialect))
    return "\n".join(lines)


def remarks(contents: Contents) -> Iterator[str]:
    """Yield what a proposed map leaves open: measures that lack channels, and channels without use."""
    found = _found(contents)
    missing: dict[tuple[str, ...], list[str]] = {}
    for canonical in UNITS:
        if canonical not in found and (measures := measures_of(canonical)):
            missing.setdefault(measures, []).append(canonical)
    for measures, channels in missing.items():
        yield f"not assigned: {', '.join(channels)}; needed for {', '.join(measures)}"
    used = set(found.values())
    unused = [name for group in contents.groups for name in group.channels if name not in used]
    if unused:
        more = f" and {len(unused) - _MOST_LISTED} more" if len(unused) > _MOST_LISTED else ""
        yield f"not used: {', '.join(map(_quoted, unused[:_MOST_LISTED]))}{more}"


def lacks_essentials(contents: Contents) -> bool:
    """Return whether a proposed map leaves the speed of the train or of a wheelset unassigned."""
    found = _found(contents)
    return any(name not in found for name in _ESSENTIAL)


def fitting_preset(contents: Contents) -> str | None:
    """Return the preset that reads all that a proposed map would, as it is; None where there is none."""
    found = _found(contents)
    return next((preset for preset in (DEFAULT, _COMMON) if found and _fits(preset, contents, found)), None)


def _fits(preset: str, contents: Contents, found: Mapping[str, str]) -> bool:
    sources = load_map(preset)[0].sources()
    return all(
        canonical in sources
        and next((each for each in sources[canonical].source if _group_of(each, contents)), None) == name
        and _has_unit(_group_of(name, contents), canonical, name)
        for canonical, name in found.items()
    )


def _found(contents: Contents) -> dict[str, str]:
    """Return the channels that can be told, each with its name in the file."""
    found = dict(_by_name(contents))
    return found | {
        name: source for name, source in _by_unit(contents, set(found.values())) if name not in found
    }


def _by_name(contents: Contents) -> Iterator[tuple[str, str]]:
    names: dict[str, list[tuple[Group, str]]] = {}
    for group in contents.groups:
        for name in group.channels:
            names.setdefault(_plain(name), []).append((group, name))
    for canonical, source in load_map(_COMMON)[0].sources().items():
        alike = (each for alias in source.source for each in names.get(_plain(alias), ()))
        fitting = (
            name for group, name in alike if not group.units.get(name) or _has_unit(group, canonical, name)
        )
        if (match := next(fitting, None)) is not None:
            yield canonical, match


def _by_unit(contents: Contents, taken: set[str]) -> Iterator[tuple[str, str]]:
    """Propose the one channel left whose unit only one of time, distance and train speed can have."""
    for canonical in ("time", "distance", "speed"):
        fitting = [
            name
            for group in contents.groups
            for name, unit in group.units.items()
            if name not in taken and recorded_unit_size(unit, UNITS[canonical]) is not None
        ]
        if len(fitting) == 1:
            yield canonical, fitting[0]


def _entry(contents: Contents, canonical: str, name: str) -> str:
    if _has_unit(_group_of(name, contents), canonical, name):
        return _quoted(name)
    return (
        f"{{source: {_quoted(name)}, unit: {UNITS[canonical]}}}  # the file does not say the unit: check it"
    )


def _group_of(name: str, contents: Contents) -> Group | None:
    return next((group for group in contents.groups if name in group.channels), None)


def _has_unit(group: Group | None, canonical: str, name: str) -> bool:
    unit = "" if group is None else group.units.get(name, "")
    return UNITS[canonical] == "1" or recorded_unit_size(unit, UNITS[canonical]) is not None


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

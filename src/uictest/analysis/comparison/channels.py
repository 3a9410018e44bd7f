"""Channels of two recordings: in the units of the page, and which of them are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase

from uictest.core import recording
from uictest.core.units import CELSIUS_ZERO, SIZES
from uictest.plans.scenario.yaml import nearest
from uictest.report import shown_unit


def in_shown_units(record: recording.Recording) -> recording.Recording:
    """Return a recording in the units of the page: km/h, bar, kN, degC, slides in %."""
    units = {name: shown_unit(name, unit) for name, unit in record.units.items()}
    channels = {
        name: samples if units[name] == record.units[name] else _in_unit(samples, units[name])
        for name, samples in record.channels.items()
    }
    return recording.Recording(channels, units, record.metadata)


def _in_unit(samples: recording.Samples, unit: str) -> recording.Samples:
    return samples - CELSIUS_ZERO if unit == "degC" else samples / SIZES[unit]


def common_channels(first: Mapping[str, str], second: Mapping[str, str]) -> list[str]:
    """Return the channels that both recordings have in the same unit, time left out; from their units."""
    return [name for name, unit in first.items() if name != "time" and second.get(name) == unit]


def only_in(first: Mapping[str, str], second: Mapping[str, str]) -> list[str]:
    """Return the channels that only the first recording has; from the units of both."""
    return [name for name in first if name not in second]


def select_channels(patterns: Sequence[str], channels: Iterable[str]) -> list[str]:
    """Return the channels that match a pattern, in the order of the patterns; `*` stands for any text.

    Raises ValueError with the nearest name and all names where a pattern matches none.
    """
    names = list(dict.fromkeys(channels))
    selected: dict[str, None] = {}
    for pattern in patterns:
        matching = [name for name in names if fnmatchcase(name, pattern)]
        if not matching:
            guess = nearest(pattern, names)
            hint = f"did you mean {guess!r}? " if guess else ""
            accepted = ", ".join(names) or "none"
            raise ValueError(f"no channel {pattern!r} on both sides; {hint}both have: {accepted}")
        selected |= dict.fromkeys(matching)
    return list(selected)

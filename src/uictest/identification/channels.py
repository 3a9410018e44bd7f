"""Channels of a recording in SI units, by name or through a channel map."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.identification.suitability import UnsuitableRecordError
from uictest.recording import ORIGIN

Samples = NDArray[np.float64]
TIME = "time"
_UNKNOWN_ORIGIN = "recorded, origin not stated"
_LONGEST_ORIGIN = 200


@dataclass(frozen=True, slots=True)
class Record:
    """What is read of a recording.

    Attributes:
        channels: role -> samples in SI units, and the time in s.
        origin: what was recorded, as the file states it.
    """

    channels: dict[str, Samples]
    origin: str


def read_record(path: Path, wanted: Mapping[str, str]) -> Record:
    """Read the channels that ``wanted`` maps from role to name, in SI units, and the time.

    A role that begins with ``command`` is a pure number; ``force`` is a force; every other role but ``time``
    is a pressure. Time is the channel ``time`` unless ``wanted`` maps the role to another.

    Raises:
        UnsuitableRecordError: the file is no recording, a channel is not there or its unit is unknown.
        OSError: the file cannot be opened.
    """
    from uictest.recording.formats import MissingExtraError, UnreadableError, read_contents

    try:
        contents = read_contents(path)
    except (UnreadableError, MissingExtraError) as error:
        raise UnsuitableRecordError(f"{path}: {error}") from error
    named = {TIME: TIME, **wanted}
    for group in contents.groups:
        if all(name in group.channels for name in named.values()):
            channels = {
                role: _in_si(path, role, name, group.channels[name], group.units.get(name, ""))
                for role, name in named.items()
            }
            return Record(channels, _origin(contents.metadata))
    there = sorted({name for group in contents.groups for name in group.channels})
    missing = [name for name in named.values() if name not in there]
    raise UnsuitableRecordError(
        f"{path}: no channel {', '.join(map(repr, missing)) or 'group with all channels'};"
        f" there are {', '.join(there)}"
    )


def _origin(facts: Mapping[str, str]) -> str:
    return " ".join(facts.get(ORIGIN, "").split())[:_LONGEST_ORIGIN] or _UNKNOWN_ORIGIN


def _in_si(path: Path, role: str, name: str, samples: NDArray[np.generic], unit: str) -> Samples:
    if samples.dtype.kind not in "biuf":
        raise UnsuitableRecordError(f"{path}: channel {name!r} holds texts where numbers are needed")
    numbers = np.asarray(samples, dtype=np.float64)
    if role.startswith("command"):
        return numbers
    kind = role if role in ("time", "force") else "pressure"
    factor = _factor(path, name, unit, kind)
    return numbers if factor == 1 else numbers * float(factor)


def _factor(path: Path, name: str, unit: str, kind: str) -> Fraction:
    from uictest.scenario.units import KINDS

    known = KINDS[kind].units
    if unit not in known:
        raise UnsuitableRecordError(
            f"{path}: channel {name!r} has the unit {unit or 'none'!r}; accepted: {', '.join(known)}"
        )
    return known[unit].factor


def samples_digest(channels: Mapping[str, Samples]) -> str:
    """SHA-256 of the samples in SI units, in order of role: the same in every file format."""
    total = hashlib.sha256()
    for role in sorted(channels):
        total.update(role.encode())
        total.update(np.ascontiguousarray(channels[role], dtype="<f8").tobytes())
    return total.hexdigest()

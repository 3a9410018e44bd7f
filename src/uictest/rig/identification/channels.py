"""Channels of a recording in SI units, by name or through a channel map."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.core import recording
from uictest.core.physics import FILL, HOLD, VENT
from uictest.core.recording import ORIGIN, TIME, formats
from uictest.core.units import KINDS
from uictest.rig.identification.lines import Samples
from uictest.rig.identification.suitability import UnsuitableRecordError, require_finite

_SI = {"pressure": "Pa", "force": "N"}
_UNKNOWN_ORIGIN = "recorded, origin not stated"
_LONGEST_ORIGIN = 200
AS_BUILT = "as built: "
"""Before the key of a scenario in the metadata of a bench test."""


@dataclass(frozen=True, slots=True)
class RecordedChannels:
    """Channels of a recording.

    Attributes:
        channels: role -> samples in SI units, and the time in s.
        origin: what was recorded, as the file states it.
        rig: the rig of the record as built, key -> value, as a bench test states it; else empty.
    """

    channels: dict[str, Samples]
    origin: str
    rig: dict[str, str]


def read_record(path: Path, names: Mapping[str, str]) -> RecordedChannels:
    """Read the channels that ``names`` maps from role to name, in SI units, and the time.

    A role that begins with ``command`` is a valve command; ``force`` is a force; every other role but
    ``time`` is a pressure. Time is the channel ``time`` unless ``names`` maps the role to another.

    Raises:
        UnsuitableRecordError: the file is no recording; a channel is missing, its unit unknown, its samples
            not numbers or implausible; or times do not rise.
        OSError: the file cannot be opened.
    """
    try:
        contents = formats.read_contents(path)
        channels = _channels(contents.groups, {TIME: TIME, **names})
        return RecordedChannels(channels, _origin(contents.metadata), _rig(contents.metadata))
    except (formats.UnreadableError, formats.MissingExtraError, UnsuitableRecordError) as error:
        raise UnsuitableRecordError(f"{path}: {error}") from error


def _channels(groups: Sequence[recording.Group], names: Mapping[str, str]) -> dict[str, Samples]:
    for group in groups:
        if all(name in group.channels for name in names.values()):
            return {
                role: _in_si(role, name, group.channels[name], group.units.get(name, ""))
                for role, name in names.items()
            }
    present = sorted({name for group in groups for name in group.channels})
    missing = [name for name in names.values() if name not in present]
    absent = ", ".join(map(repr, missing)) or "group with all channels"
    raise UnsuitableRecordError(f"no channel {absent}; the file has {', '.join(present)}")


def _origin(metadata: Mapping[str, str]) -> str:
    return " ".join(metadata.get(ORIGIN, "").split())[:_LONGEST_ORIGIN] or _UNKNOWN_ORIGIN


def _rig(metadata: Mapping[str, str]) -> dict[str, str]:
    found = {key.removeprefix(AS_BUILT): value for key, value in metadata.items() if key.startswith(AS_BUILT)}
    return {key: value for key, value in found.items() if len(value) <= _LONGEST_ORIGIN}


def _in_si(role: str, name: str, samples: NDArray[np.generic], unit: str) -> Samples:
    if samples.dtype.kind not in "biuf":
        raise UnsuitableRecordError(f"channel {name!r} contains texts; numbers are needed")
    numbers = np.asarray(samples, dtype=np.float64)
    if role.startswith("command"):
        _require_commands(name, numbers)
        return numbers
    kind = role if role in ("time", "force") else "pressure"
    sizes = _sizes(name, unit, kind)
    with np.errstate(over="ignore"):
        converted = numbers if sizes[unit] == 1.0 else numbers * sizes[unit]
    _require_plausible(name, converted, kind, unit, sizes)
    require_finite({name: converted})
    if kind == "time":
        _require_rising(name, converted)
    return converted


def _sizes(name: str, unit: str, kind: str) -> dict[str, float]:
    known = {symbol: float(each.factor) for symbol, each in KINDS[kind].units.items()}
    if unit not in known:
        raise UnsuitableRecordError(
            f"channel {name!r} has the unit {unit or 'none'!r}; accepted: {', '.join(known)}"
        )
    return known


def _require_plausible(
    name: str, converted: Samples, kind: str, unit: str, sizes: Mapping[str, float]
) -> None:
    if kind == "time":
        implausible = recording.implausible_time(converted, unit, sizes)
    else:
        implausible = recording.implausible_unit(converted, _SI[kind], unit, sizes, faulty=0.0)
    if implausible is not None:
        likely = implausible.likely_unit
        question = f"; is it in {likely}, not in {unit}?" if likely else ""
        raise UnsuitableRecordError(f"channel {name!r} {implausible.reason}{question}")


def _require_commands(name: str, commands: Samples) -> None:
    strange = commands[~np.isin(commands, (FILL, HOLD, VENT))]
    if len(strange):
        raise UnsuitableRecordError(
            f"channel {name!r} contains {strange[0]:g}; a valve command is {FILL:g} fill, {HOLD:g} hold or"
            f" {VENT:g} vent"
        )


def _require_rising(name: str, time: Samples) -> None:
    wrong = np.flatnonzero(np.diff(time) <= 0.0)
    if len(wrong):
        k = int(wrong[0])
        raise UnsuitableRecordError(
            f"channel {name!r} does not rise: {time[k + 1]:.6g} s follows {time[k]:.6g} s at sample {k + 1}"
        )


def samples_digest(channels: Mapping[str, Samples]) -> str:
    """SHA-256 of the samples in SI units, in order of role: the same in every file format."""
    total = hashlib.sha256()
    for role in sorted(channels):
        total.update(role.encode())
        total.update(np.ascontiguousarray(channels[role], dtype="<f8").tobytes())
    return total.hexdigest()

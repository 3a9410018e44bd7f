"""Records: their channels in SI units, and whether they support an identification."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.core import recording
from uictest.core.physics import FILL, HOLD, VENT
from uictest.core.recording import ORIGIN, TIME, formats
from uictest.core.units import BAR, KINDS, PERCENT
from uictest.rig.identification.lines import Mask, Samples, runs

_SI = {"pressure": "Pa", "force": "N"}
_UNKNOWN_ORIGIN = "recorded, origin not stated"
_LONGEST_ORIGIN = 200
AS_BUILT = "as built: "
"""Before the key of a scenario in the metadata of a bench test."""
EVENNESS = 0.01
"""Largest departure of one sampling interval from their median, as a share of it; chosen."""
_SMALLEST_SPAN = 0.2 * BAR
"""Pa: range that a pressure must cover; chosen."""
_SWING, _FEWEST_SWINGS = 0.1, 4
"""A swing is a turn by this share of the range; a record needs so many; chosen."""
_SPACING = 0.01
"""Time in s between the samples in which swings are looked for; chosen."""
_SEGMENTS = 20
"""Segments of a record, some of which are held out; chosen."""
_LARGEST_TRUSTED = 0.02
"""Largest error, as a share, up to which what is computed stands in for a caliper; chosen."""


class UnsuitableRecordError(ValueError):
    """A record that does not support an identification; the message says why."""


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
        stated = contents.metadata
        origin = " ".join(stated.get(ORIGIN, "").split())[:_LONGEST_ORIGIN] or _UNKNOWN_ORIGIN
        built = {key.removeprefix(AS_BUILT): text for key, text in stated.items() if key.startswith(AS_BUILT)}
        rig = {key: text for key, text in built.items() if len(text) <= _LONGEST_ORIGIN}
        return RecordedChannels(channels, origin, rig)
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


def _in_si(role: str, name: str, samples: NDArray[np.generic], unit: str) -> Samples:
    if role == "time" and formats.are_dates(samples):
        samples, unit = formats.seconds_of(samples, ""), "s"
        samples = samples - samples[0]
    if samples.dtype.kind not in "biuf":
        raise UnsuitableRecordError(f"channel {name!r} contains texts; numbers are needed")
    numbers = np.asarray(samples, dtype=np.float64)
    if role.startswith("command"):
        _require_commands(name, numbers)
        return numbers
    kind = role if role in ("time", "force") else "pressure"
    sizes = {symbol: float(each.factor) for symbol, each in KINDS[kind].units.items()}
    if unit not in sizes:
        raise UnsuitableRecordError(
            f"channel {name!r} has the unit {unit or 'none'!r}; accepted: {', '.join(sizes)}"
        )
    with np.errstate(over="ignore"):
        converted = numbers if sizes[unit] == 1.0 else numbers * sizes[unit]
    _require_plausible(name, converted, kind, unit, sizes)
    require_finite({name: converted})
    if kind == "time":
        _require_rising(name, converted)
    return converted


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


def required_sampling_time(
    time: Samples, pressures: dict[str, Samples], shortest: float, longest: float
) -> float:
    """Return the even sampling time in s of a record whose pressures vary; tank and cylinder must differ.

    Args:
        time: s.
        pressures: `tank` and `cylinder` pressure, and any others that are finite, Pa.
        shortest: duration that the record must have, s.
        longest: sampling time that it may have, s.

    Raises:
        UnsuitableRecordError: the record cannot support an identification; the message says why.
    """
    require_finite({"time": time, **pressures})
    require_duration(time, shortest)
    step = sampling_time(time, longest)
    for name in ("tank", "cylinder"):
        pressure = pressures[name]
        require_excitation(f"{name}_pressure", pressure, step)
        if pressure.max() <= 0.0:
            raise UnsuitableRecordError(f"the {name} pressure is never above zero: is its sign wrong?")
    if np.array_equal(pressures["tank"], pressures["cylinder"]):
        raise UnsuitableRecordError("tank and cylinder pressure are the same, sample by sample: no dynamics")
    return step


def require_finite(channels: dict[str, Samples]) -> None:
    """Raise UnsuitableRecordError if samples of a channel are missing or infinite."""
    for name, samples in channels.items():
        wrong = np.count_nonzero(~np.isfinite(samples))
        if wrong:
            first = int(np.argmin(np.isfinite(samples)))
            raise UnsuitableRecordError(
                f"channel {name!r} has {wrong} samples that are not numbers, the first at sample {first}"
            )


def require_duration(time: Samples, shortest: float) -> None:
    """Raise UnsuitableRecordError if a record is shorter than ``shortest`` s."""
    duration = float(time[-1] - time[0]) if len(time) else 0.0
    if duration < shortest:
        raise UnsuitableRecordError(f"too short: {duration:.3g} s, at least {shortest:g} s are needed")


def sampling_time(time: Samples, longest: float) -> float:
    """The even sampling time of a record in s. Raises UnsuitableRecordError when it is uneven or too long."""
    intervals = np.diff(time)
    median = float(np.median(intervals))
    worst = int(np.argmax(np.abs(intervals - median)))
    if abs(intervals[worst] - median) > EVENNESS * median:
        raise UnsuitableRecordError(
            f"uneven sampling: {intervals[worst] * 1e3:.4g} ms at {time[worst]:.6g} s"
            f" where {median * 1e3:.4g} ms is usual"
        )
    if median > longest * (1.0 + EVENNESS):
        raise UnsuitableRecordError(
            f"sampled every {median * 1e3:.4g} ms; the dynamics need {longest * 1e3:g} ms or less"
        )
    # The mean over the record; single time stamps are rounded.
    return float(f"{(time[-1] - time[0]) / (len(time) - 1):.9g}")


def require_excitation(name: str, pressure: Samples, step: float) -> None:
    """Raise UnsuitableRecordError if a pressure hardly varies.

    It must turn a few times by a tenth of its range: one rise or fall does not identify three poles.
    """
    span = float(np.ptp(pressure))
    if span < _SMALLEST_SPAN:
        raise UnsuitableRecordError(f"no excitation: {name!r} varies by {span / BAR:.3g} bar only")
    every = max(round(_SPACING / step), 1)
    swings = len(runs(pressure[::every], _SWING * span))
    if swings < _FEWEST_SWINGS:
        raise UnsuitableRecordError(
            f"too little excitation: {name!r} swings {swings} times by a tenth of its range,"
            f" {_FEWEST_SWINGS} times are needed"
        )


def held_out(count: int, share: float) -> Mask:
    """Return the mask of samples that are excluded from the fit: segments spread over the whole record."""
    number = np.arange(count) * _SEGMENTS // count
    return np.asarray(np.floor((number + 1) * share) > np.floor(number * share))


def distrust(largest_error: float) -> str:
    """Return the warning that a largest error, a share of the largest value, calls for; empty for none."""
    if largest_error <= _LARGEST_TRUSTED:
        return ""
    return (
        f"largest error {largest_error / PERCENT:.2f} %, above {_LARGEST_TRUSTED / PERCENT:g} %: what is"
        " computed does not follow this record, whatever its rms; judge with rig.topology: four-caliper"
    )


_AT_REST = 0.02
"""Pressure below which a brake is released, share of the largest pressure; chosen."""
_REST = 0.5
"""Time in s for which it must be; chosen."""
_TURNING = 0.05
"""Change back after which the pressure counts as turned, share of its range; chosen."""
_APPLICATION_SPACING = 0.01
"""Time in s between the samples in which turns are looked for; chosen."""


def applications(tank: Samples, cylinder: Samples, step: float) -> list[slice]:
    """Return the segments of a record for the cylinder dynamics, each started at rest.

    A release at the end of a segment is excluded: air then leaves through the brake line, past the WSP
    valve's vent, and no stop contains it. A record that never rests is one segment.
    """
    released = np.maximum(tank, cylinder) < _AT_REST * max(tank.max(), cylinder.max())
    edges = np.flatnonzero(np.diff(released.astype(int)))
    bounds = [0, *(edges + 1).tolist(), len(tank)]
    rests = [
        (first, end) for first, end in pairwise(bounds) if released[first] and (end - first) * step >= _REST
    ]
    if not rests:
        return [slice(0, len(tank))]
    starts = [0, *(end for _, end in rests)] if rests[0][0] > 0 else [end for _, end in rests]
    ends = [first for first, _ in rests if first > 0] + [len(tank)]
    return [
        slice(max(start - 1, 0), end if end == len(tank) else _before_release(tank, start, end, step))
        for start, end in zip(starts, ends, strict=True)
        if end > start
    ]


def _before_release(tank: Samples, start: int, end: int, step: float) -> int:
    """Sample at which the last fall before ``end`` begins."""
    every = max(round(_APPLICATION_SPACING / step), 1)
    thinned = tank[start:end:every]
    turns = runs(thinned, _TURNING * float(np.ptp(thinned)))
    return start + every * turns[-1][0] if turns and turns[-1][2] < 0 else end

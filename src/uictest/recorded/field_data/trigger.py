"""When the brake command was given, and when the train came to a standstill."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from uictest.core.recording import BRAKE_COMMAND_TIME, at_instants
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.plans.scenario.yaml import QuantityError, parse_quantity
from uictest.recorded.field_data.channel_map import Preparation, of_wheelsets
from uictest.recorded.field_data.raw_channels import Array, MapError, RawChannel

Channels = Mapping[str, RawChannel]
Metadata = Mapping[str, str]
_PRESSURES = ("brake_line_pressure", *of_wheelsets("cylinder_pressure"), *of_wheelsets("tank_pressure"))
_ON = 0.5
"""Above it the brake command, a state of 0 and 1, is given."""
SHORTEST_APPLICATION = 0.1
"""s: no brake acts so briefly, what is shorter is noise; chosen."""


@dataclass(frozen=True, slots=True)
class BrakeCommand:
    """The time of the brake command in the file's own time, s, and how it was found.

    `late`: the brake was already on when the record began, so that the command itself is not in it.
    """

    time: float
    text: str
    late: bool = False


def find_trigger(channels: Channels, metadata: Metadata, preparation: Preparation) -> BrakeCommand:
    """Return the brake command of a record. Raises MapError where nothing marks it."""
    if preparation.trigger_time is not None:
        return _command_at_stated_time(
            channels, float(preparation.trigger_time), "stated by the user", preparation
        )
    for name in _ORDER if preparation.trigger == "auto" else (preparation.trigger,):
        match name:
            case "stated":
                trigger = _command_stated_by_file(channels, metadata, preparation)
            case "start":
                first = float(channels["speed"].time[0])
                _require_running(
                    channels["speed"], first, "the record begins with the brake command", preparation
                )
                trigger = BrakeCommand(first, "the record begins with it")
            case _:
                level = _ON if name == "command" else float(preparation.trigger_pressure)
                trigger = _command_at_first_rise(channels, _SHOWN_BY[name], level, preparation)
        if trigger is not None:
            return trigger
    if preparation.trigger == "auto":
        raise MapError(
            "nothing marks the brake command: no time stated by the file, no brake command, no demanded"
            " pressure and no pressure that rises while the train runs; state it with --trigger"
        )
    raise MapError(
        f"the trigger {preparation.trigger!r} finds no brake command in this record while the train runs"
    )


def _command_stated_by_file(
    channels: Channels, metadata: Metadata, preparation: Preparation
) -> BrakeCommand | None:
    text = metadata.get(BRAKE_COMMAND_TIME)
    if text is None:
        return None
    try:
        return _command_at_stated_time(
            channels, float(parse_quantity(text, "time")), "stated by the file", preparation
        )
    except QuantityError as error:
        hint = f"{error.hint or 'write a time such as 12.3 s'}, or state the time with --trigger"
        raise MapError(f"{BRAKE_COMMAND_TIME} in the header of the file: {error}; {hint}") from error


def _command_at_stated_time(
    channels: Channels, time: float, by: str, preparation: Preparation
) -> BrakeCommand:
    first, last = (float(channels["speed"].time[k]) for k in (0, -1))
    if time >= last:
        raise MapError(
            f"the brake command at {time:.6g} s, {by}, is not in the record from {first:.6g} to {last:.6g} s"
        )
    before = f", before the record begins at {first:.10g} s" if time < first else ""
    text = f"at {time:.6g} s, {by}{before}"
    _require_running(channels["speed"], max(time, first), f"the brake command {text}", preparation)
    return BrakeCommand(max(time, first), text, late=time < first - 1e-6)


def _require_running(speed: RawChannel, time: float, what: str, preparation: Preparation) -> None:
    """Raise MapError if the train does not run at a time: there is no stop to judge."""
    known = np.isfinite(speed.samples)
    running = float(np.interp(time, speed.time[known], speed.samples[known]))
    if running <= float(preparation.trigger_speed):
        backwards = running < -float(preparation.trigger_speed)
        remedy = "; if it runs forwards, write sign: -1 beside the source of the speed" if backwards else ""
        raise MapError(
            f"{what}: the train runs at {running / KILOMETRE_PER_HOUR:.4g} km/h there, not above the"
            f" {preparation.trigger_speed.text} of `trigger_speed`{remedy}"
        )


_SHOWN_BY = {"command": ("brake_command",), "demand": ("demanded_pressure",), "pressure": _PRESSURES}
"""Trigger -> the channels whose first rise marks the brake command."""
_ORDER = ("stated", *_SHOWN_BY)


def _command_at_first_rise(
    channels: Channels, names: tuple[str, ...], level: float, preparation: Preparation
) -> BrakeCommand | None:
    rises = [
        BrakeCommand(time, name, late)
        for name in names
        if name in channels
        for time, late in _first_rise(
            channels[name], channels["speed"], level, float(preparation.trigger_speed)
        )
    ]
    if not rises:
        return None
    first = min(rises, key=lambda rise: rise.time)
    if first.late:
        text = f"before the record, in which {first.text} is on from the start"
        inverted = ', or inverted: then write states: {"0": 1, "1": 0} beside its source'
        is_state = channels[first.text].is_state
        return BrakeCommand(first.time, text + inverted if is_state else text, late=True)
    lead = float(preparation.trigger_lead)
    time = max(first.time - lead, float(channels["speed"].time[0]))
    ahead = f", {preparation.trigger_lead.text} before it" if lead > 0.0 else ""
    text = f"at {time:.6g} s: {first.text} rises{ahead}"
    return BrakeCommand(time, text, late=first.time - lead < time - 1e-6)


def _first_rise(
    channel: RawChannel, speed: RawChannel, level: float, least_speed: float
) -> Iterator[tuple[float, bool]]:
    """Yield the time, s, at which a channel first rises through `level` and stays above, and False.

    If it is above from the start, yield the first time and True. The train must run then. Contacts bounce: a
    channel stays above if it is so for most of the shortest application, and of two samples.
    """
    known = np.isfinite(channel.samples)
    time, samples = channel.time[known], channel.samples[known]
    if len(time) < 2:
        return
    running = at_instants(speed.time, speed.samples, time, holds=False) > least_speed
    above = samples > level
    rises = np.flatnonzero(above[1:] & ~above[:-1] & running[1:])
    ends = np.searchsorted(time, time[rises + 1] + SHORTEST_APPLICATION, side="right")
    shares = [np.mean(above[k + 1 : max(end, k + 3)]) for k, end in zip(rises, ends, strict=True)]
    lasting = [int(k) for k, share in zip(rises, shares, strict=True) if share > 0.5]
    if lasting:
        yield _crossing_time(time, samples, lasting[0], level, held=channel.is_state), False
    elif above[0] and running[0]:
        yield float(time[0]), True


def _crossing_time(time: Array, samples: Array, before: int, level: float, *, held: bool) -> float:
    if held:
        return float(time[before + 1])
    low, high = samples[before], samples[before + 1]
    share = (level - low) / (high - low)
    return float(time[before] + share * (time[before + 1] - time[before]))


_WINDOW = 0.5
"""s: the deceleration over this time before is assumed to last until standstill; chosen."""
_LONGEST_REST = 2.0
"""s after falling below the standstill speed in which a sample of zero is the same stop's; chosen."""

_LONGEST_DROPOUT = 1.0
"""s after a fall of which the train must be slow for more than half; chosen."""
_LEAST_DECELERATION, _LARGEST_DECELERATION = 0.01, 20.0
"""m/s2: less than that of a train that coasts, and twice the acceleration of gravity; chosen."""


@dataclass(frozen=True, slots=True)
class Standstill:
    """Time of standstill, s, how far the train ran beyond the last sample used, m, and that sample's time."""

    time: float
    beyond: float
    last: float
    text: str


def find_standstill(time: Array, speed: Array, begin: float, slow: float) -> Standstill | None:
    """Return the first standstill after `begin` (s) of a train that falls below `slow` (m/s), else None.

    Where a sample at or below zero follows within two seconds, the standstill lies between it and the
    sample before. Otherwise the train runs on from its slowest sample at the deceleration of the last
    half second.
    """
    known = np.isfinite(speed) & (time >= begin)
    time, speed = time[known], speed[known]
    first = first_lasting_fall(time, speed, slow)
    if first is None or speed[0] <= slow:
        return None
    rest = slice(first, int(np.searchsorted(time, time[first] + _LONGEST_REST, side="right")))
    zero = np.flatnonzero(speed[rest] <= 0.0)
    if len(zero):
        return _standstill_between_samples(time, speed, first + int(zero[0]))
    return _standstill_by_extrapolation(time, speed, first + int(np.argmin(speed[rest])))


def first_lasting_fall(time: Array, speed: Array, level: float) -> int | None:
    """Return the sample at which a speed falls to `level` and stays there for longer than a dropout."""
    below = speed <= level
    for k in np.flatnonzero(below[1:] & ~below[:-1]) + 1:
        end = np.searchsorted(time, time[k] + _LONGEST_DROPOUT, side="right")
        if np.median(speed[k:end]) <= level:
            return int(k)
    return None


def _standstill_between_samples(time: Array, speed: Array, zero: int) -> Standstill:
    before, after = float(speed[zero - 1]), float(speed[zero])
    share = before / (before - after)
    moment = float(time[zero - 1] + share * (time[zero] - time[zero - 1]))
    return Standstill(moment, 0.0, moment, "a sample at or below zero")


def _standstill_by_extrapolation(time: Array, speed: Array, last: int) -> Standstill | None:
    start = int(np.searchsorted(time, time[last] - _WINDOW))
    span = float(time[last] - time[start])
    deceleration = float(speed[start] - speed[last]) / span if span > 0.0 else 0.0
    if deceleration <= 0.0:
        return None
    rest = float(speed[last]) / deceleration
    beyond = 0.5 * float(speed[last]) * rest
    text = f"run out from {float(speed[last]) / KILOMETRE_PER_HOUR:.2f} km/h over {rest:.3f} s"
    return Standstill(float(time[last]) + rest, beyond, float(time[last]), text)


def require_plausible_deceleration(speed: RawChannel, begin: float) -> None:
    """Raise MapError if the train halves its speed after `begin` (s) faster or more slowly than trains can.

    Time or speed is in another unit then.
    """
    after = np.isfinite(speed.samples) & (speed.time >= begin)
    since, samples = speed.time[after] - begin, speed.samples[after]
    if not len(since) or samples[0] <= 0.0:
        return
    halved = first_lasting_fall(since, samples, 0.5 * samples[0])
    if halved is None:
        return
    duration = float(since[halved])
    if _LEAST_DECELERATION <= 0.5 * samples[0] / duration <= _LARGEST_DECELERATION:
        return
    initial_speed = samples[0] / KILOMETRE_PER_HOUR
    raise MapError(
        f"the train slows from {initial_speed:.4g} to {0.5 * initial_speed:.4g} km/h in {duration:.4g} s, at"
        f" {0.5 * samples[0] / duration:.4g} m/s2; {_LEAST_DECELERATION} to {_LARGEST_DECELERATION} m/s2 are"
        " plausible: check the units of time and speed"
    )

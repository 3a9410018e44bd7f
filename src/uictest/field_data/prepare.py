"""From the channels of a file to one stop on one raster, with everything that was found on the way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from uictest.field_data.analogue import analogue_defects
from uictest.field_data.channels import UNITS
from uictest.field_data.deceleration import refuse_implausible_deceleration
from uictest.field_data.defect import Defect
from uictest.field_data.filtering import low_passed
from uictest.field_data.preparation import Preparation
from uictest.field_data.raw import Array, RawChannel
from uictest.field_data.resampling import at
from uictest.field_data.standstill import Standstill, find_standstill
from uictest.field_data.time_axis import (
    by_axis,
    coarse_defects,
    disorder,
    gap_defects,
    gaps,
    missing_samples,
    usual_interval,
    without_implausible,
)
from uictest.field_data.trigger import FoundTrigger, find_trigger
from uictest.field_data.wheel_speeds import speed_defects
from uictest.recording import TIME, Recording
from uictest.units import KILOMETRE_PER_HOUR

_SLACK = 1e-6


class UnusableError(Exception):
    """A record whose train speed cannot be used at all; `defects` say why."""

    def __init__(self, defects: tuple[Defect, ...]) -> None:
        self.defects = defects
        super().__init__("; ".join(map(str, defects)))


@dataclass(frozen=True, slots=True, eq=False)
class RecordedStop:
    """One stop as recorded: channels in SI over the time since the brake command, and how they were made.

    Args:
        recording: on an even raster from the brake command to standstill, NaN where nothing was recorded.
        trigger: the brake command.
        standstill: time and distance from the brake command, s and m; None where the record does not hold it.
        defects: everything found wrong.
        choices: how the record was prepared, name -> text: part of the definition of every measure.
        intervals: channel -> usual time between its samples in the file, s.

    """

    recording: Recording
    trigger: FoundTrigger
    standstill: tuple[float, float] | None
    defects: tuple[Defect, ...]
    choices: dict[str, str] = field(default_factory=dict)
    intervals: dict[str, float] = field(default_factory=dict)


def prepare(
    channels: Mapping[str, RawChannel], facts: Mapping[str, str], wanted: Preparation
) -> RecordedStop:
    """Return the stop in a record.

    Nothing is put in where nothing was recorded: a gap stays a gap.

    Raises:
        UnusableError: the train speed has no usable time axis, no number, or none at the brake command.
        MapError: nothing marks the brake command, or no train slows so fast or so little.

    """
    sound, defects = _ordered(channels)
    raster = max(float(wanted.raster), usual_interval(sound["speed"].time))
    for axis in by_axis(sound.values()):
        defects += gap_defects(axis[0].time, _names(axis), raster)
        defects += coarse_defects(axis[0].time, _names(axis))
    defects += [defect for channel in sound.values() for defect in missing_samples(channel)]
    for name, channel in sound.items():
        sound[name], implausible = without_implausible(channel)
        defects += implausible
    if not np.isfinite(sound["speed"].samples).any():
        raise UnusableError(tuple(defects))
    trigger = find_trigger(sound, facts, wanted)
    unfiltered = sound
    if wanted.low_pass is not None:
        sound = {name: low_passed(channel, float(wanted.low_pass)) for name, channel in sound.items()}
    speed = sound["speed"]
    rest = find_standstill(speed.time, speed.samples, trigger.time, float(wanted.standstill_speed))
    refuse_implausible_deceleration(speed, trigger.time)
    end = rest.time if rest else float(speed.time[-1])
    defects += _unlike_a_stop(sound, trigger, end)
    defects += _cut_off(speed, trigger, rest)
    stop = _on_raster(sound, trigger, rest, raster, tuple(defects), wanted)
    sampling = f"speed every {1e3 * usual_interval(speed.time):.6g} ms"
    return replace(
        stop,
        choices={**stop.choices, "filter": _filter(wanted, unfiltered, sound), "sampling": sampling},
        intervals={name: usual_interval(channel.time) for name, channel in sound.items()},
    )


def _unlike_a_stop(channels: Mapping[str, RawChannel], trigger: FoundTrigger, end: float) -> Iterator[Defect]:
    for defect in (
        *speed_defects(channels, trigger.time, end),
        *analogue_defects(channels, trigger.time, end),
    ):
        # An offset shows with the brake released, which a late record never does.
        if not (trigger.late and defect.kind == "offset"):
            yield defect


def _filter(wanted: Preparation, before: Mapping[str, RawChannel], after: Mapping[str, RawChannel]) -> str:
    if wanted.low_pass is None:
        return "none"
    untouched = [name for name, channel in before.items() if after[name] is channel and not channel.is_state]
    but = f", but for {_listed(untouched)}" if untouched else ""
    return f"low-pass {wanted.low_pass.text}{but}"


def _names(channels: list[RawChannel]) -> str:
    return _listed([channel.name for channel in channels])


def _listed(names: list[str]) -> str:
    listed = ", ".join(names[:3])
    return listed if len(names) <= 3 else f"{listed} and {len(names) - 3} more"


def _ordered(channels: Mapping[str, RawChannel]) -> tuple[dict[str, RawChannel], list[Defect]]:
    """Return the channels whose time axis is one, and what is wrong with the others."""
    sound: dict[str, RawChannel] = {}
    defects: list[Defect] = []
    for axis in by_axis(channels.values()):
        found = list(disorder(axis[0].time, _names(axis)))
        defects += found
        if not found and len(axis[0].time) > 1:
            sound |= {channel.name: channel for channel in axis}
    if "speed" not in sound:
        raise UnusableError(tuple(defects) or (Defect("gap", "speed", "has fewer than two samples", True),))
    return {name: sound[name] for name in channels if name in sound}, defects


def _cut_off(speed: RawChannel, trigger: FoundTrigger, rest: Standstill | None) -> Iterator[Defect]:
    if trigger.late:
        yield Defect("starts-late", "the record", f"begins after the brake command: {trigger.text}")
    if rest is None:
        known = np.isfinite(speed.samples)
        last = speed.samples[known][-1] if known.any() else np.nan
        text = f"ends at {speed.time[-1]:.6g} s with the train at {last / KILOMETRE_PER_HOUR:.4g} km/h"
        yield Defect("ends-before-standstill", "the record", text)


def _on_raster(
    channels: dict[str, RawChannel],
    trigger: FoundTrigger,
    rest: Standstill | None,
    raster: float,
    defects: tuple[Defect, ...],
    wanted: Preparation,
) -> RecordedStop:
    measured = "distance" in channels
    if not measured:
        channels = {**channels, "distance": _integrated(channels["speed"], raster)}
    last = min(rest.last, rest.time) if rest else float(channels["speed"].time[-1])
    count = int((last - trigger.time) / raster + _SLACK)
    since: Array = np.arange(count + 1, dtype=np.float64) * raster
    samples = {name: at(channel, trigger.time + since, raster) for name, channel in channels.items()}
    if not np.isfinite(samples["speed"][0]):
        raise UnusableError(
            (*defects, Defect("gap", "speed", f"is not known at the brake command {trigger.text}", True))
        )
    origin = at(channels["distance"], np.array([trigger.time]), raster)[0]
    samples["distance"] = samples["distance"] - origin
    recording = Recording(
        {TIME: since, **{name: samples[name] for name in UNITS if name in samples}},
        {TIME: "s", **{name: UNITS[name] for name in UNITS if name in samples}},
    )
    choices = {
        "trigger": trigger.text,
        "raster": f"{1e3 * raster:.6g} ms, signals linear, states held",
        "standstill_speed": f"{wanted.standstill_speed.text} (chosen)",
        "standstill": rest.text if rest else "not in the record",
        "distance": "recorded" if measured else "integrated from speed",
    }
    return RecordedStop(
        recording, trigger, _stop_of(channels, trigger, rest, origin, raster), defects, choices
    )


def _stop_of(
    channels: Mapping[str, RawChannel],
    trigger: FoundTrigger,
    rest: Standstill | None,
    origin: float,
    raster: float,
) -> tuple[float, float] | None:
    if rest is None:
        return None
    distance = at(channels["distance"], np.array([rest.last]), raster)[0] - origin + rest.beyond
    return rest.time - trigger.time, float(distance)


def _integrated(speed: RawChannel, raster: float) -> RawChannel:
    """Return the distance, m: the speed integrated by trapezoids; unknown from the first gap on."""
    steps = 0.5 * (speed.samples[1:] + speed.samples[:-1]) * np.diff(speed.time)
    steps[gaps(speed.time, raster)] = np.nan
    distance: Array = np.concatenate(([0.0], np.cumsum(steps)))
    return replace(speed, name="distance", source=f"{speed.source}, integrated", samples=distance)

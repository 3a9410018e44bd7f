"""One recorded stop: the channels of a file on one evenly spaced sampling grid, with all its defects."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from uictest.core.recording import SAMPLE_INTERVALS, TIME, TRACK_BRAKES_BESIDE, Recording, usual_interval
from uictest.core.recording.formats import read_contents
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.plans.scenario.yaml import QuantityError, parse_quantity
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, ChannelMap, Preparation
from uictest.recorded.field_data.defects import (
    Defect,
    analogue_defects,
    coarse_defects,
    disorder,
    distance_defects,
    gap_defects,
    interruption,
    missing_samples,
    speed_defects,
    without_implausible,
)
from uictest.recorded.field_data.raw_channels import (
    Array,
    MapError,
    RawChannel,
    at_own_rates,
    by_axis,
    integrated,
    low_passed,
    resampled,
    select_channels,
    with_valve_commands,
)
from uictest.recorded.field_data.trigger import (
    BrakeCommand,
    Standstill,
    find_standstill,
    find_trigger,
    require_plausible_deceleration,
)

_SLACK = 1e-6
"""Share of the sampling interval by which the last sample may miss the standstill."""
Channels = dict[str, RawChannel]


class UnusableError(Exception):
    """A record whose train speed cannot be used at all; `defects` say why."""

    def __init__(self, defects: tuple[Defect, ...]) -> None:
        self.defects = defects
        super().__init__("; ".join(map(str, defects)))


@dataclass(frozen=True, slots=True, eq=False)
class RecordedStop:
    """One stop as recorded: channels in SI over the time since the brake command, and how they were made.

    Args:
        recording: evenly sampled from the brake command to standstill, NaN where nothing was recorded.
        trigger: the brake command.
        standstill: time and distance from the brake command, s and m; None where the record does not hold it.
        defects: everything found wrong.
        choices: how the record was prepared, name -> text: part of the definition of every measure.
        intervals: channel -> usual time between its samples in the file, s.
        position: recorded distance at the brake command, m; NaN where none is recorded.
        track_brakes_beside: time for which the file says that track brakes of other cars acted, s; NaN where
            it does not.

    """

    recording: Recording
    trigger: BrakeCommand
    standstill: tuple[float, float] | None
    defects: tuple[Defect, ...]
    choices: dict[str, str] = field(default_factory=dict)
    intervals: dict[str, float] = field(default_factory=dict)
    position: float = math.nan
    track_brakes_beside: float = math.nan


def stop_in(path: Path, channel_map: ChannelMap) -> RecordedStop:
    """Read a file and return the stop in it.

    Raises UnreadableError, MissingExtraError, MapError, UnusableError, OSError.
    """
    contents = read_contents(path, channel_map.dialect)
    channels = with_valve_commands(at_own_rates(select_channels(contents, channel_map)))
    return prepare(channels, contents.metadata, channel_map.preparation)


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, read piece by piece. Raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def prepare(
    channels: Mapping[str, RawChannel], metadata: Mapping[str, str], preparation: Preparation
) -> RecordedStop:
    """Return the stop in a record.

    A gap stays a gap: no sample is invented where nothing was recorded.

    Args:
        channels: of the file, by canonical name.
        metadata: what the header of the file states, e.g. the time of the brake command.
        preparation: trigger, raster, filter and standstill.

    Raises:
        UnusableError: the train speed has no usable time axis, no number, none at the brake command, or is
            not recorded for a minute of the stop.
        MapError: nothing marks the brake command, the deceleration is not one of a train, or the header
            states a time that is not one.

    """
    ordered, defects = _with_increasing_time(channels)
    grid_interval = max(float(preparation.raster), usual_interval(ordered["speed"].time))
    stated = _stated_intervals(metadata, ordered)
    defects += _sampling_defects(ordered, grid_interval, stated)
    plausible = dict(ordered)
    for name, channel in ordered.items():
        plausible[name], implausible = without_implausible(channel)
        defects += implausible
    if not np.isfinite(plausible["speed"].samples).any():
        raise UnusableError(tuple(defects))
    trigger = find_trigger(plausible, metadata, preparation)
    filtered = plausible
    if preparation.low_pass is not None:
        corner = float(preparation.low_pass)
        filtered = {name: low_passed(channel, corner) for name, channel in plausible.items()}
    speed = filtered["speed"]
    rest = find_standstill(speed.time, speed.samples, trigger.time, float(preparation.standstill_speed))
    end = rest.time if rest else float(speed.time[-1])
    if interrupted := list(interruption(speed.time, trigger.time, end)):
        raise UnusableError((*defects, *interrupted))
    require_plausible_deceleration(speed, trigger.time)
    defects += _sensor_defects(filtered, trigger, end)
    defects += distance_defects(filtered, trigger.time, min(end, rest.last) if rest else end, grid_interval)
    defects += _incomplete_record_defects(speed, trigger, rest)
    recording, standstill, position = _on_sampling_grid(
        filtered, trigger, rest, grid_interval, tuple(defects)
    )
    choices = {
        **_preparation_choices(preparation, trigger, rest, grid_interval, filtered),
        "filter": _filter_text(preparation, plausible, filtered),
        "sampling": _sampling_text(filtered),
    }
    intervals = {name: stated.get(name, usual_interval(channel.time)) for name, channel in filtered.items()}
    beside = _track_brakes_beside(metadata)
    return RecordedStop(recording, trigger, standstill, tuple(defects), choices, intervals, position, beside)


def _track_brakes_beside(metadata: Mapping[str, str]) -> float:
    text = metadata.get(TRACK_BRAKES_BESIDE)
    try:
        return math.nan if text is None else float(parse_quantity(text, "time"))
    except QuantityError as error:
        hint = error.hint or "write a time such as 4.2 s"
        raise MapError(f"{TRACK_BRAKES_BESIDE} in the header of the file: {error}; {hint}") from error


def _preparation_choices(
    preparation: Preparation,
    trigger: BrakeCommand,
    rest: Standstill | None,
    grid_interval: float,
    channels: Channels,
) -> dict[str, str]:
    return {
        "trigger": trigger.text,
        "raster": f"{1e3 * grid_interval:.6g} ms, signals linear, states held",
        "standstill_speed": f"{preparation.standstill_speed.text} (chosen)",
        "standstill": rest.text if rest else "not in the record",
        "distance": "recorded" if "distance" in channels else "integrated from speed",
    }


def _sampling_text(channels: Channels) -> str:
    """Return the interval of the train speed, and those of channels with a time of their own."""
    others = (axis for axis in by_axis(channels.values()) if axis[0].time is not channels["speed"].time)
    texts = [f"{_channel_names(axis)} every {1e3 * usual_interval(axis[0].time):.6g} ms" for axis in others]
    return "; ".join([f"speed every {1e3 * usual_interval(channels['speed'].time):.6g} ms", *texts])


def _with_increasing_time(channels: Mapping[str, RawChannel]) -> tuple[Channels, list[Defect]]:
    """Return the channels whose times increase throughout, and the defects of the other time axes."""
    ordered: Channels = {}
    defects: list[Defect] = []
    for axis in by_axis(channels.values()):
        of_axis = list(disorder(axis[0].time, _channel_names(axis)))
        defects += of_axis
        if not of_axis and len(axis[0].time) > 1:
            ordered |= {channel.name: channel for channel in axis}
    if "speed" not in ordered:
        raise UnusableError(tuple(defects) or (Defect("gap", "speed", "has fewer than two samples", True),))
    return {name: ordered[name] for name in channels if name in ordered}, defects


def _stated_intervals(metadata: Mapping[str, str], channels: Channels) -> dict[str, float]:
    """Return the original sampling interval (s) of each channel that the file has interpolated."""
    try:
        stated = json.loads(metadata.get(SAMPLE_INTERVALS, "{}"))
        return {name: float(stated[name]) for name in channels if name in stated}
    except (ValueError, TypeError) as error:
        raise MapError(f"{SAMPLE_INTERVALS} in the header of the file: write seconds by channel") from error


def _sampling_defects(channels: Channels, grid_interval: float, stated: dict[str, float]) -> Iterator[Defect]:
    for axis in by_axis(channels.values()):
        yield from gap_defects(axis[0].time, _channel_names(axis), grid_interval)
        yield from coarse_defects(usual_interval(axis[0].time), _channel_names(axis))
    for name, interval in stated.items():
        yield from coarse_defects(interval, name)
    for channel in channels.values():
        yield from missing_samples(channel)


def _filter_text(preparation: Preparation, before: Channels, after: Channels) -> str:
    if preparation.low_pass is None:
        return "none"
    untouched = [name for name, channel in before.items() if after[name] is channel and not channel.is_state]
    exceptions = f", but for {_shortened_list(untouched)}" if untouched else ""
    return f"low-pass {preparation.low_pass.text}{exceptions}"


def _sensor_defects(channels: Channels, trigger: BrakeCommand, end: float) -> Iterator[Defect]:
    for defect in (
        *speed_defects(channels, trigger.time, end),
        *analogue_defects(channels, trigger.time, end),
    ):
        # An offset shows with the brake released, which a late record never does.
        if not (trigger.late and defect.kind == "offset"):
            yield defect


def _incomplete_record_defects(
    speed: RawChannel, trigger: BrakeCommand, rest: Standstill | None
) -> Iterator[Defect]:
    if trigger.late:
        yield Defect("starts-late", "the record", f"begins after the brake command: {trigger.text}")
    if rest is None:
        known = np.isfinite(speed.samples)
        last = speed.samples[known][-1] if known.any() else np.nan
        text = f"ends at {speed.time[-1]:.6g} s with the train at {last / KILOMETRE_PER_HOUR:.4g} km/h"
        yield Defect("ends-before-standstill", "the record", text)


def _on_sampling_grid(
    channels: Channels,
    trigger: BrakeCommand,
    rest: Standstill | None,
    grid_interval: float,
    defects: tuple[Defect, ...],
) -> tuple[Recording, tuple[float, float] | None, float]:
    """Return the recording over the time since the brake command, its standstill, and where it begins."""
    if not (recorded := "distance" in channels):
        channels = {**channels, "distance": integrated(channels["speed"], grid_interval, trigger.time)}
    last = min(rest.last, rest.time) if rest else float(channels["speed"].time[-1])
    count = int((last - trigger.time) / grid_interval + _SLACK)
    since: Array = np.arange(count + 1, dtype=np.float64) * grid_interval
    samples = {
        name: resampled(channel, trigger.time + since, grid_interval) for name, channel in channels.items()
    }
    if not np.isfinite(samples["speed"][0]):
        unknown = Defect("gap", "speed", f"is not known at the brake command {trigger.text}", True)
        raise UnusableError((*defects, unknown))
    origin = resampled(channels["distance"], np.array([trigger.time]), grid_interval)[0]
    samples["distance"] = samples["distance"] - origin
    recording = Recording(
        {TIME: since, **{name: samples[name] for name in CHANNEL_UNITS if name in samples}},
        {TIME: "s", **{name: unit for name, unit in CHANNEL_UNITS.items() if name in samples}},
    )
    standstill = None
    if rest is not None:
        run = resampled(channels["distance"], np.array([rest.last]), grid_interval)[0] - origin + rest.beyond
        standstill = rest.time - trigger.time, float(run)
    return recording, standstill, float(origin) if recorded else math.nan


def _channel_names(channels: list[RawChannel]) -> str:
    return _shortened_list([channel.name for channel in channels])


def _shortened_list(names: list[str]) -> str:
    listed = ", ".join(names[:3])
    return listed if len(names) <= 3 else f"{listed} and {len(names) - 3} more"

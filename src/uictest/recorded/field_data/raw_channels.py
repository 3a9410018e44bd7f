"""Channels of a file by canonical name, in SI units, at their own rates or on the sampling grid of a stop."""

from __future__ import annotations

import functools
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import FILL, HOLD, VENT
from uictest.core.recording import (
    LONGEST_RECORD,
    TIME,
    Contents,
    Group,
    Implausible,
    Samples,
    at_instants,
    implausible_time,
    implausible_unit,
    numbers_of,
    state_kind,
    states_of,
    usual_interval,
)
from uictest.core.recording.formats import Cells, Dialect, UnreadableError, seconds_of
from uictest.core.units import ROTATIONAL_SPEEDS, is_recorded_unit, recorded_spellings, recorded_unit_size
from uictest.plans.scenario.yaml import quoted, suggestion
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, WHEELSETS, ChannelMap, ChannelSource

_DATE = re.compile(r"\d\D+\d+\D+\d|\d:\d")
"""Of a date or a clock, in a text."""
Array = NDArray[np.float64]


class MapError(ValueError):
    """A channel map that does not fit a file; the message names the channel."""


@dataclass(frozen=True, slots=True, eq=False)
class RawChannel:
    """One channel as recorded: time in s, samples in SI, neither sorted nor filled.

    `source` is its name in the file.
    """

    name: str
    source: str
    time: Array
    samples: Array

    @property
    def is_state(self) -> bool:
        """Whether its samples are states, which hold until the next sample."""
        return state_kind(self.name) is not None


def select_channels(
    contents: Contents, channel_map: ChannelMap, longest: float | None = LONGEST_RECORD.value
) -> dict[str, RawChannel]:
    """Return the channels of a file that a map selects; a channel without a source in the file is omitted.

    Its times may span `longest`, s, and count from the first where they are dates; infinite: these are a part
    of a file, and dates are Unix time; None: a part whose units are known, all numbers are taken as they are,
    and an unknown state is NaN.

    Raises MapError where a name stands for several channels, a unit is unknown or not the channel's, a text
    is neither a number nor a state, or a channel has no time axis.
    """
    sources = channel_map.sources
    times: dict[int, Array] = {}
    selected: dict[str, RawChannel] = {}
    for name, source in sources.items():
        if name == TIME:
            continue
        match = _find_channel(contents, name, source)
        if match is not None:
            group, original = match
            samples = _in_si(name, source, original, group, channel_map.dialect, longest)
            if id(group) not in times:
                times[id(group)] = _time_of(group, channel_map, original, longest)
            selected[name] = RawChannel(name, original, times[id(group)], samples)
    if "speed" not in selected:
        raise MapError(_no_speed(contents, sources))
    return selected


def _no_speed(contents: Contents, sources: Mapping[str, ChannelSource]) -> str:
    names = [name for group in contents.groups for name in group.channels]
    looked_for = sources["speed"].source if "speed" in sources else ("speed",)
    hint = suggestion(looked_for[0], names) if len(names) <= 40 else ""
    if twice := [column for column in names if re.sub(r" \(\d+\)$", "", column) in looked_for]:
        hint = f"several columns have that name: write one of {', '.join(map(quoted, twice))}"
    skipped = "".join(f"; {quoted(name)} {reason}" for name, reason in list(contents.skipped.items())[:1])
    return (
        f"no channel for 'speed' (train speed): looked for {', '.join(map(quoted, looked_for))}"
        f"{'; ' + hint if hint else ''}{skipped}; 'uictest evaluate FILE --list' shows its channels"
    )


def _find_channel(contents: Contents, name: str, source: ChannelSource) -> tuple[Group, str] | None:
    candidates: list[tuple[Group, str]] = []
    for alias in source.source:
        matches = dict(_matching_channels(contents, alias))
        if len(matches) > 1:
            several = ", ".join(map(quoted, matches))
            raise MapError(f"{name}: {quoted(alias)} is in several groups: write one of {several}")
        candidates += matches.values()
    if len(source.source) == 1:
        return next(iter(candidates), None)
    # Of several names, one with a unit of another kind is another quantity: T1 is a temperature, no torque.
    misfits = [_unit_misfit(name, source, group.units.get(original, "")) for group, original in candidates]
    least = min(misfits, default=_OF_ANOTHER_KIND)
    if not candidates or (least == _OF_ANOTHER_KIND and name != "speed"):
        return None
    return candidates[misfits.index(least)]


def _matching_channels(contents: Contents, alias: str) -> Iterator[tuple[str, tuple[Group, str]]]:
    """Yield the channels that a name stands for by group and name; a group without a name has a number."""
    for k, group in enumerate(contents.groups, start=1):
        label = group.name or f"group {k}"
        for name in group.channels:
            if alias in (name, f"{group.name}/{name}", f"{label}/{name}"):
                yield f"{label}/{name}", (group, name)


_OF_ANOTHER_KIND = 2


def _unit_misfit(name: str, source: ChannelSource, unit: str) -> int:
    """Return 0 where a channel may have the unit, 1 where only with the radius of a wheel, else 2."""
    si = CHANNEL_UNITS[name]
    if source.unit or si == "1" or not is_recorded_unit(unit) or recorded_unit_size(unit, si) is not None:
        return 0
    return 1 if si == "m/s" and unit in ROTATIONAL_SPEEDS else _OF_ANOTHER_KIND


def _time_of(group: Group, channel_map: ChannelMap, beside: str, longest: float | None) -> Array:
    source = channel_map.sources.get(TIME)
    if source is not None and source.interval is not None:
        rows: Array = np.arange(group.first_row, group.first_row + len(group), dtype=np.float64)
        return rows * float(source.interval)
    if group.time is not None:
        time = np.asarray(group.time, dtype=np.float64)
        implausible = None if longest is None else implausible_time(time, "s", {"s": 1.0}, longest)
        return _require_plausible(implausible, TIME, f"of {quoted(beside)}", time)
    named = [alias for alias in source.source if alias in group.channels] if source else []
    # LabVIEW has a column of times also where it writes none; a piece of a log may have them later.
    present = [alias for alias in named if not is_empty(group.channels[alias])]
    present = present or (named if longest is None or math.isinf(longest) else [])
    if source is None or not present:
        raise MapError(
            f"{quoted(beside)} has no time axis: write time: {{source: NAME}} in the channel map, a channel"
            " of its group, or where the file has none the sampling interval, as in time: {interval: 20 ms}"
        )
    dated = [alias for alias in present if holds_dates(group, alias)]
    if dated and (channel_map.csv.dates or dated[0] == present[0]):
        return _time_of_dates(group, dated, channel_map.csv.dates, longest)
    return _in_si(TIME, source, present[0], group, channel_map.dialect, longest)


def is_empty(samples: Samples) -> bool:
    """Return whether a channel has no sample at all."""
    return samples.dtype.kind != "U" and bool(np.isnan(samples).all())


def holds_dates(group: Group, name: str) -> bool:
    """Return whether a channel holds texts of several numbers each, and no single number."""
    samples = group.channels[name]
    if samples.dtype.kind != "U" or np.isfinite(group.numbers.get(name, np.zeros(0))).any():
        return False
    return _DATE.search(next((text for text in samples.tolist() if text), "")) is not None


def _time_of_dates(group: Group, columns: Sequence[str], written: str, longest: float | None) -> Array:
    """Return dates, s, of the first column or of all together; of a whole record since its first."""
    texts = [group.channels[name] for name in columns]
    joined = functools.reduce(lambda one, other: np.char.add(np.char.add(one, " "), other), texts)
    try:
        time = seconds_of(texts[0], written)
    except UnreadableError as error:
        try:
            time = seconds_of(joined, written)
        except UnreadableError:
            raise MapError(f"{TIME}: {quoted(columns[0])}: {error}") from error
    first = time[np.isfinite(time)][:1]
    return time - first if longest is not None and math.isfinite(longest) and len(first) else time


def _in_si(
    name: str, source: ChannelSource, original: str, group: Group, dialect: Dialect, longest: float | None
) -> Array:
    samples = group.channels[original]
    if samples.dtype.kind != "U":
        samples = _with_states_replaced(samples, source.states)
    else:
        strict = longest is not None
        samples = _numbers_of_texts(name, source, original, group, dialect.cells, strict=strict)
        if state_kind(name) is not None:
            return samples
    unit = source.unit or group.units.get(original, "")
    size = _unit_size(name, unit, original, source.wheel_radius)
    # What overflows becomes infinite, which is reported as a sample that is not a number.
    with np.errstate(over="ignore", invalid="ignore"):
        converted: Array = source.sign * (source.scale * samples + source.offset) * size
    if longest is None:
        return converted
    si = CHANNEL_UNITS[name]
    sizes = {**recorded_spellings(si), unit: size}
    if name == TIME:
        implausible = implausible_time(converted, unit, sizes, longest)
    else:
        implausible = implausible_unit(converted, si, unit, sizes)
    return _require_plausible(implausible, name, quoted(original), converted)


def _require_plausible(implausible: Implausible | None, name: str, original: str, samples: Array) -> Array:
    if implausible is not None:
        unit = implausible.likely_unit
        question = f"; is it in {unit}? write `unit: {unit}` in a channel map" if unit else ""
        raise MapError(f"{name}: {original} {implausible.reason}{question}")
    return samples


def _unit_size(name: str, unit: str, original: str, wheel_radius: float | None) -> float:
    si = CHANNEL_UNITS[name]
    if not unit and si == "1":
        return 1.0
    if not unit:
        raise MapError(
            f"{name}: the file does not state the unit of {quoted(original)}:"
            " write `unit:` in the channel map"
        )
    if si == "m/s" and unit in ROTATIONAL_SPEEDS:
        if wheel_radius is None:
            raise MapError(
                f"{name}: {quoted(original)} is in {unit}: write the radius of its wheel beside its source in"
                " the channel map, as in wheel_radius: 0.46 m"
            )
        return ROTATIONAL_SPEEDS[unit] * float(wheel_radius)
    if wheel_radius is not None:
        raise MapError(
            f"{name}: {quoted(original)} is in {unit}, no rotational speed: leave out wheel_radius"
        )
    size = recorded_unit_size(unit, si)
    if size is None and si == "K":
        raise MapError(
            f"{name}: {quoted(original)} has the unit {quoted(unit)}: write unit: K, and for degrees Celsius"
            " offset: 273.15, in the channel map"
        )
    if size is None:
        raise MapError(
            f"{name}: {quoted(original)} has the unit {quoted(unit)};"
            f" accepted: {', '.join(recorded_spellings(si))}; write `unit:` in the channel map"
        )
    return size


def _with_states_replaced(samples: Samples, states: Mapping[str, int]) -> Samples:
    """Return samples of numbers with those that a map names as states, `"0": 1`, in their place."""
    replaced = samples.copy() if states else samples
    for text, number in states.items():
        if Cells().is_number(text):
            replaced[samples == Cells().column([text]).numbers[0]] = number
    return replaced


def _numbers_of_texts(
    name: str, source: ChannelSource, original: str, group: Group, cells: Cells, *, strict: bool
) -> Array:
    """Return the numbers of a channel of texts: its own, and those of the states that it names.

    Another text is NaN in a state where not `strict`, else it raises MapError.
    """
    values, strange = numbers_of(group, original, {**states_of(name), **source.states}, cells)
    if strange and (strict or state_kind(name) is None):
        text = strange[0]
        location = group.first_texts.get(original, {}).get(text, "")
        if state_kind(name) is None:
            raise MapError(f"{name}: {quoted(original)}: {cells.refusal(text, location)}")
        where = f", in {location}" if location else ""
        example = json.dumps({state: k for k, state in enumerate(strange[:3])}, ensure_ascii=False)
        raise MapError(
            f"{name}: {quoted(original)} is {quoted(text)}{where}, which is no state:"
            f" name it in `states` of the channel map, as in states: {example}"
        )
    return values


_ON = 0.5


def with_valve_commands(channels: Mapping[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels with the valve command of every wheelset whose two magnets have common times."""
    return {**dict(_valve_commands(channels)), **channels}


def _valve_commands(channels: Mapping[str, RawChannel]) -> Iterator[tuple[str, RawChannel]]:
    for n in WHEELSETS:
        hold, vent = (channels.get(f"{magnet}_{n}") for magnet in ("hold_magnet", "vent_magnet"))
        if hold is not None and vent is not None and np.array_equal(hold.time, vent.time):
            name, sources = f"valve_command_{n}", f"{hold.source}, {vent.source}"
            yield (
                name,
                RawChannel(name, sources, hold.time, _valve_command_of_magnets(hold.samples, vent.samples)),
            )


def _valve_command_of_magnets(hold: Array, vent: Array) -> Array:
    """Return the commands; a valve that vents does so whatever its other magnet shows."""
    command = np.where(vent > _ON, VENT, np.where(hold > _ON, HOLD, FILL))
    return np.where(np.isfinite(hold) & np.isfinite(vent), command, np.nan)


def by_axis(channels: Iterable[RawChannel]) -> list[list[RawChannel]]:
    """Return the channels that share a time axis together, in their own order."""
    axes: dict[int, list[RawChannel]] = {}
    for channel in channels:
        axes.setdefault(id(channel.time), []).append(channel)
    return list(axes.values())


_SLOWER = 1.5
"""Times the interval of its rows that a channel of a rate of its own takes at least; chosen."""
_FEW_SAMPLES = 10
"""Samples that show a rate at least; chosen."""


def at_own_rates(channels: Mapping[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels whose samples regularly miss in the rows of others over a time of their own.

    Programs write channels of several rates or clocks into one table so. Whatever else is missing stays so.
    """
    axes: dict[tuple[int, bytes], Array] = {}
    own_rates = dict(channels)
    for name, channel in channels.items():
        present = np.isfinite(channel.samples) & np.isfinite(channel.time)
        times = axes.setdefault((id(channel.time), present.tobytes()), channel.time[present])
        if len(times) < _FEW_SAMPLES or np.all(np.diff(np.flatnonzero(present)) == 1):
            continue
        usual = usual_interval(times)
        slower = usual > _SLOWER * usual_interval(channel.time) and not gaps(times, 0.0).any()
        if slower or np.max(np.diff(times)) <= _SLOWER * usual:
            own_rates[name] = replace(channel, time=times, samples=channel.samples[present])
    return own_rates


_GAP_INTERVALS = 2.5
"""A gap is longer than this many usual intervals, and than the interval of the sampling grid; chosen."""


def gaps(time: Array, grid_interval: float) -> NDArray[np.bool_]:
    """Return the mask of intervals between neighbouring samples that are gaps."""
    longest = max(_GAP_INTERVALS * usual_interval(time), grid_interval * (1.0 + 1e-6))
    return np.asarray(np.diff(time) > longest)


_HIGHEST_SHARE = 0.4
"""Of the sampling rate: above it a low-pass would change nothing that was sampled."""


def low_passed(channel: RawChannel, corner: float) -> RawChannel:
    """Return a signal after a low-pass of second order with a corner frequency in Hz, applied both ways.

    States, channels with missing samples and channels sampled so slowly that they hold nothing above the
    corner are returned as they are. Applied both ways, the filter delays nothing.
    """
    interval = usual_interval(channel.time)
    complete = bool(np.isfinite(channel.samples).all())
    if channel.is_state or not complete or len(channel.time) < 10 or corner * interval > _HIGHEST_SHARE:
        return channel
    from scipy.signal import butter, sosfiltfilt

    count = round((channel.time[-1] - channel.time[0]) / interval) + 1
    even = np.linspace(channel.time[0], channel.time[-1], count)
    sections = butter(1, corner, fs=(count - 1) / (even[-1] - even[0]), output="sos")
    filtered = sosfiltfilt(sections, np.interp(even, channel.time, channel.samples))
    return replace(channel, samples=np.interp(channel.time, even, filtered))


def resampled(channel: RawChannel, times: Array, grid_interval: float) -> Array:
    """Return a channel at `times` (s, rising); NaN where it was not recorded.

    Args:
        channel: sorted in time; NaN samples stay NaN, and so does what lies between them and others.
        times: at which samples are returned.
        grid_interval: interval of `times`, s: shorter intervals between samples are not gaps.

    """
    if len(channel.time) < 2:
        return np.full(len(times), np.nan)
    lost = gaps(channel.time, grid_interval)
    return at_instants(channel.time, channel.samples, times, holds=channel.is_state, gaps=lost)


def integrated(speed: RawChannel, grid_interval: float, begin: float) -> RawChannel:
    """Return the distance, m: the speed integrated; unknown from its first gap after `begin`, s."""
    steps = 0.5 * (speed.samples[1:] + speed.samples[:-1]) * np.diff(speed.time)
    steps[gaps(speed.time, grid_interval)] = np.nan
    steps[np.isnan(steps) & (speed.time[1:] <= begin)] = 0.0
    distance: Array = np.concatenate(([0.0], np.cumsum(steps)))
    return replace(speed, name="distance", source=f"{speed.source}, integrated", samples=distance)

"""When the criteria of a stop were decided: where the fields that decide a measure changed."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.core.measures import (
    MEASURES,
    Cell,
    Faults,
    Measure,
    MeasureDefinition,
    Replay,
    WheelsetMeasures,
    samples_of,
)
from uictest.core.record import fields_of
from uictest.core.recording import Recording
from uictest.core.units import SIZES, in_unit
from uictest.judging import evaluation
from uictest.plans.faults import FAULT_KINDS, SPEED_SENSOR
from uictest.report.traces.quantities import PANELS, WHEELSETS

Interval = tuple[float, float]
"""First and last time, s since the brake command."""
Extreme = tuple[float, float]
"""Time, s since the brake command, and height, in the unit of the plot."""

TRAIN: Final = 0
"""The number that the train has among the wheelsets 1 .. 4."""
_REQUIRED: Final = [f"{row.part}-{row.name}" for row in FAULT_KINDS.values() if row.report == "required"]
"""Beginnings of the labels of faults that a controller is to report, whatever they cause."""
_UNITS: Final = {panel.key: panel.unit for panel in PANELS}


@dataclass(frozen=True, slots=True)
class Moments:
    """When one criterion was decided.

    Args:
        intervals: number of a wheelset -> the intervals that its measure counts.
        extremes: number of a wheelset, or `TRAIN` -> the instant of its largest or smallest value.
        span: the time over which a measure looks; None where that is not known, or the whole stop.
        wheelset: the one that decides; None for a measure of the train, or where that is not known.

    """

    intervals: Mapping[int, Sequence[Interval]] = field(default_factory=dict)
    extremes: Mapping[int, Extreme] = field(default_factory=dict)
    span: Interval | None = None
    wheelset: int | None = None


class _Changes(NamedTuple):
    """Where one number of the records changed: it had `value` at last, from `time` (s) on.

    `grown` holds the intervals in which it grew, from the sample before to the last.
    """

    value: float
    time: float
    grown: list[Interval]


def moments_of(
    verdicts: Iterable[evaluation.Verdict],
    record: Recording,
    wheelsets: Sequence[Mapping[str, float]] = (),
) -> dict[str, Moments]:
    """Return the moments of each criterion whose measure has any, by the id of the criterion.

    Args:
        verdicts: of the stop; their definitions say what counts.
        record: every sample of the stop, SI.
        wheelsets: what the result of the stop reports of each, for what no recording tells.

    """
    judged = [
        (verdict, measure)
        for verdict in verdicts
        if (measure := MEASURES.get(verdict.measure)) is not None
        and measure.decided is not None
        and all(verdict.defined(name) is not None for name in measure.definitions)
    ]
    if "speed" not in record.channels or not judged:
        return {}
    replay = _replay([verdict for verdict, _ in judged], record)
    cells = {cell: None for verdict, measure in judged for cell in _cells(verdict, measure)}
    changes = _changes(replay, list(cells))
    if "sliding_time" in record.metadata:  # more exact than the samples
        replay.train.sliding_time = float(record.metadata["sliding_time"])
    return {
        verdict.id: _moments(verdict, measure, replay, changes, record, wheelsets)
        for verdict, measure in judged
    }


def _replay(verdicts: Iterable[evaluation.Verdict], record: Recording) -> Replay:
    """Return the records of the stop at its first sample; definitions that no verdict has are unknown."""
    stated = {each.name: each.value for verdict in verdicts for each in verdict.definitions}
    unknown = dict.fromkeys(fields_of(MeasureDefinition), math.nan)
    demanded = record.channels.get("demanded_pressure", np.array([math.nan]))
    return Replay(
        samples_of(record.channels, faults=_faults(record)),
        SimpleNamespace(**(unknown | stated)),
        float(np.fmax.reduce(demanded)),  # a gap says nothing; without any value it is not known
    )


def _faults(record: Recording) -> Faults | None:
    """Return the faults of the stop; each label ends with the number of its wheelset, if it has one."""
    labels = record.metadata.get("faults", "")
    if not labels or "active_faults" not in record.channels:
        return None
    active = np.nan_to_num(record["active_faults"]).astype(np.int64)
    begun = np.bitwise_or.accumulate(active)

    def of_wheelsets(bits: NDArray[np.int64], kinds: str = ".*") -> NDArray[np.float64]:
        own = [
            [1 << k for k, label in enumerate(labels.split(", ")) if re.fullmatch(rf"{kinds}-{n}", label)]
            for n in WHEELSETS
        ]
        return np.stack([(bits & sum(each)) != 0 for each in own], axis=1).astype(np.float64)

    return (
        np.asarray(begun != 0, float),
        of_wheelsets(begun),
        of_wheelsets(active, f"{SPEED_SENSOR}.*"),
        of_wheelsets(begun, f"({'|'.join(_REQUIRED)})"),
    )


def _cells(verdict: evaluation.Verdict, measure: Measure) -> list[Cell]:
    """Return the numbers whose changes decide a criterion, of the wheelsets or of the train."""
    decided = measure.decided
    if decided is None or not decided.field:
        return []
    place = None if decided.place is None else decided.place(_definition(verdict))
    numbers = WHEELSETS if decided.field in fields_of(WheelsetMeasures) else (TRAIN,)
    return [(decided.field, n, place) for n in numbers]


def _definition(verdict: evaluation.Verdict) -> dict[str, float]:
    return {each.name: each.value for each in verdict.definitions}


def _changes(replay: Replay, cells: Sequence[Cell]) -> dict[Cell, _Changes]:
    """Let the samples pass and return where the numbers of the records changed."""
    first = replay.numbers_at(cells)
    noted = rig.noted_numbers(replay, cells)
    time = replay.samples.train[:, 0]
    return {cell: _changes_of(first[j], noted[:, j], time) for j, cell in enumerate(cells)}


def _changes_of(first: float, noted: NDArray[np.float64], time: NDArray[np.float64]) -> _Changes:
    """Return where a number changed that was `first` at the first sample, and `noted` at each after it."""
    known = np.flatnonzero(~np.isnan(noted))
    values = noted[known]
    before = np.concatenate(([first], values))[:-1]
    changes = known[values != before]
    if not len(changes):
        return _Changes(first, float(time[0]), [])
    growths = known[(values > before) | np.isnan(before)]
    grown = _joined(time[growths], time[growths + 1])
    return _Changes(float(noted[changes[-1]]), float(time[changes[-1] + 1]), grown)


def _joined(starts: NDArray[np.float64], ends: NDArray[np.float64]) -> list[Interval]:
    """Return intervals in their order, as one where the next begins at the end of the one before."""
    if not len(starts):
        return []
    breaks = np.flatnonzero(starts[1:] != ends[:-1])
    return list(zip(starts[[0, *breaks + 1]].tolist(), ends[[*breaks, -1]].tolist(), strict=True))


def _moments(
    verdict: evaluation.Verdict,
    measure: Measure,
    replay: Replay,
    changes: Mapping[Cell, _Changes],
    record: Recording,
    wheelsets: Sequence[Mapping[str, float]],
) -> Moments:
    decided, definition, time = measure.decided, _definition(verdict), record["time"]
    assert decided is not None
    own = {
        cell[1]: changes[cell]
        for cell in _cells(verdict, measure)
        if decided.among is None or decided.among(replay.wheelsets[cell[1] - 1])
    }
    span = None if decided.span is None else decided.span(replay.train, definition)
    if decided.down_to:
        reached = np.flatnonzero(record["speed"] <= definition[decided.down_to])
        span = (float(time[0]), float(time[reached[0]])) if len(reached) else None
    intervals: dict[int, Sequence[Interval]] = {}
    extremes = {}
    for n, each in own.items():
        if decided.how in ("intervals", "longest") and each.grown:
            intervals[n] = each.grown
        elif decided.how == "outer" and each.grown:
            intervals[n] = [(each.grown[0][1], float(time[-1]) if each.value else each.time)]
        elif decided.how == "extreme" and math.isfinite(each.value):
            row = int(np.searchsorted(time, each.time))
            value = float(record[decided.channel][row]) if decided.channel else each.value
            extremes[n] = each.time, in_unit(value, _UNITS[decided.plot])
    known = span if span is not None and all(map(math.isfinite, span)) else None
    return Moments(intervals, extremes, known, _deciding(verdict, measure, replay, intervals, wheelsets))


def _deciding(
    verdict: evaluation.Verdict,
    measure: Measure,
    replay: Replay,
    intervals: Mapping[int, Sequence[Interval]],
    wheelsets: Sequence[Mapping[str, float]],
) -> int | None:
    """Return the wheelset whose value is that of the criterion, or which has the longest interval of all."""
    if measure.of_wheelsets and verdict.value is not None:
        values = measure.read(replay.train, replay.wheelsets, _definition(verdict)).values
        own = [in_unit(value, verdict.unit) for value in values]
        column = measure.column
        if column is not None and not any(map(math.isfinite, own)):
            scale = SIZES[column.unit] / SIZES[verdict.unit]
            own = [scale * each.get(column.name, math.nan) for each in wheelsets]
        distances = {n: abs(value - verdict.value) for n, value in enumerate(own, start=1)}
        known = {n: distance for n, distance in distances.items() if math.isfinite(distance)}
        return min(known, key=known.__getitem__, default=None)
    if measure.decided is not None and measure.decided.how == "longest":
        return max(intervals, key=lambda n: max(map(duration, intervals[n])), default=None)
    return None


def duration(interval: Interval) -> float:
    """Return how long an interval lasts, s."""
    first, last = interval
    return last - first

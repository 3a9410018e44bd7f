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
    verdicts: Iterable[evaluation.Verdict], record: Recording, wheelsets: Sequence[Mapping[str, float]] = ()
) -> dict[str, Moments]:
    """Return the moments of each criterion whose measure has any, by the id of the criterion.

    Args:
        verdicts: verdicts of the stop; their definitions say what counts.
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
    replay = _replay_of([verdict for verdict, _ in judged], record)
    cells = list(
        dict.fromkeys(cell for verdict, measure in judged for cell in _deciding_cells(verdict, measure))
    )
    first = replay.numbers_at(cells)
    noted = rig.noted_numbers(replay, cells)  # all samples pass
    time = replay.samples.train[:, 0]
    changes = {cell: _changes_of(first[j], noted[:, j], time) for j, cell in enumerate(cells)}
    if "sliding_time" in record.metadata:  # more exact than the samples
        replay.train.sliding_time = float(record.metadata["sliding_time"])
    return {
        verdict.id: _moments_of_measure(verdict, measure, replay, changes, record, wheelsets)
        for verdict, measure in judged
    }


def _replay_of(verdicts: Iterable[evaluation.Verdict], record: Recording) -> Replay:
    """Return the records of the stop at its first sample; definitions that no verdict has are unknown."""
    stated = {name: value for verdict in verdicts for name, value in _numeric_definition(verdict).items()}
    unknown = dict.fromkeys(fields_of(MeasureDefinition), math.nan)
    demanded = record.channels.get("demanded_pressure", np.array([math.nan]))
    return Replay(
        samples_of(record.channels, faults=_recorded_faults(record)),
        SimpleNamespace(**(unknown | stated)),
        float(np.fmax.reduce(demanded)),  # a gap says nothing; without any value it is not known
    )


def _recorded_faults(record: Recording) -> Faults | None:
    """Return the faults of the stop; each label ends with the number of its wheelset, if it has one."""
    labels = record.metadata.get("faults", "")
    if not labels or "active_faults" not in record.channels:
        return None
    active = np.nan_to_num(record["active_faults"]).astype(np.int64)
    begun = np.bitwise_or.accumulate(active)

    def of_wheelsets(bits: NDArray[np.int64], kinds: str = ".*") -> NDArray[np.float64]:
        of_wheelset = [
            [1 << k for k, label in enumerate(labels.split(", ")) if re.fullmatch(rf"{kinds}-{n}", label)]
            for n in WHEELSETS
        ]
        return np.stack([(bits & sum(masks)) != 0 for masks in of_wheelset], axis=1).astype(np.float64)

    return (
        np.asarray(begun != 0, float),
        of_wheelsets(begun),
        of_wheelsets(active, f"{SPEED_SENSOR}.*"),
        of_wheelsets(begun, f"({'|'.join(_REQUIRED)})"),
    )


def _deciding_cells(verdict: evaluation.Verdict, measure: Measure) -> list[Cell]:
    """Return the numbers whose changes decide a criterion, of the wheelsets or of the train."""
    decided = measure.decided
    if decided is None or not decided.field:
        return []
    index = None if decided.index is None else decided.index(_numeric_definition(verdict))
    numbers = WHEELSETS if decided.field in fields_of(WheelsetMeasures) else (TRAIN,)
    return [(decided.field, n, index) for n in numbers]


def _numeric_definition(verdict: evaluation.Verdict) -> dict[str, float]:
    return {applied.name: applied.value for applied in verdict.definitions}


def _changes_of(first: float, noted: NDArray[np.float64], time: NDArray[np.float64]) -> _Changes:
    """Return where a number changed that was `first` at the first sample, and `noted` at each after it."""
    known = np.flatnonzero(~np.isnan(noted))
    values = noted[known]
    before = np.concatenate(([first], values))[:-1]
    changes = known[values != before]
    if not len(changes):
        return _Changes(first, float(time[0]), [])
    growths = known[(values > before) | np.isnan(before)]
    starts, ends = time[growths], time[growths + 1]
    grown: list[Interval] = []
    if len(growths):
        # What begins where another interval ends is one with it.
        breaks = np.flatnonzero(starts[1:] != ends[:-1])
        grown = list(zip(starts[[0, *breaks + 1]].tolist(), ends[[*breaks, -1]].tolist(), strict=True))
    return _Changes(float(noted[changes[-1]]), float(time[changes[-1] + 1]), grown)


def _moments_of_measure(
    verdict: evaluation.Verdict,
    measure: Measure,
    replay: Replay,
    changes: Mapping[Cell, _Changes],
    record: Recording,
    wheelsets: Sequence[Mapping[str, float]],
) -> Moments:
    decided, definition, time = measure.decided, _numeric_definition(verdict), record["time"]
    assert decided is not None
    span = None if decided.span is None else decided.span(replay.train, definition)
    if decided.down_to:
        reached = np.flatnonzero(record["speed"] <= definition[decided.down_to])
        span = (float(time[0]), float(time[reached[0]])) if len(reached) else None
    if span is not None and not all(map(math.isfinite, span)):
        span = None
    intervals: dict[int, Sequence[Interval]] = {}
    extremes = {}
    for cell in _deciding_cells(verdict, measure):
        _, n, _ = cell
        change = changes[cell]
        if decided.among is not None and not decided.among(replay.wheelsets[n - 1]):
            continue
        if decided.how in ("intervals", "longest") and change.grown:
            intervals[n] = change.grown
        elif decided.how == "outer" and change.grown:
            intervals[n] = [(change.grown[0][1], float(time[-1]) if change.value else change.time)]
        elif decided.how == "extreme" and math.isfinite(change.value):
            row = int(np.searchsorted(time, change.time))
            value = float(record[decided.channel][row]) if decided.channel else change.value
            extremes[n] = change.time, in_unit(value, _UNITS[decided.plot])
    wheelset = None
    if measure.of_wheelsets and verdict.value is not None:
        wheelset = _wheelset_of(verdict.value, verdict, measure, replay, wheelsets)
    elif decided.how == "longest":
        wheelset = max(intervals, key=lambda n: max(map(duration, intervals[n])), default=None)
    return Moments(intervals, extremes, span, wheelset)


def _wheelset_of(
    value: float,
    verdict: evaluation.Verdict,
    measure: Measure,
    replay: Replay,
    wheelsets: Sequence[Mapping[str, float]],
) -> int | None:
    """Return the wheelset that has the value of a criterion, in its unit; None where none has any."""
    read = measure.read(replay.train, replay.wheelsets, _numeric_definition(verdict)).values
    values = [in_unit(number, verdict.unit) for number in read]
    if measure.column is not None and not any(map(math.isfinite, values)):
        scale = SIZES[measure.column.unit] / SIZES[verdict.unit]
        values = [scale * wheelset.get(measure.column.name, math.nan) for wheelset in wheelsets]
    distances = {n: abs(number - value) for n, number in enumerate(values, 1) if math.isfinite(number)}
    return min(distances, key=distances.__getitem__, default=None)


def duration(interval: Interval) -> float:
    """Return the duration of an interval, s."""
    first, last = interval
    return last - first

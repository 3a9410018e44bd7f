"""From the measures of many simulated stops to their results, in arrays.

Every result is the one of :func:`~uictest.judging.evaluation.evaluate_simulated`. Stops that ended before
standstill and those with a measure that is not finite go through it one by one: they are few, and each has
its own text.
"""

from __future__ import annotations

import math
from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.ensemble import Places, alike, by_way, ensembles_of, rows_at
from uictest.core.measures import (
    STOP_COLUMNS,
    STOP_MEASURES,
    WHEELSET_COLUMNS,
    WHEELSET_MEASURES,
    StopColumn,
    WheelsetColumn,
)
from uictest.core.units import in_unit
from uictest.judging.evaluation.block_verdicts import (
    STATUSES,
    WHEELSET_COUNT,
    BlockVerdicts,
    Seen,
    block_verdicts,
)
from uictest.judging.evaluation.bounds import ObservedStop
from uictest.judging.evaluation.case import (
    FINITE_IN_STOPS,
    FINITE_IN_WHEELSETS,
    column_definition,
    error_result,
    evaluate_simulated,
)
from uictest.judging.evaluation.json_values import Outcome
from uictest.judging.evaluation.result import deciding_verdicts, reason_of
from uictest.judging.evaluation.result_columns import ResultColumns, result_columns
from uictest.judging.evaluation.verdict import Layer, Status
from uictest.plans import scenario

# Judging reads many fields, and a numpy record takes ten times as long to read as a tuple.
_tuple_of: Any = namedtuple
_Stop: Final = _tuple_of("_Stop", STOP_MEASURES.names)
_Wheelset: Final = _tuple_of("_Wheelset", WHEELSET_MEASURES.names)


@dataclass(frozen=True)
class StopBlock:
    """Simulated stops that are judged by the same criteria.

    `measures` and `wheelset_measures` are records, shapes (n,) and (n, 4). `case_at` gives the case at a
    place; `scenario_of` one scenario for the cases at some places, with ensembles where numbers differ.
    `biases` are those of measures by name, as shares of the value; one that is not among them may be of any
    size. None: there is none.
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]
    case_at: Callable[[int], scenario.Case]
    scenario_of: Callable[[Places], scenario.Scenario]
    biases: Mapping[str, float] | None = None

    def bias_of(self, measure: str) -> float:
        """Return the bias of a measure."""
        return 0.0 if self.biases is None else self.biases.get(measure, math.inf)

    def together(self, places: Places) -> Seen:
        """Return scenario and stop of several cases."""
        wheelsets = [wheelsets_at(places) for wheelsets_at in self._wheelsets_at]
        return self.scenario_of(places), ObservedStop(self.stops_at(places), wheelsets)

    @cached_property
    def stops_at(self) -> Callable[[Places], Any]:
        """Measures of the stops at several places, with ensembles."""
        return ensembles_of(self.measures)

    @cached_property
    def _wheelsets_at(self) -> list[Callable[[Places], Any]]:
        return [ensembles_of(self.wheelset_measures[:, k]) for k in range(WHEELSET_COUNT)]

    def alone(self, place: int) -> Seen:
        """Return scenario and stop of one case."""
        return self.case_at(place).scenario, ObservedStop(*self.records(place))

    def records(self, place: int) -> tuple[Any, list[Any]]:
        """Return the measures of one stop and of its wheelsets."""
        stop, wheelsets = self.measures[place].tolist(), self.wheelset_measures[place].tolist()
        return _Stop(*stop), [_Wheelset(*wheelset) for wheelset in wheelsets]

    def take(self, places: Places) -> StopBlock:
        """Return the stops at some places."""
        return StopBlock(
            rows_at(self.measures, places),
            rows_at(self.wheelset_measures, places),
            lambda place: self.case_at(int(places[place])),
            lambda own: self.scenario_of(places[own]),
            self.biases,
        )


def evaluate_block(stops: StopBlock) -> ResultColumns:
    """Return the results of simulated stops; a stop that cannot be judged has the outcome `error`."""
    regular = _is_regular(stops)
    if regular.all():
        return _evaluate_regular(stops)
    columns = result_columns(stops.measures.size)
    for place in np.flatnonzero(~regular).tolist():
        columns.put(place, _evaluate_alone(stops, place))
    if regular.any():
        places = np.flatnonzero(regular)
        columns.put_block(places, _evaluate_regular(stops.take(places)))
    return columns


def _evaluate_regular(stops: StopBlock) -> ResultColumns:
    """Return the results of stops that came to a standstill with all numbers finite."""
    try:
        return _evaluate_together(stops)
    except Exception:  # a case that cannot be judged becomes a row and does not end the sweep
        columns = result_columns(stops.measures.size)
        for place in range(stops.measures.size):
            columns.put(place, _evaluate_alone(stops, place))
        return columns


def _is_regular(stops: StopBlock) -> NDArray[np.bool_]:
    """Return which stops came to a standstill with all numbers finite."""
    regular: NDArray[np.bool_] = stops.measures["stopped"] != 0.0
    for name in FINITE_IN_STOPS:
        regular &= np.isfinite(stops.measures[name])
    for name in FINITE_IN_WHEELSETS:
        regular &= np.isfinite(stops.wheelset_measures[name]).all(axis=1)
    return regular


def _evaluate_alone(stops: StopBlock, place: int) -> Any:
    case = stops.case_at(place)
    try:
        return evaluate_simulated(case, *stops.records(place), explain=False)
    except Exception as error:
        return error_result(case, f"{type(error).__name__}: {error}")


def _evaluate_together(stops: StopBlock) -> ResultColumns:
    columns = result_columns(stops.measures.size)
    resolved = stops.case_at(0).scenario
    verdicts = [
        block_verdicts(
            *(criterion, stops.together, stops.alone, stops.measures.size), stops.bias_of(criterion.measure)
        )
        for profile in resolved.judged_by
        for criterion in profile.criteria
    ]
    for places, outcome, deciding in _outcomes(verdicts, stops.measures.size):
        columns.put_outcome(places, outcome, resolved.expect)
        columns.reasons[places] = reason_of(outcome, ())
        if deciding:
            columns.reasons[places] = [
                reason_of(outcome, ((each.id, each.reason(place)) for each in deciding))
                for place in places.tolist()
            ]
    columns.near_limit[:] = np.any([each.near_limit for each in verdicts], axis=0)
    _put_narrowest_margins(columns, verdicts)
    columns.measures.update(_stop_columns(stops, column_definition(resolved)))
    columns.wheelsets.update(_wheelset_columns(stops))
    return columns


@dataclass(frozen=True, slots=True)
class _Decided:
    """The status of a criterion in some stops."""

    layer: Layer
    status: Status
    verdicts: BlockVerdicts


def _outcomes(
    verdicts: Sequence[BlockVerdicts], count: int
) -> Iterator[tuple[Places, Outcome, list[BlockVerdicts]]]:
    """Yield the places of stops with the same statuses, their outcome and the verdicts that decide it."""
    for places in alike([each.statuses for each in verdicts], count):
        outcome, deciding = deciding_verdicts(
            _Decided(each.layer, STATUSES[each.statuses[places[0]]], each) for each in verdicts
        )
        yield places, outcome, [each.verdicts for each in deciding]


def _put_narrowest_margins(columns: ResultColumns, verdicts: Sequence[BlockVerdicts]) -> None:
    """Set the smallest margins, of equal ones that of the first id; checks of the rig have no part in it."""
    margins, criteria = columns.margins, columns.criteria
    found = np.zeros(margins.size, bool)
    for each in (verdict for verdict in verdicts if verdict.layer != "rig"):
        is_less = (each.margins < margins) | ((each.margins == margins) & (each.id < criteria))
        smaller = each.has_margin & (~found | is_less.astype(bool))
        margins[smaller], criteria[smaller] = each.margins[smaller], each.id
        found |= each.has_margin


def _stop_columns(
    stops: StopBlock, definition: Mapping[str, float]
) -> Iterator[tuple[str, NDArray[np.float64]]]:
    for name, column in STOP_COLUMNS.items():
        numbers = np.full(stops.measures.size, np.nan)
        for places, found in by_way(
            lambda places, column=column: column.read(stops.stops_at(places), definition),  # type: ignore[misc]
            lambda place, column=column: column.read(stops.records(place)[0], definition),  # type: ignore[misc]
            np.arange(stops.measures.size),
        ):
            numbers[places] = found
        yield name, _in_unit_of(column, numbers)


def _wheelset_columns(stops: StopBlock) -> Iterator[tuple[str, NDArray[np.float64]]]:
    wheelsets = stops.wheelset_measures.reshape(-1)
    wheelsets_at = ensembles_of(wheelsets)
    for name, column in WHEELSET_COLUMNS.items():
        numbers = np.full(wheelsets.size, np.nan)
        for places, found in by_way(
            lambda places, column=column: column.read(wheelsets_at(places)),  # type: ignore[misc]
            lambda place, column=column: column.read(_Wheelset(*wheelsets[place].tolist())),  # type: ignore[misc]
            np.arange(wheelsets.size),
        ):
            numbers[places] = found
        yield name, _in_unit_of(column, numbers).reshape(stops.wheelset_measures.shape)


def _in_unit_of(column: StopColumn | WheelsetColumn, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    values: Any = in_unit(numbers, column.unit)  # type: ignore[arg-type]
    return np.asarray(np.trunc(values) if column.whole else values)

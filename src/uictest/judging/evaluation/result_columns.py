"""The results of a block of cases as columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.ensemble import Places
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging.evaluation.block_verdicts import WHEELSET_COUNT
from uictest.judging.evaluation.json_values import Expectation, Outcome
from uictest.judging.evaluation.repeats import is_expected
from uictest.judging.evaluation.result import CaseResult, narrowest_margin


@dataclass(frozen=True)
class ResultColumns:
    """What the results of n cases say, without their verdicts.

    `outcomes`, `expectations`, `reasons` and `criteria` (of the narrowest margin) hold texts; `margins`,
    `measures` (column of stops -> shape (n,)) and `wheelsets` (column of wheelsets -> (n, 4)) are NaN where
    there is no number. `near_limit` says where a criterion may have been decided by the bias of its measure;
    so it may where a case was not judged with others.
    """

    outcomes: NDArray[Any]
    expectations: NDArray[Any]
    reasons: NDArray[Any]
    met: NDArray[np.bool_]
    margins: NDArray[np.float64]
    criteria: NDArray[Any]
    near_limit: NDArray[np.bool_]
    measures: dict[str, NDArray[np.float64]]
    wheelsets: dict[str, NDArray[np.float64]]

    def put(self, place: int, result: CaseResult) -> None:
        """Set the result of one case."""
        places = np.array([place])
        self.put_outcome(places, result.outcome, result.expect)
        self.reasons[place] = result.reason
        margin, self.criteria[place] = narrowest_margin(result)
        self.margins[place] = np.nan if margin is None else margin
        for name, number in (result.measures or {}).items():
            self.measures[name][place] = number
        for wheelset, columns in enumerate(result.wheelsets):
            for name, number in columns.items():
                self.wheelsets[name][place, wheelset] = number

    def put_outcome(self, places: Places, outcome: Outcome, expect: Expectation) -> None:
        """Set the outcome of some cases, and whether it is the expected one."""
        self.outcomes[places], self.expectations[places] = outcome, expect
        self.met[places] = is_expected(outcome, expect)

    def put_block(self, places: Places, columns: ResultColumns) -> None:
        """Set the results of several cases."""
        for name in ("outcomes", "expectations", "reasons", "met", "margins", "criteria", "near_limit"):
            getattr(self, name)[places] = getattr(columns, name)
        for name in ("measures", "wheelsets"):
            for column, numbers in getattr(columns, name).items():
                getattr(self, name)[column][places] = numbers


def joined(parts: Sequence[tuple[Places, ResultColumns]], count: int) -> ResultColumns:
    """Return the results of n cases from those of the cases at some places each."""
    if len(parts) == 1 and parts[0][0].size == count:
        return parts[0][1]
    columns = result_columns(count)
    for places, part in parts:
        columns.put_block(places, part)
    return columns


def result_columns(count: int) -> ResultColumns:
    """Return columns for n cases, to be filled."""
    return ResultColumns(
        outcomes=np.full(count, "", object),
        expectations=np.full(count, "", object),
        reasons=np.full(count, "", object),
        met=np.zeros(count, bool),
        margins=np.full(count, np.nan),
        criteria=np.full(count, "", object),
        near_limit=np.ones(count, bool),
        measures={name: np.full(count, np.nan) for name in STOP_COLUMNS},
        wheelsets={name: np.full((count, WHEELSET_COUNT), np.nan) for name in WHEELSET_COLUMNS},
    )

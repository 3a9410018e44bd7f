"""Which cases of a sweep lie outside of what was validated, computed by column from its rows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis import validation
from uictest.judging.evaluation import Deviation, effective_parts
from uictest.plans.sweeps import Plan
from uictest.report import OutsideCount, SweepDomain
from uictest.running.chunked import number_column, text_column

if TYPE_CHECKING:
    import pyarrow as pa

OUTSIDE: Final = "outside"
"""Column of the summary: keys of what lies outside, separated by blanks; empty where all is inside."""
_FRICTION: Final = "rail.friction"
_FRICTION_OF_CONDITION: Final = "rail.condition.friction"
_OVER_TIME: Final = "rail.friction_over_time"
_MOST_KNOWN: Final = 1000
"""Groups whose conditions, some ten kilobytes each, are kept: drawn values may give each case its own."""

_Masks = dict[str, NDArray[np.bool_]]
"""Key of a condition -> mask of the rows in which it lies outside."""


class DomainTally:
    """Counts the cases outside of a validation, chunk by chunk."""

    def __init__(self, plan: Plan, reference: validation.ValidationReference) -> None:
        self._conditions = _ConditionsOfCases(plan)
        self._reference = reference
        self._counts: dict[tuple[object, ...], OutsideCount] = {}
        self._outside = 0

    def with_column(self, table: pa.Table) -> pa.Table:
        """Count the rows of a chunk, and return it with the column of what lies outside."""
        import pyarrow as pa

        masks = self._outside_masks(table)
        texts = _outside_texts(masks, table.num_rows)
        self._outside += sum(map(bool, texts))
        return table.append_column(OUTSIDE, pa.array(texts, pa.string()))

    def result(self) -> SweepDomain:
        """Return the counts, that of most cases first."""
        counts = sorted(self._counts.values(), key=lambda each: -each.cases)
        name, sha256 = self._reference.validation.name, self._reference.sha256
        return SweepDomain(name, sha256, self._outside, tuple(counts))

    def _outside_masks(self, table: pa.Table) -> _Masks:
        domains = self._reference.validation.domains
        masks: _Masks = {}
        for rows, conditions, columns in self._conditions.groups(table):
            for each in validation.deviations_of_stops(domains, rows.size, conditions, columns):
                key = each.deviation.key
                masks.setdefault(key, np.zeros(table.num_rows, bool))[rows[each.stops]] = True
                self._count_deviation(each.deviation, int(each.stops.sum()))
        return masks

    def _count_deviation(self, deviation: Deviation, cases: int) -> None:
        """Add the cases of one deviation; numbers beyond the same bounds are one condition."""
        found, validated = deviation.found, deviation.validated
        key = deviation.key, validated, found if isinstance(found, str) else None
        counted = self._counts.get(key)
        if counted is not None:
            cases, deviation = cases + counted.cases, _spanning_deviation(counted.deviation, deviation)
        self._counts[key] = OutsideCount(cases, deviation)


class _ConditionsOfCases:
    """The conditions of the cases of a plan, in groups that are alike but for numbers."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._known: dict[tuple[str, ...], validation.Conditions] = {}
        # A key of one car of a train is not a condition by its name.
        keys = [key for key in plan.keys if plan.own_keys or validation.is_condition(key)]
        first = self._conditions_of_case(0)
        numeric = () if plan.own_keys else plan.numeric_keys
        pairs = {key: self._number_of(key, first) for key in keys if key in numeric}
        self._numbers = {key: number for key, number in pairs.items() if number is not None}
        self._others = [key for key in keys if key not in self._numbers]

    def groups(
        self, table: pa.Table
    ) -> Iterator[tuple[NDArray[np.int64], validation.Conditions, validation.Columns]]:
        """Yield rows of a chunk, the conditions of one of them, and numbers in which the others differ."""
        indices = table.column("index").to_numpy()
        numbers = {
            number: table.column(number_column(key)).to_numpy() for key, number in self._numbers.items()
        }
        for texts, rows in self._rows_by_texts(table).items():
            conditions = self._known.get(texts)
            if conditions is None:
                conditions = self._conditions_of_case(int(indices[rows[0]]))
                if len(self._known) < _MOST_KNOWN:
                    self._known[texts] = conditions
            yield rows, conditions, {key: values[rows] for key, values in numbers.items()}

    def _rows_by_texts(self, table: pa.Table) -> dict[tuple[str, ...], NDArray[np.int64]]:
        """Return the rows with the same values of everything that is not a number by itself."""
        if not self._others:
            return {(): np.arange(table.num_rows)}
        columns = [table.column(text_column(key)).to_pylist() for key in self._others]
        rows: dict[tuple[str, ...], list[int]] = {}
        for row, texts in enumerate(zip(*columns, strict=True)):
            rows.setdefault(texts, []).append(row)
        return {texts: np.array(text_rows) for texts, text_rows in rows.items()}

    def _conditions_of_case(self, index: int) -> validation.Conditions:
        return validation.conditions_of(effective_parts(self._plan.cases(np.array([index]))[0].scenario))

    def _number_of(self, key: str, conditions: validation.Conditions) -> str | None:
        """Return the key of the condition that this number alone sets; None where there is none."""
        rail = self._plan.base.scenario.rail
        if key in (_FRICTION, _FRICTION_OF_CONDITION):
            varied = any(f"{each}.".startswith(f"{_OVER_TIME}.") for each in self._plan.keys)
            over_time = varied or rail.friction_over_time is not None
            is_stated = rail.friction is not None or _FRICTION in self._plan.keys
            covered = is_stated and key == _FRICTION_OF_CONDITION
            return None if over_time or covered else _FRICTION
        return key if key in conditions.ranges else None


def _spanning_deviation(first: Deviation, second: Deviation) -> Deviation:
    """Return a deviation whose numbers span those of both; texts are the same."""
    if not isinstance(first.found, tuple) or not isinstance(second.found, tuple):
        return first
    span = min(first.found[0], second.found[0]), max(first.found[1], second.found[1])
    return replace(first, found=span)


def _outside_texts(masks: Mapping[str, NDArray[np.bool_]], rows: int) -> Sequence[str]:
    if not masks:
        return [""] * rows
    keys = list(masks)
    patterns, pattern_of = np.unique(np.column_stack(list(masks.values())), axis=0, return_inverse=True)
    texts = [
        " ".join(key for key, is_outside in zip(keys, pattern, strict=True) if is_outside)
        for pattern in patterns
    ]
    return [texts[index] for index in pattern_of.ravel().tolist()]

"""Rows of a sweep: one per case, as an Arrow table whose columns are known from the plan."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.units import SIZES
from uictest.judging.evaluation import ResultColumns
from uictest.plans.sweeps import REGULAR_STEP, SURVEY_STEP, Plan
from uictest.running.chunked.case_blocks import CaseBlock

if TYPE_CHECKING:
    import pyarrow as pa

WHEELSETS: Final = 4
_OWN: Final = ("expect", "outcome", "reason")
TIME_STEP_COLUMN: Final = "time_step_ms"
"""Column of a survey: the step that the case was simulated in in the end."""
REPEATED_TEXTS: Final = (*_OWN, "narrowest_criterion")
"""Columns whose texts recur from case to case; to look for numbers that do takes half of writing."""


def text_column(key: str) -> str:
    """Return the name of the column with a parameter as written."""
    return f"parameters.{key}"


def number_column(key: str) -> str:
    """Return the name of the column with a parameter in SI units."""
    return f"values.{key}"


def measure_columns() -> list[str]:
    """Return the columns of measures: those of the stop, then those of each wheelset."""
    return [
        *STOP_COLUMNS,
        *(column for name in WHEELSET_COLUMNS for column in wheelset_columns(name)),
    ]


def wheelset_columns(name: str) -> tuple[str, ...]:
    """Return the columns of a measure of wheelsets, leading wheelset first."""
    return tuple(f"{name}_{k}" for k in _numbers())


def row_schema(plan: Plan) -> pa.Schema:
    """Return names and types of the columns, in order."""
    return _schema(plan.keys, plan.numeric_keys, plan.survey)


@cache
def _schema(keys: tuple[str, ...], numeric_keys: tuple[str, ...], survey: bool) -> pa.Schema:
    import pyarrow as pa

    text, number = pa.string(), pa.float64()
    return pa.schema(
        [
            ("index", pa.int64()),
            ("id", text),
            *((text_column(key), text) for key in keys),
            *((number_column(key), number) for key in numeric_keys),
            *((name, text) for name in _OWN),
            ("met", pa.bool_()),
            *([(TIME_STEP_COLUMN, number)] if survey else []),
            ("narrowest_margin", number),
            ("narrowest_criterion", text),
            *((name, number) for name in measure_columns()),
        ]
    )


def rows(plan: Plan, block: CaseBlock, results: ResultColumns) -> pa.Table:
    """Return the rows of a block; a measure without a value is null."""
    import pyarrow as pa

    columns: dict[str, Any] = {"index": block.indices, "id": block.ids}
    for key, column in block.settings.items():
        columns[text_column(key)] = column.written
    for key in plan.numeric_keys:
        columns[number_column(key)] = block.settings[key].numbers
    columns |= {"expect": results.expectations, "outcome": results.outcomes, "reason": results.reasons}
    columns |= {"met": results.met, "narrowest_margin": results.margins}
    columns["narrowest_criterion"] = results.criteria
    if plan.survey:
        steps = np.where(results.near_limit, REGULAR_STEP, SURVEY_STEP)
        columns[TIME_STEP_COLUMN] = steps / SIZES["ms"]
    columns |= results.measures
    for name, numbers in results.wheelsets.items():
        columns |= zip(wheelset_columns(name), numbers.T, strict=True)
    schema = row_schema(plan)
    return pa.table([pa.array(columns[each.name], each.type, from_pandas=True) for each in schema], schema)


def repeated_cases(table: pa.Table) -> int:
    """Return how many cases of a survey were simulated in regular steps in the end; else none."""
    if TIME_STEP_COLUMN not in table.column_names:
        return 0
    steps = table.column(TIME_STEP_COLUMN).to_numpy()
    return int(np.count_nonzero(steps == REGULAR_STEP / SIZES["ms"]))


def _numbers() -> range:
    return range(1, WHEELSETS + 1)

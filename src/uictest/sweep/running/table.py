"""Rows of a sweep: one per case, as an Arrow table whose columns are known from the plan."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

from uictest.evaluation import CaseResult, narrowest_margin
from uictest.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.sweep.plan.plan import ListedGroup, Plan, is_numeric
from uictest.sweep.running.case_blocks import CaseBlock

if TYPE_CHECKING:
    import pyarrow as pa

WHEELSETS: Final = 4
_OWN: Final = ("expect", "outcome", "reason")


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


def numeric_keys(plan: Plan) -> list[str]:
    """Return the parameters whose values are numbers."""
    keys: list[str] = []
    for group in plan.groups:
        for place, key in enumerate(group.keys):
            if isinstance(group, ListedGroup):
                values: Sequence[Any] = [row[place] for row in group.rows]
            else:
                values = group.draws[place].choices
            if is_numeric(values):
                keys.append(key)
    return keys


def row_schema(plan: Plan) -> pa.Schema:
    """Return names and types of the columns, in order."""
    import pyarrow as pa

    text, number = pa.string(), pa.float64()
    return pa.schema(
        [
            ("index", pa.int64()),
            ("id", text),
            *((text_column(key), text) for key in plan.keys),
            *((number_column(key), number) for key in numeric_keys(plan)),
            *((name, text) for name in _OWN),
            ("met", pa.bool_()),
            ("narrowest_margin", number),
            ("narrowest_criterion", text),
            *((name, number) for name in measure_columns()),
        ]
    )


def rows(plan: Plan, block: CaseBlock, results: Sequence[CaseResult]) -> pa.Table:
    """Return the rows of a block; a measure without a value is null."""
    import pyarrow as pa

    columns: dict[str, Any] = {"index": block.indices, "id": block.ids}
    for key, values in block.settings.items():
        columns[text_column(key)] = [value.text for value in values]
    for key in numeric_keys(plan):
        columns[number_column(key)] = [value.number for value in block.settings[key]]
    for name in (*_OWN, "met"):
        columns[name] = [getattr(result, name) for result in results]
    margins = zip(*map(narrowest_margin, results), strict=True)
    columns["narrowest_margin"], columns["narrowest_criterion"] = margins
    columns.update(zip(measure_columns(), zip(*map(_measures, results), strict=True), strict=True))
    arrays = [pa.array(columns[column.name], column.type, from_pandas=True) for column in row_schema(plan)]
    return pa.table(arrays, schema=row_schema(plan))


def _measures(result: CaseResult) -> Iterator[float | None]:
    of_stop, of_wheelsets = result.measures or {}, result.wheelsets or ({},) * WHEELSETS
    yield from (of_stop.get(name) for name in STOP_COLUMNS)
    for name in WHEELSET_COLUMNS:
        yield from (wheelset.get(name) for wheelset in of_wheelsets)


def _numbers() -> range:
    return range(1, WHEELSETS + 1)

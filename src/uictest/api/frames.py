"""Tables of reports as data frames."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from uictest import report
from uictest.core import measures

if TYPE_CHECKING:
    import pandas as pd


def frame_of(table: report.Table, index: Sequence[str]) -> pd.DataFrame:
    """Return a table as a data frame with the units of its columns in `attrs["units"]`.

    Columns of numbers are 64-bit floats (NaN: no number), or integers and booleans where every row has one.
    Texts are as written.
    """
    import pandas as pd

    names = table.columns or index  # a table without rows may have no columns
    columns = {name: _column([row.get(name) for row in table.rows]) for name in names}
    frame = pd.DataFrame(columns, columns=list(names)).set_index(list(index))
    return with_units(frame)


def with_units(frame: pd.DataFrame) -> pd.DataFrame:
    """Add the units of the columns that hold measures."""
    frame.attrs["units"] = column_units(map(str, frame.columns))
    return frame


def column_units(names: Iterable[str]) -> dict[str, str]:
    """Return the unit of each column that holds a measure, `1` for a pure number."""
    known = {*measures.STOP_COLUMNS, *measures.WHEELSET_COLUMNS}
    stems = {name: _stem(name) for name in names}
    return {name: measures.column_unit(stem) for name, stem in stems.items() if stem in known}


def _stem(name: str) -> str:
    """Return the measure of a column, which may be of one wheelset or an end of a range."""
    stem, _, last = name.rpartition("_")
    return stem if last.isdigit() or last in ("lowest", "highest") else name


def _column(values: Sequence[Any]) -> Any:
    import numpy as np

    kinds = {type(value) for value in values}
    if not values or str in kinds:
        return np.array(values, object)
    if kinds in ({bool}, {int}):
        return np.array(values)
    return np.array([np.nan if value is None else value for value in values], float)

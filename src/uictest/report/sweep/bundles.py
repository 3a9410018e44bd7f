"""A map of a sweep made small enough to be read: neighbouring values are shown together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_SHOWN: Final = 24
"""Rows or columns of a map that a reader takes in."""


def bundled(found: Mapping[str, Any], most: int = MOST_SHOWN) -> dict[str, Any]:
    """Return a map of `sweep.json` with at most `most` rows and columns, in the form it came in.

    A cell that stands for several has their cases; its mean is that of the cases in all of them.
    """
    import numpy as np

    if not is_large(found, most):
        return dict(found)
    rows, columns = (_firsts(len(found[axis]["values"]), most) for axis in ("rows", "columns"))
    cases, met = (np.array(found[name], np.int64) for name in ("cases", "met"))
    means = np.array(found["means"], float)
    known = np.where(np.isfinite(means), cases, 0)
    sums, counts = (_summed(each, rows, columns) for each in (np.nan_to_num(means) * known, known))
    return {
        "measure": found["measure"],
        "rows": _bundled_axis(found["rows"], rows),
        "columns": _bundled_axis(found["columns"], columns),
        "means": [
            [total / count if count else None for total, count in zip(*row, strict=True)]
            for row in zip(sums.tolist(), counts.tolist(), strict=True)
        ],
        "met": _summed(met, rows, columns).tolist(),
        "cases": _summed(cases, rows, columns).tolist(),
    }


def is_large(found: Mapping[str, Any], most: int = MOST_SHOWN) -> bool:
    """Return whether a map has more rows or columns than `most`."""
    return any(len(found[axis]["values"]) > most for axis in ("rows", "columns"))


def _firsts(values: int, most: int) -> list[int]:
    return list(range(0, values, -(-values // most)))


def _bundled_axis(axis: Mapping[str, Any], firsts: Sequence[int]) -> dict[str, Any]:
    values = axis["values"]
    ends = [*firsts[1:], len(values)]
    labels = [
        values[first] if end == first + 1 else f"{values[first]} … {values[end - 1]}"
        for first, end in zip(firsts, ends, strict=True)
    ]
    return {"parameter": axis["parameter"], "values": labels}


def _summed(values: NDArray[Any], rows: Sequence[int], columns: Sequence[int]) -> NDArray[Any]:
    import numpy as np

    return np.add.reduceat(np.add.reduceat(values, rows, axis=0), columns, axis=1)

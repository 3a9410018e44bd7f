"""A map of a sweep folded to few rows and columns, and as lines of text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from uictest.report.sweep.result import MapAxis, SweepMap
from uictest.report.sweep.values import DrawnInterval, SweptValue, range_label

if TYPE_CHECKING:
    from numpy.typing import NDArray


MOST_SHOWN: Final = 24
"""Most rows or columns of a map that is read as a whole."""

Fold = list[range]
"""Places of the values that share a row or a column."""


@dataclass(frozen=True, slots=True)
class FoldedMap:
    """A map whose rows and columns stand for one or more neighbouring values; cells as in the map."""

    rows: list[Sequence[SweptValue]]
    columns: list[Sequence[SweptValue]]
    means: list[list[float | None]]
    met: list[list[int]]
    cases: list[list[int]]


def fold(values: int, most: int) -> Fold:
    """Return the places of so many values in at most `most` groups, all but the last of the same size."""
    size = -(-values // most)
    return [range(first, min(first + size, values)) for first in range(0, values, size)]


def is_large(sweep_map: SweepMap) -> bool:
    """Return whether a map has more rows or columns than are shown."""
    return any(len(axis.values) > MOST_SHOWN for axis in (sweep_map.rows, sweep_map.columns))


def folded(sweep_map: SweepMap, most_rows: int = MOST_SHOWN, most_columns: int | None = None) -> FoldedMap:
    """Return a map with at most so many rows and columns (`most_rows` of both unless stated otherwise).

    A cell that stands for several has their cases; its mean is that of the cases in all of them.
    """
    rows = fold(len(sweep_map.rows.values), most_rows)
    columns = fold(len(sweep_map.columns.values), most_columns or most_rows)
    row_values, column_values = (
        [axis.values[places.start : places.stop] for places in groups]
        for axis, groups in ((sweep_map.rows, rows), (sweep_map.columns, columns))
    )
    means, met, cases = sweep_map.means, sweep_map.met, sweep_map.cases
    if len(rows) < len(sweep_map.rows.values) or len(columns) < len(sweep_map.columns.values):
        means = _folded_means(sweep_map, rows, columns)
        met, cases = (_summed(counts, rows, columns).tolist() for counts in (met, cases))
    return FoldedMap(list(row_values), list(column_values), means, met, cases)


def _folded_means(sweep_map: SweepMap, rows: Fold, columns: Fold) -> list[list[float | None]]:
    import numpy as np

    means = np.array(sweep_map.means, float)
    known = np.where(np.isfinite(means), sweep_map.known or sweep_map.cases, 0)
    sums = _summed(np.nan_to_num(means) * known, rows, columns)
    counts = _summed(known, rows, columns)
    return [
        [total / count if count else None for total, count in zip(*row, strict=True)]
        for row in zip(sums.tolist(), counts.tolist(), strict=True)
    ]


def _summed(cells: Any, rows: Fold, columns: Fold) -> NDArray[Any]:
    import numpy as np

    by_row = np.add.reduceat(np.asarray(cells), [places.start for places in rows], axis=0)
    return np.add.reduceat(by_row, [places.start for places in columns], axis=1)


def short_label(values: Sequence[SweptValue]) -> str:
    """Return the label of the values of a row or a column, e.g. `0.10 … 0.14`."""
    first, last = values[0].label, values[-1].label
    return first if len(values) == 1 else f"{first} … {last}"


_SIGNS: Final = "#123456789."
_GAP: Final = "  "


def map_lines(sweep_map: SweepMap, width: int | None) -> Iterator[str]:
    """Yield the map in lines of at most `width` characters, None for any width.

    A row or column that stands for several values is labelled by its first and its last value.
    """
    shown, table = _fitted(sweep_map, width)
    what = "share met (# none, 1-9 tenths, . all)" if sweep_map.shows_met else f"mean {sweep_map.measure}"
    yield f"{what}: {sweep_map.rows.parameter} down, {sweep_map.columns.parameter} across"
    yield from _fold_note(sweep_map, shown)
    yield from table


def _fitted(sweep_map: SweepMap, width: int | None) -> tuple[FoldedMap, list[str]]:
    """Return the map with as many columns as fit, and its lines."""
    for most_columns in range(min(MOST_SHOWN, len(sweep_map.columns.values)), 0, -1):
        shown = folded(sweep_map, MOST_SHOWN, most_columns)
        table = list(_table(shown, shows_met=sweep_map.shows_met))
        if width is None or max(map(len, table)) <= width:
            break
    return shown, table


def _fold_note(sweep_map: SweepMap, shown: FoldedMap) -> Iterator[str]:
    axes: tuple[tuple[MapAxis, int, str], ...] = (
        (sweep_map.rows, len(shown.rows), "rows"),
        (sweep_map.columns, len(shown.columns), "columns"),
    )
    notes = [
        f"{len(axis.values)} values of {axis.parameter} in {count} {name}"
        for axis, count, name in axes
        if count < len(axis.values)
    ]
    if notes:
        yield f"folded: {', '.join(notes)}; map-{sweep_map.measure}.csv has every value"


def _table(shown: FoldedMap, *, shows_met: bool) -> Iterator[str]:
    cells = [
        ["" if mean is None else _share_sign(mean) if shows_met else f"{mean:.4g}" for mean in row]
        for row in shown.means
    ]
    labels = [range_label(values) for values in shown.rows]
    heads = list(zip(*map(_column_head, shown.columns), strict=True))
    lines = [("", head) for head in heads if any(head)] + list(zip(labels, cells, strict=True))
    widths = [max(map(len, column)) for column in zip(*(row for _, row in lines), strict=True)]
    margin = max(map(len, labels))
    for label, row in lines:
        line = [f"{label:>{margin}}", *(f"{cell:>{size}}" for cell, size in zip(row, widths, strict=True))]
        yield _GAP.join(line).rstrip()


def _column_head(values: Sequence[SweptValue]) -> tuple[str, str]:
    """Return the two lines above a column: its first value, and its last where that is another."""
    first, last = values[0], values[-1]
    if isinstance(first, DrawnInterval) and isinstance(last, DrawnInterval):
        return first.low_text, f".. {last.high_text}"
    return first.label, "" if len(values) == 1 else f".. {last.label}"


def _share_sign(share: float) -> str:
    # Only what is whole is shown as whole: one case of a thousand that misses must be seen.
    return _SIGNS[0 if share == 0.0 else 10 if share == 1.0 else min(max(round(10.0 * share), 1), 9)]

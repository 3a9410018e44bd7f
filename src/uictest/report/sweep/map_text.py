"""A map of a sweep as lines of text, folded to the width of the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from uictest.report.sweep.folding import MOST_SHOWN, FoldedMap, folded
from uictest.report.sweep.result import MapAxis, SweepMap
from uictest.report.sweep.values import DrawnInterval, SweptValue, range_label

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
    cell_text = _share_sign if shows_met else _mean_text
    cells = [[cell_text(mean) for mean in row] for row in shown.means]
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


def _mean_text(mean: float | None) -> str:
    return "" if mean is None else f"{mean:.4g}"


def _share_sign(share: float | None) -> str:
    if share is None:
        return ""
    # Only what is whole is shown as whole: one case of a thousand that misses must be seen.
    return _SIGNS[0 if share == 0.0 else 10 if share == 1.0 else min(max(round(10.0 * share), 1), 9)]

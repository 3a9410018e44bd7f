"""The maps of a sweep on one sheet, one below the other, each with a colour scale of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from uictest.report.sheet import Styles, width, write_cell
from uictest.report.sweep.folding import FoldedMap, folded, is_large, short_label
from uictest.report.sweep.result import SweepMap

if TYPE_CHECKING:
    from xlsxwriter.worksheet import Worksheet

MOST_CELLS: Final = 200
"""Rows or columns of one map; beyond that neighbours are shown together, and map-*.csv has each."""

_SHARE: Final = {
    "type": "3_color_scale",
    "min_type": "num",
    "mid_type": "num",
    "max_type": "num",
    "min_value": 0.0,
    "mid_value": 0.5,
    "max_value": 1.0,
    # Readers with red-green deficiency can distinguish orange from blue.
    "min_color": "#f0a868",
    "mid_color": "#f7f7f7",
    "max_color": "#8fbfe0",
}
_MEAN: Final = {"type": "2_color_scale", "min_color": "#ffffff", "max_color": "#9c8fc8"}


def write_maps(sheet: Worksheet, maps: Sequence[SweepMap], styles: Styles) -> None:
    """Write the maps: cases met as a share of one, measures as their mean."""
    first = 0
    for sweep_map in maps:
        shown = folded(sweep_map, MOST_CELLS)
        write_cell(sheet, first, 0, _title(sweep_map), styles["header"])
        _write_cells(sheet, first + 1, shown, styles)
        scale = _SHARE if sweep_map.shows_met else _MEAN
        sheet.conditional_format(first + 2, 1, first + 1 + len(shown.rows), len(shown.columns), scale)
        first += len(shown.rows) + 3
    labels = [value.label for sweep_map in maps for value in sweep_map.rows.values]
    sheet.set_column(0, 0, width(_title(maps[0]), labels))


def _title(sweep_map: SweepMap) -> str:
    what = "share of cases met" if sweep_map.shows_met else f"mean {sweep_map.measure}"
    together = "; neighbouring values together" if is_large(sweep_map, MOST_CELLS) else ""
    return f"{what}: {sweep_map.rows.parameter} down, {sweep_map.columns.parameter} across{together}"


def _write_cells(sheet: Worksheet, first: int, shown: FoldedMap, styles: Styles) -> None:
    """Write the labels in the row `first`, and the cells below it."""
    for column, values in enumerate(shown.columns, start=1):
        write_cell(sheet, first, column, short_label(values), styles["header"])
    for row, (values, means) in enumerate(zip(shown.rows, shown.means, strict=True), start=first + 1):
        for column, value in enumerate((short_label(values), *means)):
            write_cell(sheet, row, column, value, None if column else styles["header"])

"""The maps of a sweep on one sheet, one below the other, each with a colour scale of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from uictest.report.sheet import Styles, width, write_cell
from uictest.report.sweep.bundles import bundled, is_large

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
    # Orange to blue is told apart by readers who do not see red and green apart.
    "min_color": "#f0a868",
    "mid_color": "#f7f7f7",
    "max_color": "#8fbfe0",
}
_FIGURE: Final = {"type": "2_color_scale", "min_color": "#ffffff", "max_color": "#9c8fc8"}


def write_maps(sheet: Worksheet, maps: Sequence[Mapping[str, Any]], styles: Styles) -> None:
    """Write the maps: share of cases met as a share of one, figures as their mean."""
    first = 0
    for found in maps:
        shown = bundled(found, MOST_CELLS)
        write_cell(sheet, first, 0, _title(found), styles["header"])
        _write_cells(sheet, first + 1, shown, styles)
        first += len(shown["rows"]["values"]) + 3
    labels = [label for found in maps for label in found["rows"]["values"]]
    sheet.set_column(0, 0, width(_title(maps[0]), labels))


def _title(found: Mapping[str, Any]) -> str:
    what = "share of cases met" if found["measure"] == "met" else f"mean {found['measure']}"
    down, across = (found[axis]["parameter"] for axis in ("rows", "columns"))
    together = "; neighbouring values together" if is_large(found, MOST_CELLS) else ""
    return f"{what}: {down} down, {across} across{together}"


def _write_cells(sheet: Worksheet, first: int, shown: Mapping[str, Any], styles: Styles) -> None:
    """Write the labels in the row `first`, and the cells below it."""
    across, down = (shown[axis]["values"] for axis in ("columns", "rows"))
    for column, label in enumerate(across, start=1):
        write_cell(sheet, first, column, label, styles["header"])
    for row, (label, means) in enumerate(zip(down, shown["means"], strict=True), start=first + 1):
        for column, value in enumerate((label, *means)):
            write_cell(sheet, row, column, value, None if column else styles["header"])
    scale = _SHARE if shown["measure"] == "met" else _FIGURE
    sheet.conditional_format(first + 1, 1, first + len(down), len(across), scale)

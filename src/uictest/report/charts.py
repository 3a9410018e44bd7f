"""Charts of a workbook, drawn by the spreadsheet from the cells of its sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from uictest.report.csv_text import Cell
from uictest.report.escaping import printable

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.chart import Chart

_WIDTH, _HEIGHT, _HEIGHT_OF_A_BAR = 620, 300, 16  # pixels
_BLUE, _ORANGE, _GREY = "#2f6db3", "#d0701c", "#5a6472"
_COLOURS: Final = {"good": _BLUE, "bad": _ORANGE, "odd": _GREY}
_TALLEST: Final = 1600
_GRID: Final = {"visible": True, "line": {"color": "#d9dee5", "width": 0.5}}
_FONT: Final = {"name_font": {"size": 9, "bold": False}, "num_font": {"size": 8}}


@dataclass(frozen=True, slots=True)
class Cells:
    """Cells below each other in one column of a sheet; rows and columns are counted from 0.

    `shown` is what they hold, for programs that draw a chart without computing the sheet; of a sheet that is
    streamed the library cannot read it back.
    """

    sheet: str
    column: int
    first: int
    last: int
    shown: Sequence[Cell] | None = None

    @property
    def reference(self) -> list[str | int]:
        """The cells as the library names them."""
        return [self.sheet, self.first, self.column, self.last, self.column]

    @property
    def cached(self) -> list[Cell] | None:
        """What the cells hold as the library takes it: nothing is an empty text."""
        return None if self.shown is None else [_cached(each) for each in self.shown]


@dataclass(frozen=True, slots=True)
class Plotted:
    """Cells that a chart plots, their name in the legend, and their tone: `good`, `bad` or `odd`."""

    name: str
    values: Cells
    tone: str = "good"


def bar_chart(
    workbook: Workbook, title: str, names: Cells, plotted: Plotted, value_axis: dict[str, Any]
) -> Chart:
    """Return a chart with a bar across for each name, from above; negative ones coloured as misses."""
    chart = workbook.add_chart({"type": "bar"})
    chart.add_series(
        _series(names, plotted) | {"gap": 40, "invert_if_negative": True, "invert_if_negative_color": _ORANGE}
    )
    _finish(chart, title, legend=False)
    # The library calls the axis of the names y here, as it stands upright.
    chart.set_y_axis({**_FONT, "reverse": True, "label_position": "low"})
    chart.set_x_axis({**_FONT, "major_gridlines": _GRID, "label_position": "high", **value_axis})
    chart.set_size({"width": _WIDTH, "height": height_of_bars(names.last - names.first + 1)})
    return chart


def height_of_bars(bars: int) -> int:
    """Return the height of a chart with so many bars across, pixels."""
    return min(max(_HEIGHT, 80 + _HEIGHT_OF_A_BAR * bars), _TALLEST)


def histogram_chart(workbook: Workbook, title: str, bins: Cells, plotted: Sequence[Plotted]) -> Chart:
    """Return a chart with a column for each bin, in which the plotted stand on each other."""
    chart = workbook.add_chart({"type": "column", "subtype": "stacked"})
    for each in plotted:
        chart.add_series(_series(bins, each) | {"gap": 10})
    return _finish(chart, title, legend=len(plotted) > 1)


def line_chart(workbook: Workbook, title: str, values: Cells, plotted: Sequence[Plotted]) -> Chart:
    """Return a chart with a line over the values for each of the plotted, the first one strong."""
    chart = workbook.add_chart({"type": "line"})
    for number, each in enumerate(plotted):
        colour = _COLOURS[each.tone]
        line = {"color": colour, "width": 1.0, "dash_type": "dash"} if number else {"color": colour}
        chart.add_series(
            _series(values, each)
            | {"line": line, "marker": {"type": "circle", "size": 4, "fill": {"color": colour}}}
        )
    return _finish(chart, title, legend=len(plotted) > 1)


def _series(categories: Cells, plotted: Plotted) -> dict[str, Any]:
    return {
        "name": _no_reference(plotted.name),
        "categories": categories.reference,
        "categories_data": categories.cached,
        "values": plotted.values.reference,
        "values_data": plotted.values.cached,
        "fill": {"color": _COLOURS[plotted.tone]},
    }


def _finish(chart: Chart, title: str, *, legend: bool) -> Chart:
    chart.set_title({"name": _no_reference(title), "name_font": {"size": 11, "bold": True}})
    chart.set_x_axis({**_FONT, "label_position": "low"})
    chart.set_y_axis({**_FONT, "major_gridlines": _GRID})
    chart.set_legend({"position": "bottom"} if legend else {"none": True})
    chart.show_blanks_as("gap")
    chart.set_size({"width": _WIDTH, "height": _HEIGHT})
    return chart


def _cached(cell: Cell) -> Cell:
    if isinstance(cell, str):
        return printable(cell)
    return cell if cell is not None and abs(cell) < float("inf") else ""


def _no_reference(text: str) -> str:
    """Return a text that the library does not take for the reference of a cell, which holds `!`."""
    return printable(text).replace("!", "! ")

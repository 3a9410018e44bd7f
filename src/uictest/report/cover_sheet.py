"""The first sheet of a run's workbook, and the charts that a spreadsheet draws from cells."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from uictest.core.document import Cell
from uictest.report.content import RunContent
from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.part_wording import notices
from uictest.report.series.series_sentences import series_word
from uictest.report.sheet import Row, Styles, heading_rows, print_on_a4, write_cell
from uictest.report.verdict_sentences import CASE_WORDS, tone

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.chart import Chart
    from xlsxwriter.format import Format
    from xlsxwriter.worksheet import Worksheet


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


COVER: Final = "Cover"
MOST_MISSED: Final = 20
"""Cases not as expected that the cover names; the sheet of cases has all."""

CONTENTS: Final = {
    "Series": "each series and its outcome",
    "Series criteria": "verdict of each criterion over the stops of a series",
    "Series measures": "each measure of a series with its confidence interval",
    "Series stops": "each stop of a series",
    "Cases": "outcome, parameters and measures of each case",
    "Wheelsets": "measures of each wheelset",
    "Criteria": "verdict of each criterion with value, limits and margin",
    "Repeats": "each stop of the cases that repeat theirs",
    "Requirements": "requirements down, cases across",
    "Baseline": "quantities that differ from the baseline",
    "Parts": "parts that each case was run with",
    "Parameters": "every parameter of these parts with its source",
    "Provenance": "versions, command and the SHA-256 of every input",
}
"""Sheet -> what it holds."""

Line = tuple[str | int, ...]
_WIDTHS: Final = (30, 16, 36)  # characters
_CHART_COLUMN = 4
_GAP = 20  # pixels


def write_cover(sheet: Worksheet, content: RunContent, sheets: Sequence[str], styles: Styles) -> None:
    """Write the cover of a workbook that has these other sheets."""
    write_cell(sheet, 0, 0, content.name, styles["title"])
    row = 2
    for heading, lines in _blocks(content, sheets).items():
        for line in [(heading,), *lines, ()] if lines else ():
            for place, cell in enumerate(line):
                write_cell(sheet, row, place, cell, _style(cell, line == (heading,), styles))
            row += 1
    for place, width in enumerate(_WIDTHS):
        sheet.set_column(place, place, width)
    print_on_a4(sheet)
    sheet.fit_to_pages(1, 0)


def insert_charts(workbook: Workbook, cover: Worksheet, columns: Sequence[str], cases: Iterable[Row]) -> None:
    """Draw distance and narrowest margin of every case beside the cover's text; nothing without cases.

    The charts refer to the sheet of cases: `columns` are its columns, `cases` its rows.
    """
    drawn = ("case", *(column for column, _, _ in _CHARTS))
    rows = [[row.get(name) for name in drawn] for row in cases]
    cells = dict(zip(drawn, zip(*rows, strict=True), strict=True)) if rows else {}
    top = heading_rows(columns)
    for number, (column, title, axis) in enumerate(_CHARTS):
        if any(cell is not None for cell in cells.get(column, ())):
            names, values = (
                Cells("Cases", columns.index(name), top, top + len(rows) - 1, cells[name])
                for name in ("case", column)
            )
            chart = bar_chart(workbook, title, names, Plotted(title, values), axis)
            below = number * height_of_bars(len(rows))
            cover.insert_chart(1, _CHART_COLUMN, chart, {"y_offset": below + _GAP * number})


_CHARTS: Final[tuple[tuple[str, str, dict[str, Any]], ...]] = (
    ("braking_distance_m", "Braking distance, m", {"num_format": "0", "min": 0}),
    (
        "narrowest_margin",
        "Narrowest margin of a case, share of its limit (axis: -100 .. 100 %)",
        {"num_format": "0 %", "min": -1, "max": 1},
    ),
)


def _blocks(content: RunContent, sheets: Sequence[str]) -> dict[str, list[Line]]:
    return {
        "Outcome": [(line,) for line in (content.tally, *notices(content.all_results))],
        "Cases": list(_counts(content)),
        "Not as expected": list(_missed(content)),
        "Sheets": [(name, CONTENTS.get(name, "")) for name in sheets],
        "Made by": list(_provenance(content)),
    }


def _counts(content: RunContent) -> Iterator[Line]:
    words = [content.word(result) for result in content.results]
    return ((word, words.count(word)) for word in CASE_WORDS if word in words)


def _missed(content: RunContent) -> Iterator[Line]:
    yield from ((each.id, series_word(each), each.reason) for each in content.series if not each.met)
    missed = [result for result in content.results if not content.passes(result)]
    for result in missed[:MOST_MISSED]:
        yield result.id, content.word(result), "; ".join(content.explanation(result))
    if len(missed) > MOST_MISSED:
        yield (f"and {counted(len(missed) - MOST_MISSED, 'case')} more on the sheet Cases",)


def _provenance(content: RunContent) -> Iterator[Line]:
    manifest = content.manifest
    if content.controllers:
        yield "WSP controller", content.controllers
    yield "uictest", manifest.versions.get("uictest", "")
    yield "command", shlex.join(manifest.command)
    yield "seed", "of each scenario" if manifest.seed is None else str(manifest.seed)
    yield "complete", "yes" if content.complete else "no: not all that was selected was run"


def _style(cell: str | int, heading: bool, styles: Styles) -> Format | None:
    if heading:
        return styles["header"]
    return styles["good" if tone(cell) == "good" else "bad"] if cell in CASE_WORDS else None

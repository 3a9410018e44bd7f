"""Rows on the sheets of a workbook: text stays text, and a missing number is an empty cell."""

from __future__ import annotations

import contextlib
import io
import itertools
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from uictest.core import files
from uictest.core.document import Cell
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.report.escaping import printable
from uictest.report.verdict_sentences import CASE_WORDS, tone

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.format import Format
    from xlsxwriter.worksheet import Worksheet


_BY_UNIT: Final = {
    "m": "0.0",
    "s": "0.00",
    "m/s2": "0.000",
    "g": "0.0000",
    "bar": "0.00",
    "NL": "0",
    "kJ": "0.0",
    "N": "0",
    "degC": "0",
}
"""Unit -> number format: the digits that a brake engineer compares, the cell holds them all."""

_OWN: Final = {
    "narrowest_margin": ("%", "0.0 %"),
    "narrowest_criterion": ("", ""),
    "share": ("%", "0 %"),
    "share_low": ("%", "0 %"),
    "share_high": ("%", "0 %"),
    "share_met": ("%", "0 %"),
}
"""Column that is no measure -> unit and number format."""

_COUNT, _SHARE, _RESIDUAL = "0", "0.0 %", "0.0E+00"
NUMBER_FORMATS: Final = frozenset(
    {*_BY_UNIT.values(), *(own for _, own in _OWN.values()), _COUNT, _SHARE, _RESIDUAL} - {""}
)
"""Every number format that a column can have."""

_ENDS: Final = ("_lowest", "_highest")


class SheetColumn(NamedTuple):
    """How a column is shown; `unit` and `number_format` are empty where it has none of its own."""

    heading: str
    unit: str = ""
    number_format: str = ""


def sheet_column(name: str) -> SheetColumn:
    """Return how a column of the tables is shown: a measure in words with its unit, others under their name.

    A range of repeats (`..._lowest`) and the number of a wheelset (`..._3`) may follow the name of a measure.
    """
    measure, end = _without_end(name)
    column = STOP_COLUMNS.get(measure) or WHEELSET_COLUMNS.get(measure)
    if column is None:
        return SheetColumn(name.replace("_", " "), *_OWN[name]) if name in _OWN else SheetColumn(name)
    in_unit = f"_{column.unit.lower().replace('/', 'p')}"
    words = f"{measure.removesuffix(in_unit)}{end}".replace("_", " ")
    return SheetColumn(words, *_unit_and_format(measure, column.unit, whole=column.whole))


def _without_end(name: str) -> tuple[str, str]:
    """Return a name without what may follow a measure, and that."""
    stem, _, last = name.rpartition("_")
    if name in STOP_COLUMNS or name in WHEELSET_COLUMNS or not stem:
        return name, ""
    return (stem, f"_{last}") if last.isdigit() or f"_{last}" in _ENDS else (name, "")


def _unit_and_format(measure: str, unit: str, *, whole: bool) -> tuple[str, str]:
    if unit != "1":
        return unit, _BY_UNIT.get(unit, "")
    if measure.endswith("_residual"):
        return "", _RESIDUAL
    return ("", _COUNT) if whole else ("%", _SHARE)


LONGEST_TEXT = 32_767
"""Characters a cell can hold."""

MOST_ROWS = 1_048_574
"""Rows a sheet can hold below its headings and units."""

MOST_COLUMNS = 16_384
"""Columns a sheet can hold."""

VERDICT_COLUMNS: Final = frozenset({"met", "verdict"})
"""Columns of verdicts in most sheets."""

_AS_WRITTEN = {"strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
_EPOCH = datetime(1980, 1, 1, tzinfo=UTC)
_WIDEST, _NARROWEST = 48, 9  # characters
_A4 = 9  # number of the paper
_HEADING: Final = {"bold": True, "text_wrap": True, "valign": "top"}
_MEASURED = 200  # rows that decide how wide a column is

Row = dict[str, Cell]


@dataclass(frozen=True, slots=True)
class RowsMadeAnew:
    """Rows that are made each time they are read, so that they are never all there at once."""

    make: Callable[[], Iterable[Row]]

    def __iter__(self) -> Iterator[Row]:
        return iter(self.make())


Styles = Mapping[str, "Format"]


@contextlib.contextmanager
def open_workbook(target: io.BytesIO, *, streaming: bool = False) -> Iterator[Workbook]:
    """Lend a workbook that takes no text for anything else; it is in the buffer when the block ends.

    With `streaming` each row goes to a temporary file when the next one begins. Raises OSError.
    """
    from xlsxwriter import Workbook
    from xlsxwriter.exceptions import FileCreateError

    folder = files.temporary_folder() if streaming else contextlib.nullcontext()
    with folder as rows:
        memory = {"constant_memory": True, "tmpdir": str(rows)} if streaming else {"in_memory": True}
        workbook = Workbook(target, _AS_WRITTEN | memory)
        # A clock in the file would make two workbooks of the same results differ.
        workbook.set_properties({"created": _EPOCH})
        try:
            with workbook:
                yield workbook
        except FileCreateError as error:
            raise error.args[0] from error
        finally:
            # The library leaves rows open where a sheet stays empty or something goes wrong.
            for sheet in workbook.worksheets():
                if sheet.row_data_fh is not None:
                    sheet.row_data_fh.close()


def styles_of(workbook: Workbook) -> Styles:
    """Return the formats that the sheets of a workbook share."""
    return {
        "title": workbook.add_format({"bold": True, "font_size": 16}),
        "header": workbook.add_format({**_HEADING, "bottom": 1}),
        "heading": workbook.add_format(_HEADING),
        "unit": workbook.add_format({"italic": True, "font_color": "#5a6472", "bottom": 1}),
        "wrapped": workbook.add_format({"text_wrap": True, "valign": "top"}),
        "good": workbook.add_format({"font_color": "#1c6b3a", "bg_color": "#e5f2e9"}),
        "bad": workbook.add_format({"font_color": "#b3261e", "bg_color": "#fbe7e5"}),
        **{text: workbook.add_format({"num_format": text}) for text in sorted(NUMBER_FORMATS)},
    }


def write_sheet(sheet: Worksheet, rows: Sequence[Row], styles: Styles) -> None:
    """Write rows below a header that names every column of any of them; colour the columns of verdicts."""
    write_table(sheet, columns_of(rows), rows, styles)


def columns_of(rows: Iterable[Row]) -> list[str]:
    """Return every column of any of the rows, in the order of their first use."""
    return list(dict.fromkeys(column for row in rows for column in row))


def write_table(
    sheet: Worksheet,
    columns: Sequence[str],
    rows: Iterable[Row],
    styles: Styles,
    most: int = MOST_ROWS,
    verdicts: Collection[str] = VERDICT_COLUMNS,
) -> int:
    """Write up to `most` rows below the headings of the columns; return how many there were to write.

    A row of units stands below the headings where a column has one. Words in the columns of `verdicts` are
    coloured by their tone.
    """
    waiting = iter(rows)
    first = list(itertools.islice(waiting, _MEASURED))
    shown = [sheet_column(name) for name in columns]
    top = heading_rows(columns)
    _write_headings(sheet, shown, top, styles)
    for place, (name, column) in enumerate(zip(columns, shown, strict=True)):
        # A heading in words may wrap; a name may not.
        words = column.heading.split() if column.unit or column.number_format else [column.heading]
        broad = width(max(words, key=len, default=""), (row.get(name) for row in first))
        style = styles.get(column.number_format or ("wrapped" if broad == _WIDEST else ""))
        sheet.set_column(place, place, broad, style)
    count = 0
    for count, row in enumerate(itertools.islice(itertools.chain(first, waiting), most), start=1):
        for place, name in enumerate(columns):
            write_cell(sheet, top + count - 1, place, row.get(name))
    _keep_headings(sheet, top)
    if count:
        sheet.autofilter(top - 1, 0, top + count - 1, len(columns) - 1)
    coloured = [columns.index(name) for name in columns if name in verdicts]
    _colour_verdicts(sheet, coloured, (top, top + max(count, 1) - 1), styles)
    return count


def heading_rows(columns: Iterable[str]) -> int:
    """Return the number of rows above those of a table: the headings, and the units if there are any."""
    return 2 if any(sheet_column(name).unit for name in columns) else 1


def _write_headings(sheet: Worksheet, columns: Sequence[SheetColumn], rows: int, styles: Styles) -> None:
    """Write the headings, and in the second of two rows the units."""
    for place, column in enumerate(columns):
        write_cell(sheet, 0, place, column.heading, styles["header" if rows == 1 else "heading"])
    # A sheet that is streamed takes its rows in their order.
    for place, column in enumerate(columns if rows > 1 else ()):
        write_cell(sheet, 1, place, column.unit, styles["unit"])


def _keep_headings(sheet: Worksheet, rows: int) -> None:
    """Let the headings and the first column stay in sight, and stand on every page in print."""
    sheet.freeze_panes(rows, 1)
    sheet.repeat_rows(0, rows - 1)
    sheet.repeat_columns(0)
    print_on_a4(sheet)


def print_on_a4(sheet: Worksheet) -> None:
    """Let a sheet print on A4 across, with the name of the sheet and the number of the page."""
    sheet.set_landscape()
    sheet.set_paper(_A4)
    sheet.set_margins(left=0.4, right=0.4, top=0.6, bottom=0.6)
    sheet.set_header("&L&9&A&R&9&F")
    sheet.set_footer("&R&9&P / &N")


def write_cell(sheet: Worksheet, row: int, column: int, value: Cell, style: Format | None = None) -> None:
    """Write a cell as what it is; nothing is taken for a formula, a link or a number that is not one."""
    if isinstance(value, str):
        shown = printable(value)
        cut = shown if len(shown) <= LONGEST_TEXT else f"{shown[: LONGEST_TEXT - 1]}…"
        sheet.write_string(row, column, cut, style)
    elif isinstance(value, bool):
        sheet.write_boolean(row, column, value, style)
    elif value is not None and abs(value) < float("inf"):
        sheet.write_number(row, column, value, style)


def width(name: str, values: Iterable[Cell]) -> int:
    """Return how wide a column has to be for its name and its texts, in characters."""
    longest = max([len(name), *(len(value) for value in values if isinstance(value, str))])
    return min(max(longest + 2, _NARROWEST), _WIDEST)


_STATUSES: Final = {"pass": "good", "fail": "bad", "inconclusive": "bad"}
"""Statuses of criteria."""
_OF_REQUIREMENTS: Final = {"met": "good", "not met": "bad"}
_COLOURS: Final = (
    {word: "good" if tone(word) == "good" else "bad" for word in CASE_WORDS} | _STATUSES | _OF_REQUIREMENTS
)


def _colour_verdicts(sheet: Worksheet, columns: Iterable[int], rows: tuple[int, int], styles: Styles) -> None:
    for first, last in _runs(columns):
        for word, colour in _COLOURS.items():
            rule: dict[str, Any] = {"type": "cell", "criteria": "==", "value": f'"{word}"'}
            sheet.conditional_format(rows[0], first, rows[1], last, rule | {"format": styles[colour]})


def _runs(columns: Iterable[int]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last number of each run of consecutive ones."""
    for _, run in itertools.groupby(enumerate(columns), key=lambda pair: pair[1] - pair[0]):
        numbers = [column for _, column in run]
        yield numbers[0], numbers[-1]

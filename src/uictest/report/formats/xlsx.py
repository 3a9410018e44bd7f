"""Tables as a workbook: a sheet for each, with the columns and rows of its CSV file. Text stays text."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from itertools import islice
from typing import TYPE_CHECKING, Final

from uictest.core import files
from uictest.core.document import Cell, Table
from uictest.report.words import printable

if TYPE_CHECKING:
    from xlsxwriter.worksheet import Worksheet

LONGEST_TEXT: Final = 32_767
"""Characters a cell can hold."""
MOST_ROWS: Final = 1_048_574
"""Rows a sheet can hold between the names of its columns and a last line."""
MOST_COLUMNS: Final = 16_384
"""Columns a sheet can hold."""
_LONGEST_NAME: Final = 31
"""Characters of the name of a sheet."""
_NOT_IN_NAMES: Final = re.compile(r"[\[\]:*?/\\']")
_AS_WRITTEN: Final = {"strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
_EPOCH: Final = datetime(1980, 1, 1, tzinfo=UTC)


def workbook_bytes(tables: Sequence[Table], most_rows: int = MOST_ROWS) -> bytes:
    """Return the workbook of tables.

    Rows beyond `most_rows` and columns beyond those of a sheet are left out, and the last line of the sheet
    says how many, and which file has them. Raises OSError.
    """
    from xlsxwriter import Workbook
    from xlsxwriter.exceptions import FileCreateError

    buffer = io.BytesIO()
    with files.temporary_folder() as rows:
        # Each row goes to a temporary file when the next one begins.
        workbook = Workbook(buffer, _AS_WRITTEN | {"constant_memory": True, "tmpdir": str(rows)})
        # A clock in the file would make two workbooks of the same results differ.
        workbook.set_properties({"created": _EPOCH})
        try:
            with workbook:
                for name, table in zip(_sheet_names(tables), tables, strict=True):
                    _write(workbook.add_worksheet(name), table, most_rows)
        except FileCreateError as error:
            raise error.args[0] from error
        finally:
            # The library leaves rows open where a sheet stays empty or something goes wrong.
            for sheet in workbook.worksheets():
                if sheet.row_data_fh is not None:
                    sheet.row_data_fh.close()
    return buffer.getvalue()


def _sheet_names(tables: Iterable[Table]) -> list[str]:
    """Return a name for each table that a sheet can have; a spreadsheet tells no case apart."""
    names: dict[str, str] = {}
    for table in tables:
        whole = _NOT_IN_NAMES.sub("_", printable(table.name))
        name, number = whole[:_LONGEST_NAME], 1
        while name.lower() in names:
            number += 1
            end = f"~{number}"
            name = f"{whole[: _LONGEST_NAME - len(end)]}{end}"
        names[name.lower()] = name
    return list(names.values())


def _write(sheet: Worksheet, table: Table, most_rows: int) -> None:
    columns = table.for_programs
    written, count = columns[:MOST_COLUMNS], min(len(table.rows), most_rows)
    for number, column in enumerate(written):
        _write_cell(sheet, 0, number, column.key)
    for line, row in enumerate(islice(table.rows, count), start=1):
        for number, column in enumerate(written):
            _write_cell(sheet, line, number, column.cell(row))
    left_out = {"rows": len(table.rows) - count, "columns": len(columns) - len(written)}
    if any(left_out.values()):
        more = ", ".join(f"{number} more {what}" for what, number in left_out.items() if number)
        sheet.write_string(
            count + 1, 0, printable(f"{more}, which a sheet cannot hold: {table.more} has all")
        )
    sheet.freeze_panes(1, 0)
    if written:
        sheet.autofilter(0, 0, count, len(written) - 1)


def _write_cell(sheet: Worksheet, row: int, column: int, value: Cell) -> None:
    """Write a cell as what it is; nothing is taken for a formula, a link or a number that is not one."""
    if value is None:
        return
    if isinstance(value, bool):
        sheet.write_boolean(row, column, value)
    elif isinstance(value, str) or math.isinf(value):
        text = printable(value) if isinstance(value, str) else repr(value)
        cut = text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 1]}…"
        sheet.write_string(row, column, cut)
    else:
        sheet.write_number(row, column, value)

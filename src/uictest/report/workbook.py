"""The workbook: cases, wheelsets, criteria, provenance. Text stays text, whatever it begins with."""

from __future__ import annotations

import dataclasses
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from uictest.report.csv_table import Cell
from uictest.report.escaping import printable
from uictest.report.tables import CRITERION_FIELDS
from uictest.report.wording import definition_sentence

if TYPE_CHECKING:
    from uictest.report.content import RunContent

LONGEST_TEXT = 32_767
"""Characters a cell can hold."""

MOST_ROWS = 1_048_575
"""Rows a sheet can hold below its header."""

_OPTIONS = {
    "strings_to_formulas": False,
    "strings_to_urls": False,
    "strings_to_numbers": False,
    "in_memory": True,
}
_WIDEST, _NARROWEST = 60, 9  # characters

Row = dict[str, Cell]


def workbook_bytes(content: RunContent) -> bytes:
    """Return the workbook of a run. Missing figures are empty cells."""
    import xlsxwriter

    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, _OPTIONS) as workbook:
        formats = {
            "header": workbook.add_format({"bold": True, "bottom": 1, "text_wrap": True, "valign": "top"}),
            "good": workbook.add_format({"font_color": "#1c6b3a", "bg_color": "#e5f2e9"}),
            "bad": workbook.add_format({"font_color": "#b3261e", "bg_color": "#fbe7e5"}),
        }
        for name, rows in _sheets(content).items():
            _write_sheet(workbook.add_worksheet(name), rows, formats)
    return buffer.getvalue()


def _sheets(content: RunContent) -> dict[str, list[Row]]:
    return {
        "Cases": list(_cases(content)),
        "Wheelsets": list(_wheelsets(content)),
        "Criteria": list(_criteria(content)),
        "Provenance": list(_provenance(content)),
    }


def _cases(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        subject = content.subject(result.id)
        row: Row = {"case": result.id, "title": subject.title, "tags": " ".join(subject.tags)}
        row |= {"scenario": result.scenario, "met": "met" if result.met else "missed"}
        row |= {"outcome": result.outcome, "expect": result.expect}
        row |= dataclasses.asdict(result.measures) if result.measures is not None else {}
        yield row | dict(result.parameters) | {"reason": result.reason}


def _wheelsets(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        for position, wheelset in enumerate(result.wheelsets, start=1):
            yield {"case": result.id, "wheelset": position, **dataclasses.asdict(wheelset)}


def _criteria(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        for verdict in result.criteria:
            row: Row = {"case": result.id, "criterion": verdict.id}
            row |= {name: getattr(verdict, name) for name in CRITERION_FIELDS}
            firm = "; ".join(str(sensitivity) for sensitivity in verdict.sensitivity)
            yield row | {"definition": definition_sentence(verdict), "sensitivity": firm}


def _provenance(content: RunContent) -> Iterator[Row]:
    yield {"what": "run", "value": content.name}
    yield {"what": "complete", "value": content.complete}
    for name, value in content.manifest.items():
        if isinstance(value, dict):
            for key, text in value.items():
                yield {"what": f"{name}: {key}", "value": str(text)}
        else:
            yield {"what": name, "value": value if isinstance(value, str) else json.dumps(value)}


def _write_sheet(sheet: Any, rows: Sequence[Row], formats: dict[str, Any]) -> None:
    columns = list(dict.fromkeys(column for row in rows for column in row))
    for column, name in enumerate(columns):
        sheet.write_string(0, column, _text(name), formats["header"])
        sheet.set_column(column, column, _width(name, (row.get(name) for row in rows[:200])))
    for number, row in enumerate(rows[:MOST_ROWS], start=1):
        for column, name in enumerate(columns):
            _write(sheet, number, column, row.get(name))
    sheet.freeze_panes(1, 1)
    if rows:
        sheet.autofilter(0, 0, min(len(rows), MOST_ROWS), len(columns) - 1)
    for word, colour in (("met", "good"), ("pass", "good"), ("missed", "bad"), ("fail", "bad")):
        for name in {"met", "verdict"} & set(columns):
            column = columns.index(name)
            rule = {"type": "cell", "criteria": "==", "value": f'"{word}"', "format": formats[colour]}
            sheet.conditional_format(1, column, max(len(rows), 1), column, rule)


def _write(sheet: Any, row: int, column: int, value: Cell) -> None:
    """Write a cell as what it is; nothing is taken for a formula, a link or a number that is not one."""
    if isinstance(value, str):
        sheet.write_string(row, column, _text(value))
    elif isinstance(value, bool):
        sheet.write_boolean(row, column, value)
    elif value is not None and abs(value) < float("inf"):
        sheet.write_number(row, column, value)


def _text(text: str) -> str:
    shown = printable(text)
    return shown if len(shown) <= LONGEST_TEXT else f"{shown[: LONGEST_TEXT - 1]}…"


def _width(name: str, values: Iterable[Cell]) -> int:
    longest = max([len(name), *(len(value) for value in values if isinstance(value, str))])
    return min(max(longest + 2, _NARROWEST), _WIDEST)

"""Workbooks held against CSV files."""

import csv

import openpyxl
import pytest

from uictest.report import csv_cell


def assert_as_csv(folder):
    """Hold the sheets of the workbook of a folder to its CSV files: the same tables, cell by cell."""
    files = {path.stem: path for path in folder.rglob("*.csv")}
    book = openpyxl.load_workbook(folder / "report.xlsx")
    assert sorted(book.sheetnames) == sorted(files)
    for name, path in files.items():
        with path.open(newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        cells = [[cell.value for cell in row] for row in book[name].iter_rows()]
        assert [csv_cell(each) for each in cells[0]] == header
        for row, sheet in zip(rows, cells[1:], strict=True):
            assert len(row) == len(sheet)
            for text, cell in zip(row, sheet, strict=True):
                assert_same(text, cell)


def assert_same(text, cell):
    """Hold a cell of a workbook to that of a CSV file: a number is one, a text the same text."""
    if isinstance(cell, bool):
        assert text == str(cell).lower()
    elif isinstance(cell, int | float):
        assert float(text) == pytest.approx(cell, rel=1e-15)
    else:
        assert text == csv_cell(cell or "")

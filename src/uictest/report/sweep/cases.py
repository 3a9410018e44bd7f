"""The cases of a sweep on a sheet, read from summary.parquet in batches."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

from uictest.report.sheet import Row, Styles, heading_rows, write_table
from uictest.report.verdict_sentences import outcome_word

if TYPE_CHECKING:
    import pyarrow.parquet as pq
    from xlsxwriter.worksheet import Worksheet

SUMMARY: Final = "summary.parquet"
LARGEST_CSV: Final = 100_000
"""Most cases of which summary.csv is written unless it is asked for; chosen: no spreadsheet likes more."""

MOST_CASES: Final = 100_000
"""Cases that a workbook has: a spreadsheet would take minutes to open a larger one."""

_AT_ONCE: Final = 1024


def write_cases(sheet: Worksheet, folder: Path, styles: Styles, most: int) -> None:
    """Write a row per case, in the order of the sweep; where there are too many, those not met come first.

    Raises OSError, and ValueError where the file cannot be read.
    """
    import pyarrow.parquet as pq

    with pq.ParquetFile(folder / SUMMARY) as summary:
        # The id leads: it is the column that stays in sight.
        columns = sorted(summary.schema_arrow.names, key=lambda name: name != "id")
        cases = summary.metadata.num_rows
        written = write_table(sheet, columns, _rows(summary, by_verdict=cases > most), styles, most)
    if written < cases:
        sheet.write_string(heading_rows(columns) + written, 0, left_out(cases, written))


def every_case(cases: int) -> str:
    """Return the name of the file that has a row for every case of a sweep."""
    return SUMMARY if cases > LARGEST_CSV else "summary.csv"


def left_out(cases: int, written: int) -> str:
    """Return which cases a workbook lacks."""
    in_file = f"are in {every_case(cases)} only"
    return f"{cases - written} of {cases} cases {in_file}; those not met stand first here"


def _rows(summary: pq.ParquetFile, *, by_verdict: bool) -> Iterator[Row]:
    for shown_verdict in (False, True) if by_verdict else (None,):
        for batch in summary.iter_batches(_AT_ONCE):
            for row in batch.to_pylist():
                if shown_verdict is None or row["met"] == shown_verdict:
                    yield row | {"met": outcome_word(row["outcome"], met=row["met"])}

"""A finished sweep put into words, tables and sheets: what its page, workbook and Markdown say."""

from typing import Final

SUMMARY: Final = "summary.parquet"
LARGEST_CSV: Final = 100_000
"""Most cases of which summary.csv is written unless it is asked for; chosen: no spreadsheet likes more."""


def every_case(cases: int) -> str:
    """Return the name of the file that has a row for every case of a sweep."""
    return SUMMARY if cases > LARGEST_CSV else "summary.csv"

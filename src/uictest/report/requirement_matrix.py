"""The matrix of a workbook: requirements down, cases and series across, what each says of each."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Final

from uictest.report.requirements import VerifiedRequirement
from uictest.report.sheet import MOST_COLUMNS, Row

REQUIREMENTS_SHEET: Final = "Requirements"
_OWN_COLUMNS: Final = ("requirement id", "overall status", "tested in", "not met in", "cases left out")
"""None of them can be the id of a case, which holds no blank, or begin as the name of a series."""


def requirement_matrix(requirements: Iterable[VerifiedRequirement], most: int = MOST_COLUMNS) -> list[Row]:
    """Return a row for each requirement: its status, counts, and a column for each case and series.

    Those that a sheet of `most` columns cannot hold are left out, and each row says how many of its own.
    """
    requirements = list(requirements)
    cases = list(dict.fromkeys(each.name for row in requirements for each in row.evidence))
    shown = set(cases[: most - len(_OWN_COLUMNS)])
    return [_row(each, [case for case in cases if case in shown]) for each in requirements]


def verdict_columns(rows: Iterable[Row]) -> Collection[str]:
    """Return the columns of the matrix that hold verdicts: the status, every case and every series."""
    return {
        column for row in rows for column in row if column == "overall status" or column not in _OWN_COLUMNS
    }


def _row(requirement: VerifiedRequirement, cases: Sequence[str]) -> Row:
    words = {each.name: each.word for each in requirement.evidence}
    left_out = len(words.keys() - set(cases))
    own: Row = {"requirement id": requirement.id, "overall status": requirement.status}
    own |= {"tested in": len(requirement.tested), "not met in": len(requirement.not_met)}
    return (
        own | ({"cases left out": left_out} if left_out else {}) | {case: words.get(case) for case in cases}
    )

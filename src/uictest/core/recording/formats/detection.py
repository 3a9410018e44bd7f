"""How a text table is written, found out by its lines and cells."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path
from typing import Final

import numpy as np

from uictest.core.recording.formats.cells import Cells, grouping_of
from uictest.core.recording.formats.csv_text import heading_of, read
from uictest.core.recording.formats.file_formats import UnreadableError
from uictest.core.recording.formats.layout import (
    COMMENT,
    OF_WINDOWS,
    Dialect,
    cells_of,
    encoding_of,
    likely_layout,
    undecodable,
)
from uictest.core.recording.recording import Contents, Group

_MOST_MARKS: Final = 3
"""Different texts among the numbers of a channel that are taken for marks of missing samples; chosen."""


def read_by_itself(path: Path, stated: Dialect) -> Contents:
    """Read a table by the dialect that it shows, where `stated` does not read it.

    `Contents.dialect` says which, `guesses` why a setting of it is one. Raises UnreadableError where there is
    no table.
    """
    dialect, guesses = _of_heading(path, replace(stated, by_itself=False))
    contents, refined = read(path, dialect), dialect
    while (more := _of_cells(contents.groups[0], refined)) != refined:
        contents, refined = read(path, more), more
    for setting, reason in (("thousands", "groups of three digits"), ("missing", "texts among numbers")):
        if getattr(refined, setting) != getattr(dialect, setting):
            guesses[setting] = reason
    return replace(contents, guesses=guesses)


def _of_heading(path: Path, stated: Dialect) -> tuple[Dialect, dict[str, str]]:
    """Return the dialect that the first lines of a file show, and what of it is a guess."""
    guesses: dict[str, str] = {}
    try:
        heading = heading_of(path, encoding_of(path, stated.encoding), stated)
    except UnicodeError as error:
        if stated.encoding == OF_WINDOWS:
            raise UnreadableError(undecodable(path, OF_WINDOWS)) from error
        dialect, guesses = _of_heading(path, replace(stated, encoding=OF_WINDOWS))
        return dialect, {**guesses, "encoding": f"it is not {stated.encoding}"}
    layout, likely = likely_layout(heading, stated)
    if layout.alike:
        guesses["header_line"] = f"or {', '.join(map(str, layout.alike))}, which are as wide"
        likely = replace(likely, header_line=layout.header_line)
    samples = (line for line in heading[layout.first_line - 1 :] if not line.startswith(COMMENT))
    rows = [cells_of(line, likely.delimiter) for line in samples]
    columns = [{cell.lstrip("+-") for cell in column} for column in zip_longest(*rows, fillvalue="")]
    if not likely.thousands and _may_group_digits(columns, likely.decimal):
        if not _groups_digits(columns, likely.decimal):
            return likely, {**guesses, "decimal": "or it groups digits: three stand behind it in all numbers"}
        other = "," if likely.decimal == "." else "."
        guesses["thousands"] = f"it stands in numbers from 1{likely.decimal}000 on alone"
        likely = replace(likely, thousands=likely.decimal, decimal=other)
    return likely, guesses


def _may_group_digits(columns: Sequence[Set[str]], sign: str) -> bool:
    """Return whether all numbers with a sign have it where it would group their digits."""
    numbers = (cell for column in columns for cell in column if cell.replace(sign, "").isdigit())
    signed = [cell for cell in numbers if sign in cell]
    return bool(signed) and all(grouping_of(cell) == sign and not cell.startswith("0") for cell in signed)


def _groups_digits(columns: Sequence[Set[str]], sign: str) -> bool:
    """Return whether a column has numbers with the sign beside smaller ones without it."""
    return any(
        any(sign in cell for cell in column) and any(cell.isdigit() and len(cell) <= 3 for cell in column)
        for column in columns
    )


def _of_cells(group: Group, dialect: Dialect) -> Dialect:
    """Return a dialect with the decimal comma, groups of digits or marks that texts among numbers show."""
    placed = [text for name in group.numbers for text in group.first_texts.get(name, {})]
    if dialect.decimal == "." and any(
        Cells(",").is_number(each) and not grouping_of(each) for each in placed
    ):
        return replace(dialect, decimal=",")
    for name, numbers in group.numbers.items():
        texts = group.channels[name]
        signs = {text: grouping_of(text) for text in np.unique(texts).tolist() if text}
        grouped = set(signs.values()) - {"", dialect.decimal}
        if len(grouped) == 1 and not dialect.thousands:
            dialect = replace(dialect, thousands=grouped.pop())
        marks = [text for text in signs if dialect.cells.is_text(text)]
        rare = 2 * np.isin(texts, marks).sum() < np.isfinite(numbers).sum() and len(marks) <= _MOST_MARKS
        if rare and not any(len(mark) == 1 and mark.isalpha() for mark in marks):  # which names a state
            dialect = replace(dialect, missing=(*dialect.missing, *marks))
    return dialect

"""The list of all requirements, as a requirements tool exports it: text, CSV or YAML."""

import csv
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.named_file import REQUIREMENT_PATTERN
from uictest.plans.scenario.yaml import (
    Document,
    Map,
    Place,
    Scalar,
    ScenarioErrors,
    Sequence,
    describe,
    diagnose,
    parse,
    quoted,
    read_document,
    single_error,
)

LARGEST: Final = 16 * 1024 * 1024
"""Largest file that is read, bytes: exports hold the texts of the requirements as well."""
_COLUMN: Final = "id"
_DELIMITERS: Final = ",;\t"
_ID: Final = re.compile(REQUIREMENT_PATTERN)
_HINT: Final = "an id has letters, digits and . _ - : / only, and starts with a letter or digit"

_Ids = Iterator[tuple[str, Place]]


def read_requirement_list(path: Path) -> tuple[str, ...]:
    """Return the ids in a list of requirements, each once, in the order of the file.

    `.csv`: the column `id`, separated by comma, semicolon or tab; rows without an id are skipped. `.yaml` or
    `.yml`: a list of ids, or of mappings with a key `id`. Any other file: one id per line, `#` begins a
    comment. Raises ScenarioErrors with every line that is wrong.
    """
    document = read_document(path, LARGEST, "is this a list of requirements?")
    read = {".csv": _csv_ids, ".yaml": _yaml_ids, ".yml": _yaml_ids}.get(path.suffix.lower(), _text_ids)
    found = list(read(document))
    wrong = [
        diagnose(place, f"{quoted(text)} is not the id of a requirement", hint=_HINT)
        for text, place in found
        if not _ID.fullmatch(text)
    ]
    if wrong:
        raise ScenarioErrors(wrong)
    if not found:
        raise single_error(Place(document), "the list has no requirement")
    return tuple(dict.fromkeys(text for text, _ in found))


def _text_ids(document: Document) -> _Ids:
    for number, line in enumerate(document.lines, start=1):
        text = line.removeprefix("\ufeff").partition("#")[0]
        if text.strip():
            yield text.strip(), Place(document, number, len(text) - len(text.lstrip()) + 1)


def _csv_ids(document: Document) -> _Ids:
    lines = document.text.removeprefix("\ufeff").splitlines(keepends=True)
    delimiter, column = _id_column(document, lines[0] if lines else "")
    rows = csv.reader(lines, delimiter=delimiter)
    first = 1
    try:
        for row in rows:
            if first > 1 and len(row) > column and row[column].strip():
                yield row[column].strip(), Place(document, first)
            first = rows.line_num + 1
    except csv.Error as error:
        raise single_error(Place(document, rows.line_num), f"cannot be read as CSV: {error}") from None


def _id_column(document: Document, header: str) -> tuple[str, int]:
    for delimiter in _DELIMITERS:
        names = [name.strip().lower() for name in next(csv.reader([header], delimiter=delimiter), [])]
        if _COLUMN in names:
            return delimiter, names.index(_COLUMN)
    raise single_error(Place(document), f"the first row names no column {quoted(_COLUMN)}")


def _yaml_ids(document: Document) -> _Ids:
    root = parse(document, beginning="write a list of ids")
    if not isinstance(root, Sequence):
        raise single_error(root.place, f"expected a list of ids, found {describe(root)}")
    for item in root.items:
        node = item.get(_COLUMN) if isinstance(item, Map) else item
        if not isinstance(node, Scalar):
            expected = f"expected an id, or a mapping with the key {quoted(_COLUMN)}"
            raise single_error(item.place, f"{expected}, found {describe(item)}")
        yield node.text, node.place


_NUMBERS = re.compile(r"([0-9]+)")


def named_requirements(scenario: Scenario) -> tuple[str, ...]:
    """Return the ids of the requirements that a resolved scenario or one of its criteria names, each once.

    Criteria that only a series can be judged by are left out.
    """
    criteria = (each for profile in scenario.criteria for each in profile.criteria if not each.needs_series)
    of_criteria = (requirement for criterion in criteria for requirement in criterion.requirements)
    return tuple(dict.fromkeys((*scenario.requirements, *of_criteria)))


def in_order_of_ids(requirements: Iterable[str]) -> list[str]:
    """Return ids in alphabetical order, numbers within them by value: BR-9 before BR-10."""
    return sorted(requirements, key=lambda text: (_split_at_numbers(text), text))


def _split_at_numbers(text: str) -> list[str | int]:
    return [int(part) if place % 2 else part for place, part in enumerate(_NUMBERS.split(text))]

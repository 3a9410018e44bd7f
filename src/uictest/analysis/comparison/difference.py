"""The result of a comparison, in data and in words."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any

from uictest import report
from uictest.analysis.comparison.overlay import Overlay
from uictest.analysis.comparison.paired.pairing import PairedComparison, paired_form
from uictest.analysis.comparison.paired.wording import paired_lines
from uictest.analysis.comparison.parameters import ParameterChange, parameter_lines
from uictest.report import (
    Difference,
    TableColumn,
    aligned,
    columns_not_shown,
    counted,
    differences_form,
    fitted,
    number,
    printable,
    side_text,
    table_width,
    worst_of_wheelsets,
    wrapped_name,
)


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two things compared.

    Args:
        first, second: their names.
        compared: how many quantities were compared.
        differences: those that are not the same, within tolerance or not.
        notes: inputs, versions and settings that differ.
        overlays: plots of both sides.
        undrawn: which stops are not drawn, and why.
        parameters: those that differ between two runs.
        paired: differences of stops under the same noise, between two runs; None for recordings.

    """

    first: str
    second: str
    compared: int
    differences: Sequence[Difference]
    notes: Sequence[str] = ()
    overlays: Sequence[Overlay] = field(default=(), repr=False)
    undrawn: Sequence[str] = ()
    parameters: Sequence[ParameterChange] = ()
    paired: PairedComparison | None = None

    @property
    def beyond(self) -> list[Difference]:
        """The differences that are out of tolerance."""
        return [difference for difference in self.differences if not difference.within]

    @property
    def agrees(self) -> bool:
        """Whether everything is within tolerance."""
        return not self.beyond

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form, overlays left out."""
        return {
            "schema": "uictest/comparison/1",
            "first": self.first,
            "second": self.second,
            "agrees": self.agrees,
            "compared": self.compared,
            "notes": list(self.notes),
            "parameters": [_change_form(change) for change in self.parameters],
            "differences": differences_form(self.differences),
            **({} if self.paired is None else {"paired": paired_form(self.paired)}),
        }


def _change_form(change: ParameterChange) -> dict[str, Any]:
    first, second = change.texts
    return {"key": change.key, "first": first, "second": second, "cases": list(change.cases)}


_MOST_PARAMETERS = 20
"""Changed parameters that are listed without `-v`; two vehicles differ in some 25."""


def comparison_lines(
    comparison: Comparison, *, every: bool = False, width: int | None = None
) -> Iterator[str]:
    """Yield a table of the differences out of tolerance, then paired differences, parameters and notes.

    The table has only the worst wheelset for each measure of wheelsets; with `every`, it has all differences.
    It is at most `width` characters wide, None for any width.
    """
    shown = comparison.differences if every else worst_of_wheelsets(comparison.beyond)
    if shown:
        yield from _table(shown, width)
    if comparison.paired is not None:
        yield from paired_lines(comparison.paired, width)
    yield from _parameter_lines(comparison, every=every)
    for note in comparison.notes:
        yield f"note: {printable(note)}"


def _parameter_lines(comparison: Comparison, *, every: bool) -> Iterator[str]:
    """Yield what was changed between two runs, and in which cases."""
    changes = comparison.parameters
    shown = changes if every else changes[:_MOST_PARAMETERS]
    yield from parameter_lines(shown)
    if len(shown) < len(changes):
        yield f"parameters: {len(changes) - len(shown)} more differ; -v lists them"


def _table(differences: Sequence[report.Difference], width: int | None) -> Iterator[str]:
    """Yield the differences as one table; where that is too wide, as one below the id of each case."""
    columns = _columns(differences)
    if width is None or table_width(columns) <= width:
        yield from aligned(columns)
        return
    all_hidden: dict[str, TableColumn] = {}
    for case_id, group in groupby(differences, key=lambda each: each.case):
        if case_id:
            yield from wrapped_name(printable(case_id), width)
        own = [column for column in _columns(list(group)) if column.title != "case"]
        shown, hidden = fitted(own, width)
        all_hidden |= {column.title: column for column in hidden}
        yield from aligned(shown)
    if line := columns_not_shown(list(all_hidden.values()), "--format json has them"):
        yield line


def comparison_json(comparison: Comparison) -> str:
    """Return the comparison as a JSON document."""
    return json.dumps(comparison.to_dict(), indent=2, allow_nan=False)


def verdict_line(comparison: Comparison) -> str:
    """Return the result of the comparison on one line."""
    count = counted(comparison.compared, "quantity", "quantities")
    if not comparison.differences:
        return f"{count} compared, no difference"
    within = len(comparison.differences) - len(comparison.beyond)
    return f"{count} compared: {len(comparison.beyond)} out of tolerance, {within} different within tolerance"


def _columns(differences: Sequence[report.Difference]) -> list[TableColumn]:
    """Return the table of differences; without a case for recordings."""
    words = ["within" if difference.within else report.DIFFERS for difference in differences]
    # A word that all rows share is left out first.
    rank_of_words = 5 if len(set(words)) == 1 else 0
    cases = [printable(difference.case) for difference in differences]
    columns = [
        TableColumn("", words, rank_of_words),
        TableColumn("case", cases, wraps=True),
        TableColumn("quantity", [printable(difference.quantity) for difference in differences], wraps=True),
        TableColumn("first", [printable(side_text(difference.first)) for difference in differences]),
        TableColumn("second", [printable(side_text(difference.second)) for difference in differences]),
        TableColumn("deviation", [number(difference.deviation) for difference in differences], rank=2),
        TableColumn("allowed", [number(difference.allowed) for difference in differences], rank=3),
        TableColumn("unit", [printable(difference.unit) or "-" for difference in differences], rank=1),
        TableColumn("remark", [printable(difference.remark) for difference in differences], rank=4),
    ]
    return [column for column in columns if any(column.cells)]

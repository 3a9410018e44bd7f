"""The result of a comparison, in data and in words."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from uictest.analysis.comparison.overlay import Overlay
from uictest.analysis.comparison.paired_document import paired_sections
from uictest.analysis.comparison.paired_stops import PairedComparison, paired_form
from uictest.analysis.comparison.parameters import ParameterChange, parameter_lines
from uictest.core import envelope
from uictest.core.document import Column, Document, Lines, Table
from uictest.report import (
    DIFFERS,
    Difference,
    counted,
    differences_form,
    number,
    side_text,
    worst_of_wheelsets,
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
            **envelope.head(envelope.RESULT, "comparison"),
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


def comparison_document(comparison: Comparison, *, every: bool = False) -> Document:
    """Return the differences out of tolerance, then paired differences, parameters and notes.

    The table has only the worst wheelset for each measure of wheelsets; with `every`, it has all differences.
    """
    sections: list[Table | Lines] = [
        _differences_table(comparison.differences if every else worst_of_wheelsets(comparison.beyond))
    ]
    if comparison.paired is not None:
        sections += paired_sections(comparison.paired)
    sections.append(Lines(list(_parameter_lines(comparison, every=every))))
    sections.append(Lines([f"note: {note}" for note in comparison.notes]))
    return Document(f"{comparison.first} and {comparison.second}", sections)


def _parameter_lines(comparison: Comparison, *, every: bool) -> Iterator[str]:
    changes = comparison.parameters
    shown = changes if every else changes[:_MOST_PARAMETERS]
    yield from parameter_lines(shown)
    if len(shown) < len(changes):
        yield f"parameters: {len(changes) - len(shown)} more differ; -v lists them"


def _difference_word(difference: Difference) -> str:
    return "within" if difference.within else DIFFERS


_CASE: Final[Column[Difference]] = Column(heading="case", text=lambda each: each.case, wraps=True)
_COLUMNS: Final[tuple[Column[Difference], ...]] = (
    _CASE,
    Column(heading="quantity", text=lambda each: each.quantity, wraps=True),
    Column(heading="first", text=lambda each: side_text(each.first)),
    Column(heading="second", text=lambda each: side_text(each.second)),
    Column(heading="deviation", text=lambda each: number(each.deviation), rank=2),
    Column(heading="allowed", text=lambda each: number(each.allowed), rank=3),
    Column(heading="unit", text=lambda each: each.unit or "-", rank=1),
    Column(heading="remark", text=lambda each: each.remark, rank=4),
)


def _differences_table(differences: Sequence[Difference]) -> Table:
    # A word that all rows share is left out first.
    word = Column(
        heading="verdict",
        text=_difference_word,
        rank=5 if len(set(map(_difference_word, differences))) == 1 else 0,
    )
    return Table((word, *_COLUMNS), differences, all_in="--format json", grouped_by=_CASE)


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

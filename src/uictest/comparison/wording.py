"""A comparison in words: lines for the terminal, JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from uictest.report.difference import value_text, worst_of_wheelsets
from uictest.report.escaping import printable
from uictest.report.wording import counted, number

if TYPE_CHECKING:
    from uictest.comparison.difference import Comparison
    from uictest.report.difference import Difference

_HEADINGS = ("", "case", "quantity", "first", "second", "deviation", "allowed", "unit", "")


def comparison_lines(comparison: Comparison, *, every: bool = False) -> Iterator[str]:
    """Yield a table of the differences out of tolerance, then what is known to differ.

    Of a figure that the wheelsets of a stop have, the worst stands for all. `every`: all of all differences.
    """
    shown = comparison.differences if every else worst_of_wheelsets(comparison.beyond)
    if shown:
        yield from _aligned([_HEADINGS, *map(_row, shown)])
    for note in comparison.notes:
        yield f"note: {printable(note)}"


def comparison_json(comparison: Comparison) -> str:
    """Return the comparison as a JSON document."""
    return json.dumps(comparison.to_dict(), indent=2, allow_nan=False)


def verdict_line(comparison: Comparison) -> str:
    """Return one line that says how the comparison came out."""
    count = counted(comparison.compared, "quantity").replace("quantitys", "quantities")
    if not comparison.differences:
        return f"{count} compared, no difference"
    within = len(comparison.differences) - len(comparison.beyond)
    return f"{count} compared: {len(comparison.beyond)} out of tolerance, {within} different within tolerance"


def _row(difference: Difference) -> tuple[str, ...]:
    return (
        "within" if difference.within else "DIFFERS",
        difference.case or "-",
        difference.quantity,
        value_text(difference.first),
        value_text(difference.second),
        number(difference.deviation),
        number(difference.allowed),
        difference.unit or "-",
        difference.remark,
    )


def _aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    shown = [[printable(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*shown, strict=True)]
    for row in shown:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()

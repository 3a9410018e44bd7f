"""A comparison in words: lines for the terminal, JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from uictest.report.difference import value_text, worst_of_wheelsets
from uictest.report.escaping import printable
from uictest.report.text_table import Column, aligned, columns_not_shown, fitted
from uictest.report.wording import counted, number

if TYPE_CHECKING:
    from uictest.comparison.difference import Comparison
    from uictest.report.difference import Difference


def comparison_lines(
    comparison: Comparison, *, every: bool = False, width: int | None = None
) -> Iterator[str]:
    """Yield a table of the differences out of tolerance, then what is known to differ.

    Of a figure that the wheelsets of a stop have, the worst stands for all. `every`: all of all differences.
    The table keeps to `width` characters, None for any width.
    """
    shown = comparison.differences if every else worst_of_wheelsets(comparison.beyond)
    if shown:
        columns, given_way = fitted(_columns(shown), width)
        yield from aligned(columns)
        if given_way:
            yield columns_not_shown(given_way, "--format json has them")
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


def _columns(differences: Sequence[Difference]) -> list[Column]:
    """Return the table of differences; without a case for recordings."""
    words = ["within" if difference.within else "DIFFERS" for difference in differences]
    cases = [printable(difference.case) for difference in differences]
    columns = [
        Column("", words),
        Column("case", cases, wraps=True),
        Column("quantity", [printable(difference.quantity) for difference in differences], wraps=True),
        Column("first", [printable(value_text(difference.first)) for difference in differences]),
        Column("second", [printable(value_text(difference.second)) for difference in differences]),
        Column("deviation", [number(difference.deviation) for difference in differences], rank=2),
        Column("allowed", [number(difference.allowed) for difference in differences], rank=3),
        Column("unit", [printable(difference.unit) or "-" for difference in differences], rank=1),
        Column("remark", [printable(difference.remark) for difference in differences], rank=4),
    ]
    return [column for column in columns if any(column.cells)]

"""A comparison in words: lines for the terminal, JSON for programs."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from uictest.evaluation import WheelsetFigures
from uictest.report.escaping import printable
from uictest.report.wording import counted, number

if TYPE_CHECKING:
    from uictest.comparison.difference import Comparison, Difference

_HEADINGS = ("", "case", "quantity", "first", "second", "deviation", "allowed", "unit", "")
_OF_WHEELSETS = frozenset(field.name for field in dataclasses.fields(WheelsetFigures))


def comparison_lines(comparison: Comparison, *, every: bool = False) -> Iterator[str]:
    """Yield a table of the differences out of tolerance, then what is known to differ.

    Of a figure that the wheelsets of a stop have, the worst stands for all. `every`: all of all differences.
    """
    shown = comparison.differences if every else _worst_of_wheelsets(comparison.beyond)
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


def _worst_of_wheelsets(differences: Sequence[Difference]) -> list[Difference]:
    by_figure: dict[tuple[str, str], list[Difference]] = {}
    for difference in differences:
        by_figure.setdefault((difference.case, _figure(difference.quantity)), []).append(difference)
    return [_worst(group) for group in by_figure.values()]


def _figure(quantity: str) -> str:
    """Return the name of a figure, less the number of the wheelset."""
    name, _, number_of_wheelset = quantity.rpartition("_")
    return name if number_of_wheelset.isdigit() and name in _OF_WHEELSETS else quantity


def _worst(group: Sequence[Difference]) -> Difference:
    worst = max(group, key=_excess)
    return worst if len(group) == 1 else dataclasses.replace(worst, remark=f"worst of {len(group)} wheelsets")


def _excess(difference: Difference) -> float:
    if difference.deviation is None or not difference.allowed:
        return math.inf
    return difference.deviation / difference.allowed


def _row(difference: Difference) -> tuple[str, ...]:
    return (
        "within" if difference.within else "DIFFERS",
        difference.case or "-",
        difference.quantity,
        difference.first,
        difference.second,
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

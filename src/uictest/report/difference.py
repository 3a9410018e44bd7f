"""A quantity that is not the same on two sides, in data and in words."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from uictest.core import measures
from uictest.report.escaping import printable
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.wording import number, quantity

CELSIUS: Final = "degC"
_LARGEST_PERCENT: Final = 1000
"""A relative figure that is still written out; chosen."""

Value = int | float | str
"""A number, NaN where there is none; or a text: an outcome, a verdict, a unit."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One quantity that is not the same on both sides.

    `case` is empty for a recording. `first`, `second`, `deviation` and `allowed` are in `unit`; the last two
    are None where the sides cannot be subtracted. `remark` says where or why.
    """

    case: str
    quantity: str
    first: Value
    second: Value
    within: bool
    unit: str = ""
    deviation: float | None = None
    allowed: float | None = None
    remark: str = ""


def side_text(value: Value) -> str:
    """Return one side of a difference without its unit."""
    return value if isinstance(value, str) else number(value)


def relative_percent(first: Value, second: Value, unit: str = "") -> float | None:
    """Return by how many per cent of the first side's size the second exceeds it.

    None where a side is no finite number, where the first is 0, and in degC, whose zero is arbitrary.
    """
    if isinstance(first, str) or isinstance(second, str) or unit == CELSIUS or not first:
        return None
    percent = 100.0 * (second - first) / abs(first)
    return percent if math.isfinite(percent) else None


def relative_text(first: Value, second: Value, unit: str = "") -> str:
    """Return this as text; `A is 0` where the first side is 0, else `-` where there is none."""
    if first == 0.0 and not isinstance(second, str):
        return "A is 0"
    return percent_text(relative_percent(first, second, unit))


def percent_text(percent: float | None) -> str:
    """Return a relative figure with its sign and three digits, `-` where there is none.

    A multiple beyond ten is written `> 1000`: it says only that its base is nearly 0.
    """
    if percent is None:
        return "-"
    if abs(percent) < _LARGEST_PERCENT:
        return f"{percent:+.3g}"
    return f"> {_LARGEST_PERCENT}" if percent > 0 else f"< -{_LARGEST_PERCENT}"


def difference_sentence(difference: Difference) -> str:
    """Return one line: `outcome was pass, is fail`, for numbers with deviation and tolerance."""
    first, second = (_with_unit(side, difference.unit) for side in (difference.first, difference.second))
    sentence = f"{difference.quantity} was {first}, is {second}"
    if difference.deviation is not None and difference.allowed is not None:
        deviation, allowed = (
            quantity(size, difference.unit) for size in (difference.deviation, difference.allowed)
        )
        sentence += f"; deviation {deviation}, tolerance {allowed}"
    return printable(f"{sentence} ({difference.remark})" if difference.remark else sentence)


def wheelset_quantity(measure: str, wheelset: int) -> str:
    """Return the name of a measure of one wheelset among the quantities of a stop."""
    return f"{measure}_{wheelset}"


def worst_of_wheelsets(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, with only the worst wheelset for each measure of wheelsets."""
    columns = {wheelset_quantity(name, n): name for name in measures.WHEELSET_COLUMNS for n in WHEELSETS}
    # The train may have a measure of the same name, as `adhesion_utilisation`: it is no wheelset.
    groups: dict[tuple[str, str, bool], list[Difference]] = {}
    for difference in differences:
        column = columns.get(difference.quantity)
        group = difference.case, column or difference.quantity, column is not None
        groups.setdefault(group, []).append(difference)
    return list(_worst_of_each(groups.values()))


def furthest_out(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences by how many times their tolerance they are, the largest first."""
    return sorted(differences, key=_excess, reverse=True)


def _worst_of_each(groups: Iterable[Sequence[Difference]]) -> Iterator[Difference]:
    for group in groups:
        worst = max(group, key=_excess)
        remark = worst.remark if len(group) == 1 else f"worst of {len(group)} wheelsets"
        yield dataclasses.replace(worst, remark=remark)


def _excess(difference: Difference) -> float:
    if difference.deviation is None or not difference.allowed:
        return math.inf
    return difference.deviation / difference.allowed


def _with_unit(value: Value, unit: str) -> str:
    return value if isinstance(value, str) else quantity(value, unit)

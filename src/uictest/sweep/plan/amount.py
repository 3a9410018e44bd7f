"""Numbers with a unit as a sweep computes with them: exact decimals, written as in a scenario."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Context, Decimal
from typing import Annotated, Any, Final

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.scenario.yaml import quoted

_WRITTEN = re.compile(
    r"\s*([-+]?(?:[0-9]{1,15}(?:\.[0-9]{0,15})?|\.[0-9]{1,15})(?:[eE][-+]?[0-9]{1,2})?)(?![0-9.])\s*(.*?)\s*",
    re.DOTALL,
)
_DIGITS: Final = Context(prec=10)
"""Digits that a computed number is written with; the value is then what its text says."""


@dataclass(frozen=True, slots=True)
class Amount:
    """A decimal number and the unit behind it, empty for a pure number."""

    number: Decimal
    unit: str

    def __str__(self) -> str:
        """Return the amount as a scenario would have it."""
        return written(self.number, self.unit)


def written(number: Decimal, unit: str) -> str:
    """Return a number with its unit, without an exponent."""
    return f"{number:f} {unit}" if unit else f"{number:f}"


def rounded(number: float) -> Decimal:
    """Return a computed number as the decimal of at most ten digits that stands for it."""
    return _DIGITS.create_decimal_from_float(number).normalize()


def parse_amount(text: str) -> Amount:
    """Read a number and its unit. Raises ValueError."""
    match = _WRITTEN.fullmatch(text)
    if match is None:
        raise ValueError(f"{quoted(text)} is not a number with its unit")
    return Amount(Decimal(match[1]), " ".join(match[2].split()))


def evenly(first: Decimal, last: Decimal, count: int) -> list[Decimal]:
    """Return `count` numbers from `first` to `last`, equally far apart."""
    if count == 1:
        return [first]
    between = (first + (last - first) * k / (count - 1) for k in range(count))
    return [
        min(max(_DIGITS.plus(number).normalize(), min(first, last)), max(first, last)) for number in between
    ]


def stepwise(first: Decimal, last: Decimal, step: Decimal) -> list[Decimal]:
    """Return the numbers from `first` by `step`, with `last` where a step lands on it."""
    return [first + k * step for k in range(int((last - first) / step) + 1)]


def common_unit(amounts: Sequence[Amount]) -> str | None:
    """Return the unit that all amounts have, None where they differ."""
    units = {amount.unit for amount in amounts}
    return units.pop() if len(units) == 1 else None


def _validated(given: Any) -> Amount:
    text = getattr(given, "text", given)
    try:
        if isinstance(given, bool) or not isinstance(given, str | int | float):
            raise ValueError("expected a number with its unit")
        return parse_amount(str(text))
    except ValueError as error:
        context = {"message": str(error), "hint": "write it as in a scenario: 0.1, 80 %, 120 km/h"}
        raise PydanticCustomError("amount", "{message}", context) from None


WrittenAmount = Annotated[
    Amount,
    PlainValidator(_validated),
    PlainSerializer(str),
    WithJsonSchema({"type": ["string", "number"]}),
]
"""A field of a file that holds an amount."""

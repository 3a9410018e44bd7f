"""Decimal numbers with a unit, exactly as written in a file: sweeps compute and print values with them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Context, Decimal
from typing import Annotated, Any, Final

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.yaml.tree import quoted

_FORM = re.compile(
    r"\s*([-+]?(?:[0-9]{1,15}(?:\.[0-9]{0,15})?|\.[0-9]{1,15})(?:[eE][-+]?[0-9]{1,2})?)(?![0-9.])\s*(.*?)\s*",
    re.DOTALL,
)
_DIGITS: Final = Context(prec=10)
"""Digits that a computed number is written with; its value is that of the text."""


@dataclass(frozen=True, slots=True)
class DecimalQuantity:
    """A decimal number and its unit; the unit of a pure number is empty."""

    number: Decimal
    unit: str

    def __str__(self) -> str:
        """Return the quantity as a scenario file has it."""
        return quantity_text(self.number, self.unit)


def quantity_text(number: Decimal, unit: str) -> str:
    """Return a number with its unit, without an exponent."""
    return f"{number:f} {unit}" if unit else f"{number:f}"


def rounded_decimal(number: float) -> Decimal:
    """Return a computed number rounded to ten digits."""
    return _DIGITS.create_decimal_from_float(number).normalize()


def rounded_text(number: float) -> str:
    """Return a computed number rounded to ten digits, as text without an exponent."""
    text = f"{number:.10g}"
    _, _, exponent = text.partition("e")
    if exponent.startswith("-"):
        return f"{number:.{9 - int(exponent)}f}".rstrip("0")
    return f"{rounded_decimal(number):f}" if exponent else text


def parse_decimal_quantity(text: str) -> DecimalQuantity:
    """Parse a number and its unit. Raises ValueError."""
    match = _FORM.fullmatch(text)
    if match is None:
        raise ValueError(f"{quoted(text)} is not a number with its unit")
    return DecimalQuantity(Decimal(match[1]), " ".join(match[2].split()))


def evenly_spaced(first: Decimal, last: Decimal, count: int) -> list[Decimal]:
    """Return `count` evenly spaced numbers from `first` to `last`."""
    if count == 1:
        return [first]
    low, high = sorted((first, last))
    numbers = (first + (last - first) * k / (count - 1) for k in range(count))
    return [min(max(_DIGITS.plus(number).normalize(), low), high) for number in numbers]


def spaced_by_step(first: Decimal, last: Decimal, step: Decimal) -> list[Decimal]:
    """Return the numbers from `first` in steps; `last` is included if a step reaches it."""
    return [first + k * step for k in range(int((last - first) / step) + 1)]


def common_unit(quantities: Sequence[DecimalQuantity]) -> str | None:
    """Return the unit of all quantities, None where they differ."""
    units = {quantity.unit for quantity in quantities}
    return units.pop() if len(units) == 1 else None


def _validate(value: Any) -> DecimalQuantity:
    text = getattr(value, "text", value)
    try:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise ValueError("expected a number with its unit")
        return parse_decimal_quantity(str(text))
    except ValueError as error:
        context = {"message": str(error), "hint": "write it as in a scenario: 0.1, 80 %, 120 km/h"}
        raise PydanticCustomError("amount", "{message}", context) from None


DecimalQuantityField = Annotated[
    DecimalQuantity,
    PlainValidator(_validate),
    PlainSerializer(str),
    WithJsonSchema({"type": ["string", "number"]}),
]
"""A field of a file that holds a number with its unit."""

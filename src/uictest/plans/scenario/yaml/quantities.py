"""Physical quantities: SI numbers that remember how they were written, and fields that hold them."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from functools import lru_cache, reduce
from operator import add
from typing import Annotated, Any, Final, Literal, NamedTuple, Self

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.core.units import KINDS, Kind
from uictest.plans.scenario.yaml.diagnostics import nearest, quoted

SCENARIO_SOURCE: Final = "scenario"
"""Source of a number that a user wrote in a scenario."""
DEFAULT_SOURCE: Final = "default"
"""Source of a number that nobody wrote: the default of a field."""
Prior = Literal["uniform", "log-uniform"]
"""Distribution over a plausible range: uniform in the value, or uniform in its logarithm."""
DEFAULT_PRIOR: Final = "uniform"
"""Where a range states none: two ends and nothing else prefer no value; chosen."""
# Bounded digits and exponent: an exact fraction of 1e999999999 would fill the memory.
NUMBER_PATTERN: Final = r"[-+]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?"
_WRITTEN = re.compile(rf"\s*({NUMBER_PATTERN})(?![0-9.])\s*(\S.*)?", re.DOTALL)
_NOT_FINITE = re.compile(r"\s*[-+]?\.?(?:nan|inf|infinity)\b", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"\s*[-+]?[0-9]+,[0-9]+")


class Quantity(float):
    """A float in its canonical SI unit.

    ``text`` is the value as written, ``unit`` the canonical unit, ``source`` a key of the part's ``sources``
    or ``"scenario"`` or ``"default"``. ``range`` holds the ends of its plausible range where one is stated;
    their source is that of the range, and ``prior`` says how likely the values between them are.
    """

    __slots__ = ("prior", "range", "source", "text", "unit")

    text: str
    unit: str
    source: str
    range: tuple[Quantity, Quantity] | None
    prior: Prior

    def __new__(
        cls,
        value: float,
        text: str,
        unit: str,
        source: str = SCENARIO_SOURCE,
        range: tuple[Quantity, Quantity] | None = None,  # noqa: A002 - the key of a file
        prior: Prior = DEFAULT_PRIOR,
    ) -> Self:
        """A quantity of ``value`` in the canonical ``unit``, written as ``text``."""
        quantity = super().__new__(cls, value)
        quantity.text = text
        quantity.unit = unit
        quantity.source = source
        quantity.range = range
        quantity.prior = prior
        return quantity

    def __getnewargs__(self) -> tuple[Any, ...]:
        return float(self), self.text, self.unit, self.source, self.range


def total(numbers: Iterable[float]) -> float:
    """Return the sum of numbers, added up from the left.

    It has the same bits on every Python: from 3.12 on, `sum` rounds numbers otherwise.
    """
    return reduce(add, numbers, 0.0)


class QuantityError(ValueError):
    """A text that is not a quantity of the kind asked for; ``hint`` says what would be accepted."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


def refused(message: str, hint: str = "", kind: Any = "refused") -> PydanticCustomError:
    """Return the error that a validator raises, with a message and a hint what to write."""
    return PydanticCustomError(kind, "{message}", {"message": message, "hint": hint})


Accepts = Callable[[float], bool]
"""Whether a value, in the canonical unit, is in the range of its field."""


def parse_quantity(
    text: str, kind: str, source: str = SCENARIO_SOURCE, accepts: Accepts = math.isfinite
) -> Quantity:
    """Return a quantity of the named kind, from a number and its unit, blanks between them optional.

    ``accepts`` decides which units the hint names when there is none. Raises QuantityError when the text is
    no such quantity.
    """
    value, accepted = _canonical_value(text, kind), KINDS[kind]
    if value is None:
        raise _no_quantity(text, accepted, accepts)
    if not math.isfinite(value):
        raise QuantityError(f"{quoted(text)} is not a finite number")
    return Quantity(value, text.strip(), accepted.canonical, source)


@lru_cache(maxsize=1024)  # the parts of a rig and the cases of a matrix share most of their texts
def _canonical_value(text: str, kind: str) -> float | None:
    """Return the number of a quantity in the canonical unit of its kind; None where there is none."""
    written = _split(text)
    if written is None:
        return None
    (number, symbol), accepted = written, KINDS[kind]
    if not symbol:
        return _as_float(number) if accepted.bare else None
    unit = accepted.units.get(symbol)
    return None if unit is None else _as_float(number * unit.factor + unit.offset)


def _split(text: str) -> tuple[Fraction, str] | None:
    match = _WRITTEN.fullmatch(text)
    if match is None or _DECIMAL_COMMA.match(text):
        return None
    return Fraction(Decimal(match[1])), " ".join((match[2] or "").split())


def _no_quantity(text: str, kind: Kind, accepts: Accepts) -> QuantityError:
    written = _split(text)
    if written is None:
        return _not_a_number(text, kind)
    number, symbol = written
    if kind.bare:
        ratio = KINDS["share"].units.get(symbol)
        bare = _as_float(number if ratio is None else number * ratio.factor)
        hint = f"write {bare:.10g}" if accepts(bare) else f"write {example(kind)}"
        return QuantityError(f"{quoted(text)} has a unit where a bare number belongs", hint)
    if not symbol:
        hint = _hint_for_bare(text.strip(), number, kind, accepts)
        return QuantityError(f"{quoted(text)} has no unit", hint)
    return QuantityError(f"unknown unit {quoted(symbol)} for {described(kind)}", _hint_for_unit(symbol, kind))


def _not_a_number(text: str, kind: Kind) -> QuantityError:
    if _NOT_FINITE.match(text):
        return QuantityError(f"{quoted(text)} is not a finite number", f"write {example(kind)}")
    if _DECIMAL_COMMA.match(text):
        return QuantityError(
            f"{quoted(text)} is not a number", f"write {quoted(text.replace(',', '.'))}, with a decimal point"
        )
    return QuantityError(f"{quoted(text)} is not {described(kind)}", f"write {example(kind)}")


def _as_float(number: Fraction) -> float:
    try:
        return float(number)
    except OverflowError:
        return math.inf


def _hint_for_bare(text: str, number: Fraction, kind: Kind, accepts: Accepts) -> str:
    """The units with which the number is in range, the most usual first; a share up to one is a ratio."""
    usual = next(iter(kind.units.values()))
    if kind.canonical == "1" and 0 < abs(number) <= 1 and accepts(_as_float(number)):
        ratio = _as_float(number / usual.factor)
        return f"write `{ratio:.10g} {usual.symbol}` (a bare {text} is ambiguous)"
    in_range = [
        f"`{text} {unit.symbol}`"
        for unit in kind.units.values()
        if unit.symbol != "1" and accepts(_as_float(number * unit.factor + unit.offset))
    ]
    return "write " + (" or ".join(in_range[:2]) or example(kind))


def _hint_for_unit(symbol: str, kind: Kind) -> str:
    accepted = "accepted: " + ", ".join(kind.units)
    plain = _plain(symbol)
    alike = [
        unit.symbol for unit in kind.units.values() if plain in map(_plain, (unit.symbol, *unit.misspellings))
    ]
    guesses = alike or [each for each in (nearest(symbol, kind.units),) if each]
    return f"did you mean {' or '.join(map(quoted, guesses))}? {accepted}" if guesses else accepted


def _plain(symbol: str) -> str:
    """The symbol less what people write differently: case, blanks, dots, powers."""
    return re.sub(r"[\s*^·⋅.]", "", unicodedata.normalize("NFKC", symbol)).casefold()


def described(kind: Kind) -> str:
    """Name of a quantity of this kind in messages."""
    if kind.bare:
        return "a whole number" if kind.name == "count" else "a number"
    article = "an" if kind.name[0] in "aeiou" else "a"
    return f"{article} {kind.name}"


def example(kind: Kind) -> str:
    """A short text saying how a quantity of this kind is written."""
    if kind.bare:
        return "a bare number such as 4" if kind.name == "count" else "a bare number such as 0.1"
    return f"a number with a unit ({', '.join(kind.units)})"


_FORM = re.compile(
    r"\s*([-+]?(?:[0-9]{1,15}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][-+]?[0-9]{1,2})?)(?![0-9.])\s*(.*?)\s*",
    re.DOTALL,
)
_DIGITS: Final = Context(prec=10)
"""Digits that a computed number is written with; its value is that of the text."""


class DecimalQuantity(NamedTuple):
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


def count_by_step(first: Decimal, last: Decimal, step: Decimal) -> int:
    """Return the length of :func:`spaced_by_step`; 0 where no step leads to `last`."""
    steps = (last - first) / step if step else Decimal(-1)
    return int(steps) + 1 if steps >= 0 else 0


def spaced_by_step(first: Decimal, last: Decimal, step: Decimal) -> list[Decimal]:
    """Return the numbers from `first` in steps; `last` is included if a step reaches it."""
    return [first + k * step for k in range(count_by_step(first, last, step))]


def common_unit(quantities: Sequence[DecimalQuantity]) -> str | None:
    """Return the unit of all quantities, None where they differ."""
    units = {quantity.unit for quantity in quantities}
    return units.pop() if len(units) == 1 else None


@lru_cache(maxsize=1024)
def unit_as_written(text: str) -> str:
    """Return the unit of a quantity as its text has it, empty for a bare number."""
    return parse_decimal_quantity(text).unit


def _validate(value: Any) -> DecimalQuantity:
    text = getattr(value, "text", value)
    try:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise ValueError("expected a number with its unit")
        return parse_decimal_quantity(str(text))
    except ValueError as error:
        raise refused(str(error), "write it as in a scenario: 0.1, 80 %, 120 km/h") from None


DecimalQuantityField = Annotated[
    DecimalQuantity,
    PlainValidator(_validate),
    PlainSerializer(str),
    WithJsonSchema({"type": ["string", "number"]}),
]
"""A field of a file that holds a number with its unit."""

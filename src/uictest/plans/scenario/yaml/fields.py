"""Fields that are quantities: their validation by pydantic and their JSON Schema."""

import re
from collections.abc import Callable
from functools import cache
from operator import ge, gt, le, lt
from typing import Any, Final, NamedTuple, cast, get_args

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from uictest.core.units import KINDS, Kind
from uictest.plans.scenario.yaml.diagnostics import quoted
from uictest.plans.scenario.yaml.quantities import (
    DEFAULT_PRIOR,
    DEFAULT_SOURCE,
    NUMBER_PATTERN,
    SCENARIO_SOURCE,
    Prior,
    Quantity,
    QuantityError,
    described,
    example,
    parse_decimal_quantity,
    parse_quantity,
    refused,
    unit_as_written,
)

_MARKED_KEYS: Final = frozenset({"value", "source", "range", "range_source", "prior"})
QUANTITY_KEYWORD: Final = "x-quantity"
"""Keyword that stands for the definition of a kind while a JSON Schema is put together."""


class Bound(NamedTuple):
    """An end of the values that are accepted: in words, as a keyword of JSON Schema, and as a comparison."""

    words: str
    keyword: str
    value: Quantity
    keeps: Callable[[float, float], bool]


class QuantityField(NamedTuple):
    """Annotation of a field that is a quantity of one ``kind`` (speed, pressure, ...), within a ``span``."""

    kind: Kind
    span: str = ".."

    def validate(self, value: object) -> Quantity:
        """Return the quantity of a text, a number, or a mapping of value and source."""
        try:
            return self._checked_within_bounds(
                self._validated_mapping(value) if isinstance(value, dict) else self._number(value)
            )
        except QuantityError as error:
            raise refused(error.message, error.hint, "quantity") from None

    def _number(self, value: object, source: str = SCENARIO_SOURCE) -> Quantity:
        if isinstance(value, Quantity):
            if value.unit == self.kind.canonical:
                return value
            message = f"{quoted(value.text)} is not {described(self.kind)}"
            raise QuantityError(message, f"write {example(self.kind)}")
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise QuantityError(f"expected {described(self.kind)}", f"write {example(self.kind)}")
        return parse_quantity(getattr(value, "text", str(value)), self.kind.name, source, self._accepts)

    def _validated_mapping(self, mapping: dict[str, object]) -> Quantity:
        source = mapping.get("source", SCENARIO_SOURCE if "range" in mapping else None)
        of_range = mapping.get("range_source", source)
        if not (
            {"value"} <= set(mapping) <= _MARKED_KEYS
            and isinstance(source, str)
            and isinstance(of_range, str)
            and not isinstance(mapping["value"], dict)
        ):
            raise QuantityError(
                f"expected {described(self.kind)}, found a mapping",
                f"write {example(self.kind)}, or a mapping of 'value' and 'source'; 'range' may follow",
            )
        number = self._number(mapping["value"])
        ends = self._range(mapping["range"], number, of_range) if "range" in mapping else None
        prior = _read_prior(mapping["prior"], ends) if "prior" in mapping else DEFAULT_PRIOR
        return Quantity(float(number), number.text, number.unit, source, ends, prior)

    def _range(self, ends: object, value: Quantity, source: str) -> tuple[Quantity, Quantity]:
        if not isinstance(ends, list | tuple) or len(ends) != 2 or dict in map(type, ends):
            raise QuantityError("a range has two ends", f"write [{example(self.kind)}, and a larger one]")
        low, high = [self._checked_within_bounds(self._number(end, source)) for end in ends]
        unit = unit_as_written(value.text)
        if not unit == unit_as_written(low.text) == unit_as_written(high.text):
            raise QuantityError(
                f"the range [{low.text}, {high.text}] is in another unit than {value.text}",
                f"write both ends in {unit or 'bare numbers'}",
            )
        if not low <= value <= high or low == high:
            raise QuantityError(
                f"the range [{low.text}, {high.text}] does not hold {value.text}", "write its lower end first"
            )
        return low, high

    def _checked_within_bounds(self, value: Quantity) -> Quantity:
        if self.kind.name == "count" and not value.is_integer():
            raise QuantityError(f"{quoted(value.text)} is not a whole number")
        bounds = _parse_bounds(self.kind.name, self.span)
        for words, _, bound, keeps in bounds:
            if not keeps(value, bound):
                accepted = " and ".join(f"{end.words} {end.value.text}" for end in bounds)
                raise QuantityError(
                    f"{value.text} is out of range: it must be {words} {bound.text}", f"accepted: {accepted}"
                )
        return value

    def _accepts(self, value: float) -> bool:
        return all(keeps(value, bound) for _, _, bound, keeps in _parse_bounds(self.kind.name, self.span))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self.validate, serialization=core_schema.plain_serializer_function_ser_schema(written)
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.value_or_marked() if self.kind.bare else {QUANTITY_KEYWORD: self.kind.name}

    def value_or_marked(self) -> dict[str, Any]:
        """Return the JSON Schema of the value alone, or of a mapping of value and source."""
        if self.kind.bare:
            types = ["integer" if self.kind.name == "count" else "number", "string"]
            bounds = {end.keyword: float(end.value) for end in _parse_bounds(self.kind.name, self.span)}
            value = {"type": types, "pattern": rf"^\s*{NUMBER_PATTERN}\s*$", **bounds}
        else:
            units = "|".join(re.escape(symbol).replace(r"\ ", r"\s+") for symbol in self.kind.units)
            value = {"type": "string", "pattern": rf"^\s*{NUMBER_PATTERN}\s*(?:{units})\s*$"}
        source = {"type": "string", "description": "A key of the part's `sources`."}
        marked = {
            "type": "object",
            "description": "A value with its source and, if it has one, its plausible range.",
            "properties": {
                "value": {**value, "description": "The value itself."},
                "source": source,
                "range": {
                    "type": "array",
                    "description": "Lowest and highest plausible value, in the unit of the value.",
                    "items": value,
                    "minItems": 2,
                    "maxItems": 2,
                },
                "range_source": {
                    **source,
                    "description": "Source of the range, if it is not that of the value.",
                },
                "prior": {
                    "enum": list(get_args(Prior)),
                    "default": DEFAULT_PRIOR,
                    "description": "How likely the values of the range are: all alike, or all factors of one"
                    " size alike.",
                },
            },
            "required": ["value"],
            "anyOf": [{"required": ["source"]}, {"required": ["range"]}],
            "dependencies": {"prior": ["range"]},
            "additionalProperties": False,
        }
        return {"anyOf": [value, marked]}


@cache
def _parse_bounds(kind: str, span: str) -> tuple[Bound, ...]:
    """Return the ends of a span, the lower first; read when a value is compared, not when a model is made."""
    first, last = (end.strip() for end in span.split(".."))
    lower = ("above", "exclusiveMinimum", gt) if first.startswith(">") else ("at least", "minimum", ge)
    upper = ("below", "exclusiveMaximum", lt) if last.startswith("<") else ("at most", "maximum", le)
    ends = ((lower, first.lstrip("> ")), (upper, last.lstrip("< ")))
    return tuple(
        Bound(words, keyword, parse_quantity(text, kind), keeps)
        for (words, keyword, keeps), text in ends
        if text
    )


def written(quantity: Quantity) -> str | dict[str, Any]:
    """The quantity as a file would write it; reads back as the same quantity."""
    form: dict[str, Any] = {"value": quantity.text}
    if quantity.source not in (SCENARIO_SOURCE, DEFAULT_SOURCE):
        form["source"] = quantity.source
    elif quantity.range is None:
        return quantity.text
    if quantity.range is not None:
        form["range"] = [end.text for end in quantity.range]
        if (source := quantity.range[0].source) != quantity.source:
            form["range_source"] = source
        if quantity.prior != DEFAULT_PRIOR:
            form["prior"] = quantity.prior
    return form


def _read_prior(prior: object, ends: tuple[Quantity, Quantity] | None) -> Prior:
    if prior not in get_args(Prior):
        raise QuantityError(f"unknown prior {quoted(str(prior))}", f"accepted: {', '.join(get_args(Prior))}")
    if ends is None:
        raise QuantityError("a prior without a range", "write `range: [lowest, highest]` beside it")
    if prior == "log-uniform" and parse_decimal_quantity(ends[0].text).number <= 0:
        raise QuantityError(
            f"a log-uniform prior of a range from {ends[0].text}", "accepted: ends above zero"
        )
    return cast(Prior, prior)


def of_kind(name: str, span: str = "..") -> QuantityField:
    """Return the annotation of a field: a quantity of the named kind, from one end of a span to the other.

    Args:
        name: of the kind.
        span: such as ``"1 bar .. 4 bar"``; ``"> 0 s .. 10 s"`` leaves its first end out, ``"0 .. < 1"`` its
            last. An end that is empty bounds nothing.
    """
    return QuantityField(KINDS[name], span)


def default(text: str, name: str) -> Quantity:
    """Return the default of a field of the named kind, written as a user would write it."""
    return parse_quantity(text, name, DEFAULT_SOURCE)


def field(description: str, **settings: Any) -> Any:
    """Return a field of a model: what people are told of it, and what pydantic takes for a field."""
    return Field(description=description, **settings)


def optional(description: str, **settings: Any) -> Any:
    """Return a field that is None where a file leaves it out."""
    return Field(default=None, description=description, **settings)


def quantity(description: str, kind: str, span: str, *, default: str | None = None) -> Any:
    """Return a field that is a quantity of a kind, within a span; `default` is written like its ends."""
    unset: dict[str, Any] = {}
    if default is not None:
        unset["default"] = parse_quantity(default, kind, DEFAULT_SOURCE)
    declared: Any = Field(description=description, **unset)
    declared.metadata.append(of_kind(kind, span))
    return declared


def schema_field(name: str) -> Any:
    """Return the field that says which schema a file has; a mapping inside a file leaves it out."""
    return Field(default=name, alias="schema", description=f"What the file holds: {name}.")

"""A bound that refers to the reference of a series: `125 % of the dry stop`."""

import re
from typing import Any, Final

from pydantic_core import PydanticCustomError

from uictest.plans.scenario.yaml import Quantity, QuantityError, parse_quantity, quoted

_MENTION: Final = re.compile(r"(?i)\bdry\b")
_WRITTEN: Final = re.compile(r"(?P<share>.*\S)\s+of\s+the\s+dry\s+stop\s*", re.DOTALL)
_EXAMPLE: Final = "write such as `125 % of the dry stop`"


class DryBound(Quantity):
    """A share (1 = 100 %) of the same figure of the dry stop, the mean over the dry stops of that speed."""

    __slots__ = ()


def is_dry_bound(value: object) -> bool:
    """Return whether what a file gives as a bound is meant as a share of the dry stop."""
    if isinstance(value, dict):
        value = value.get("value")
    return isinstance(value, DryBound) or (isinstance(value, str) and bool(_MENTION.search(value)))


def dry_bound(value: Any) -> DryBound:
    """Return the bound. Raises PydanticCustomError with a hint where it is written in another way."""
    if isinstance(value, DryBound):
        return value
    if isinstance(value, dict):
        return _marked(value)
    match = _WRITTEN.fullmatch(str(value))
    if match is None:
        raise _error(f"{quoted(str(value))} is no share of the dry stop", _EXAMPLE)
    try:
        share = parse_quantity(match["share"], "share")
    except QuantityError as error:
        raise _error(error.message, f"{error.hint}; {_EXAMPLE}" if error.hint else _EXAMPLE) from None
    if share <= 0.0:
        raise _error(f"a bound of {quoted(str(value))} is not above zero", _EXAMPLE)
    return DryBound(float(share), " ".join(str(value).split()), share.unit)


def _marked(value: dict[str, Any]) -> DryBound:
    source = value.get("source")
    if set(value) != {"value", "source"} or not isinstance(source, str):
        raise _error("expected a share of the dry stop, found a mapping", "give it a 'value' and a 'source'")
    bare = dry_bound(value["value"])
    return DryBound(float(bare), bare.text, bare.unit, source)


def _error(message: str, hint: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{message}", {"message": message, "hint": hint})

"""Numbers as JSON can hold them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any


def json_form(value: Any) -> Any:
    """Return a value made of dicts, lists, tuples, text and numbers with NaN and infinity as None."""
    if isinstance(value, Mapping):
        return {str(key): json_form(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [json_form(item) for item in value]
    if isinstance(value, float):
        # float(): a subclass (a quantity, a numpy number) would otherwise print in its own way.
        return float(value) if math.isfinite(value) else None
    return value


def or_nan(value: float | None) -> float:
    """Return a figure read from JSON, None as NaN."""
    return math.nan if value is None else float(value)

"""Estimates as JSON holds them: NaN is null, and a field without a number is left out when read as NaN."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, SerializerFunctionWrapHandler, WrapSerializer

from uictest.core.series_measures import Estimate, SeriesValue
from uictest.judging.evaluation import json_form

_NUMBERS: Final = ("value", "low", "high", "smallest", "largest", "covered")


def _with_nulls(estimate: Estimate, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form: dict[str, Any] = json_form(write(estimate))
    return form


def _with_nan(content: object) -> object:
    if isinstance(content, Mapping):
        return {
            name: math.nan if value is None and name in _NUMBERS else value for name, value in content.items()
        }
    return content


WrittenEstimate = Annotated[Estimate, WrapSerializer(_with_nulls), BeforeValidator(_with_nan)]
"""An estimate whose missing numbers are null in JSON."""


def _value_form(value: SeriesValue, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form: dict[str, Any] = json_form(write(value))
    return form


def _read_value(content: object) -> object:
    if isinstance(content, Mapping) and isinstance(content.get("estimate"), Mapping):
        return {**content, "estimate": _with_nan(content["estimate"])}
    return content


WrittenValue = Annotated[SeriesValue, WrapSerializer(_value_form), BeforeValidator(_read_value)]
"""The value of a measure of series; what has no number is null in JSON."""

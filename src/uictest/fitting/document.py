"""A fit as JSON."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any, Final

from uictest.fitting.estimate import Fit
from uictest.fitting.overlay import Agreement

SCHEMA: Final = "uictest/fit/1"


def fit_document(found: Fit, agreement: Agreement, choices: dict[str, str]) -> dict[str, Any]:
    """Return what a fit found, how far the simulated stop then follows, and how the record was prepared."""
    document = {
        "schema": SCHEMA,
        "determined": found.determined,
        "fit": asdict(found),
        "agreement": asdict(agreement),
        "preparation": choices,
    }
    cleaned: dict[str, Any] = _without_nan(document)
    return cleaned


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_without_nan(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value

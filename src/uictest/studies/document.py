"""The results of studies as one versioned JSON document."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from uictest.studies.comparison import band_origin
from uictest.studies.quantity import PaperComparison, StudyQuantity
from uictest.studies.study import StudyResult

SCHEMA = "uictest/studies/2"


def document(results: Sequence[StudyResult]) -> str:
    """Return the document as JSON; a value that is not finite is null."""
    return json.dumps({"schema": SCHEMA, "studies": [_study(each) for each in results]}, indent=2)


def _study(result: StudyResult) -> dict[str, Any]:
    return {
        "name": result.study.name,
        "title": result.study.title,
        "source": result.study.paper,
        "result": result.result,
        "fails": result.fails,
        "quantities": [_quantity(comparison) for comparison in result.comparisons],
        "notes": list(result.findings.notes),
    }


def _quantity(comparison: PaperComparison) -> dict[str, Any]:
    quantity, ours = comparison.quantity, comparison.ours
    return {
        "key": quantity.key,
        "title": quantity.title,
        "unit": quantity.unit,
        "source": quantity.paper,
        "value": _finite(ours.value),
        "low": _finite(ours.low),
        "high": _finite(ours.high),
        "status": quantity.status,
        "result": comparison.result,
        "band": _band(quantity),
        "declared_miss": quantity.declared_miss,
        "fails": comparison.fails,
    }


def _band(quantity: StudyQuantity) -> dict[str, Any] | None:
    band = quantity.band
    if band is None:
        return None
    return {
        "of": band_origin(quantity),
        "lower": band.lower,
        "upper": band.upper,
        "upper_excluded": band.below,
        "reason": band.reason,
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None

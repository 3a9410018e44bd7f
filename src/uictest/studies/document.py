"""What studies came to, as one versioned JSON document."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uictest.studies.quantity import PaperComparison
    from uictest.studies.study import StudyResult

SCHEMA = "uictest/studies/1"


def document(result: Sequence[StudyResult]) -> str:
    """Return the document as JSON; a figure that was not found is null."""
    return json.dumps({"schema": SCHEMA, "studies": [_study(each) for each in result]}, indent=2)


def _study(result: StudyResult) -> dict[str, Any]:
    return {
        "name": result.study.name,
        "title": result.study.title,
        "source": result.study.source,
        "verdict": result.verdict,
        "quantities": [_quantity(comparison) for comparison in result.comparisons],
        "notes": list(result.findings.notes),
    }


def _quantity(comparison: PaperComparison) -> dict[str, Any]:
    quantity, found = comparison.quantity, comparison.found
    return {
        "key": quantity.key,
        "title": quantity.title,
        "unit": quantity.unit,
        "source": quantity.source,
        "value": _finite(found.value),
        "low": _finite(found.low),
        "high": _finite(found.high),
        "lower": quantity.lower,
        "upper": quantity.upper,
        "upper_excluded": quantity.below,
        "band_from": quantity.reason,
        "verdict": comparison.verdict,
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None

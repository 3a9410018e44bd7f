"""The comparison with the paper as a table and as a versioned JSON document."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from studies.comparison import (
    band_origin,
    band_text,
    declared_misses,
    ours_text,
    paper_text,
    result_text,
)
from studies.quantity import PaperComparison, StudyQuantity
from studies.study import StudyResult

if TYPE_CHECKING:
    from rich.console import Group


_STYLES = {"holds": "green", "misses": "yellow", "shown": "dim"}


def study_table(result: StudyResult) -> Group:
    """Return title, what the paper says, a row for every quantity, and the notes."""
    from rich.console import Group
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    study = result.study
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("quantity", overflow="fold", ratio=5)
    table.add_column("paper", overflow="fold", ratio=3)
    table.add_column("ours", overflow="fold", ratio=4)
    table.add_column("band", overflow="fold", ratio=3)
    table.add_column("status", no_wrap=True)
    table.add_column("result", no_wrap=True)
    for comparison in result.comparisons:
        quantity = comparison.quantity
        cells = (quantity.title, quantity.paper, ours_text(comparison), band_text(quantity), quantity.status)
        style = "bold red" if comparison.fails else _STYLES[comparison.result]
        table.add_row(*map(Text, cells), Text(result_text(comparison), style=style))
    heading = Text(f"{study.name}  ", style="bold").append(study.title, style="not bold")
    paper = Text(paper_text(study), style="dim")
    notes = [Text(note, style="dim") for note in (*declared_misses(result), *result.findings.notes)]
    return Group(heading, paper, Padding(table, (1, 0, 1, 2)), *notes, Text())


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

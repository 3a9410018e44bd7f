"""A finished sweep as the reports for people see it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from uictest.report.sweep.result import SweepResult
from uictest.report.traces.trace import PlotTrace


@dataclass(frozen=True, slots=True)
class SweepContent:
    """What a report of a sweep shows.

    Args:
        folder: of the sweep; it holds the tables.
        result: what `sweep.json` holds.
        manifest: where the results come from.
        traces: what there is to draw of the worst cases, by id.

    """

    folder: Path
    result: SweepResult
    manifest: Mapping[str, Any]
    traces: Mapping[str, PlotTrace] = field(default_factory=dict)

"""A finished sweep as the formats made for people see it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from uictest import evaluation
from uictest.report.case_description import CaseDescription

if TYPE_CHECKING:
    from uictest.report.traces.trace import Trace


@dataclass(frozen=True, slots=True)
class SweepContent:
    """What a report of a sweep shows.

    Args:
        folder: of the sweep; its tables lie there.
        document: what sweep.json holds.
        manifest: where the results come from.
        worst: the cases most worth looking at, those not met first.
        subjects: what they are about, by id.
        traces: what there is to draw of them, by id.
        base: the parts of the case whose values are varied, by role; none where an earlier version wrote it.

    """

    folder: Path
    document: Mapping[str, Any]
    manifest: Mapping[str, Any]
    worst: Sequence[evaluation.CaseResult] = ()
    subjects: Mapping[str, CaseDescription] = field(default_factory=dict)
    traces: Mapping[str, Trace] = field(default_factory=dict)
    base: Mapping[str, evaluation.EffectivePart] = field(default_factory=dict)

    def subject(self, case_id: str) -> CaseDescription:
        """Return what a case is about; an empty subject where that is not known."""
        return self.subjects.get(case_id, CaseDescription())

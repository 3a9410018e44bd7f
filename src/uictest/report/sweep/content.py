"""A finished sweep as the formats made for people see it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from uictest.report.subject import Subject

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult, EffectivePart
    from uictest.report.page import Trace


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
    worst: Sequence[CaseResult] = ()
    subjects: Mapping[str, Subject] = field(default_factory=dict)
    traces: Mapping[str, Trace] = field(default_factory=dict)
    base: Mapping[str, EffectivePart] = field(default_factory=dict)

    def subject(self, case_id: str) -> Subject:
        """Return what a case is about; an empty subject where that is not known."""
        return self.subjects.get(case_id, Subject())

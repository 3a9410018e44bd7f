"""A finished run as the formats made for people see it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from uictest.report.subject import Subject

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult
    from uictest.report.page import Trace


@dataclass(frozen=True, slots=True)
class RunContent:
    """What a report shows.

    Args:
        name: name of the run.
        results: every case.
        manifest: where the results come from.
        complete: False where selected cases are missing from the results.
        subjects: what cases are about, by id; a case may lack one.
        traces: what there is to draw, by id.

    """

    name: str
    results: Sequence[CaseResult]
    manifest: Mapping[str, Any]
    complete: bool = True
    subjects: Mapping[str, Subject] = field(default_factory=dict)
    traces: Mapping[str, Trace] = field(default_factory=dict)

    def subject(self, case_id: str) -> Subject:
        """Return what a case is about; an empty subject where that is not known."""
        return self.subjects.get(case_id, Subject())

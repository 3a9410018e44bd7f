"""A finished run as the formats made for people see it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from uictest import evaluation
from uictest.report.baseline import BaselineComparison, case_explanation, case_word, run_tally
from uictest.report.difference import Difference
from uictest.report.manifest import RunManifest

if TYPE_CHECKING:
    from uictest.report.traces.trace import PlotTrace


@dataclass(frozen=True, slots=True)
class CaseDescription:
    """What a case is about, in the user's words: title, tags and main settings, name -> text.

    `settings` holds what a simulated stop was run with; of a recorded one it holds the conditions that it was
    judged by, and `recorded`, else empty, says where its samples come from.
    """

    title: str = ""
    tags: tuple[str, ...] = ()
    settings: Mapping[str, str] = field(default_factory=dict)
    recorded: Mapping[str, str] = field(default_factory=dict)


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
        baseline: how the run compares with its baseline; None where it was given none.

    """

    name: str
    results: Sequence[evaluation.CaseResult]
    manifest: RunManifest = field(default_factory=RunManifest)
    complete: bool = True
    subjects: Mapping[str, CaseDescription] = field(default_factory=dict)
    traces: Mapping[str, PlotTrace] = field(default_factory=dict)
    baseline: BaselineComparison | None = None

    def subject(self, case_id: str) -> CaseDescription:
        """Return what a case is about; an empty subject where that is not known."""
        return self.subjects.get(case_id, CaseDescription())

    def differences(self, case_id: str) -> Sequence[Difference]:
        """Return the quantities of a case that are out of the tolerance of the baseline."""
        return self.baseline.differences.get(case_id, ()) if self.baseline else ()

    def passes(self, result: evaluation.CaseResult) -> bool:
        """Return whether a case meets its expectation and nothing of it differs from the baseline."""
        return result.met and not self.differences(result.id)

    def word(self, result: evaluation.CaseResult) -> str:
        """Return the word of a case: how it stands to its expectation and to the baseline."""
        return case_word(result, self.differences(result.id))

    def explanation(self, result: evaluation.CaseResult) -> list[str]:
        """Return the reasons for the outcome of a case, and its differences from the baseline."""
        return case_explanation(result, self.differences(result.id))

    @property
    def tally(self) -> str:
        """The counts of the run."""
        return run_tally(self.results, self.baseline)

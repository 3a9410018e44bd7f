"""A finished run as the formats made for people see it, and which of its cases a page draws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.campaign import Campaign
from uictest.report.difference import BaselineComparison, Difference, case_explanation, case_word, run_tally
from uictest.report.manifest import RunManifest
from uictest.report.part_wording import controllers_text

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult
    from uictest.report.traces.trace import PlotTrace


DRAWN = 18
"""Cases drawn on one page. Each takes up to 270 kB, and a page must still open from a mail attachment."""
MOST_DRAWN = 60
"""Cases drawn on one page if somebody asks for them: at most 16 MB."""


def drawn_cases(
    results: Iterable[evaluation.CaseResult], drawn_first: Collection[str] = ()
) -> list[evaluation.CaseResult]:
    """Return the cases that a page draws: at most `MOST_DRAWN` of those asked for, then others up to `DRAWN`.

    Of the others, those not as expected come first, then those with the narrowest margins, from every
    scenario in turn.

    Args:
        results: of all cases that can be drawn.
        drawn_first: ids of the cases that somebody asked for.

    """
    ranked = from_scenarios_in_turn(results)
    asked_for = [result for result in ranked if result.id in drawn_first][:MOST_DRAWN]
    others = [result for result in ranked if result.id not in drawn_first]
    return [*asked_for, *others[: max(DRAWN - len(asked_for), 0)]]


def from_scenarios_in_turn(results: Iterable[evaluation.CaseResult]) -> list[evaluation.CaseResult]:
    """Return the worst case of each scenario, then the second of each; cases not as expected go first."""
    places: Counter[tuple[bool, str]] = Counter()
    ranked = []
    for result in worst_first(results):
        places[result.met, result.scenario] += 1
        ranked.append((places[result.met, result.scenario], result))
    return [result for _, result in sorted(ranked, key=lambda each: (each[1].met, each[0]))]


def worst_first(results: Iterable[evaluation.CaseResult]) -> list[evaluation.CaseResult]:
    """Return the results: not as expected, of these a requirement missed, first; then by narrowest margin."""
    return sorted(results, key=_rank)


def _rank(result: evaluation.CaseResult) -> tuple[bool, bool, bool, float]:
    margin, _ = evaluation.narrowest_margin(result)
    missed = result.requirement_status == "missed"
    return result.met, not missed, result.outcome == "pass", 1.0 if margin is None else margin


@dataclass(frozen=True, slots=True)
class CaseDescription:
    """Description of a case in the user's words: title, tags and main settings, name -> text.

    `settings` are those that a simulated stop was run with, or the conditions that a recorded stop was judged
    by. `recorded` states the origin of the samples of a recorded stop; it is empty for a simulated one.
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
        complete: False where an interrupt ended the run, or selected cases are missing from the results.
        subjects: descriptions of cases, by id; a case may have none.
        traces: what the plots are drawn from, by id.
        baseline: the comparison with the baseline; None without one.
        series: every series, with the results of its own cases, which are not among `results`.
        drawn_first: ids of the cases that are to be drawn before all others.
        passed_over: what was found and not judged, a sentence with the reason each.
        campaign: what the stops of a log show together; None without a log.

    """

    name: str
    results: Sequence[evaluation.CaseResult]
    manifest: RunManifest = field(default_factory=RunManifest)
    complete: bool = True
    subjects: Mapping[str, CaseDescription] = field(default_factory=dict)
    traces: Mapping[str, PlotTrace] = field(default_factory=dict)
    baseline: BaselineComparison | None = None
    series: Sequence[SeriesResult] = ()
    drawn_first: Collection[str] = ()
    passed_over: Sequence[str] = ()
    campaign: Campaign | None = None

    def subject(self, case_id: str) -> CaseDescription:
        """Return the description of a case; an empty one where there is none."""
        return self.subjects.get(case_id, CaseDescription())

    def differences(self, case_id: str) -> Sequence[Difference]:
        """Return the quantities of a case that are out of the tolerance of the baseline."""
        return self.baseline.differences.get(case_id, ()) if self.baseline else ()

    def passes(self, result: evaluation.CaseResult) -> bool:
        """Return whether a case meets its expectation and does not differ from the baseline."""
        return result.met and not self.differences(result.id)

    def word(self, result: evaluation.CaseResult) -> str:
        """Return the word of a case, from its expectation and the baseline."""
        return case_word(result, self.differences(result.id))

    def explanation(self, result: evaluation.CaseResult, most: int | None = None) -> list[str]:
        """Return the reasons for the outcome of a case, and its differences from the baseline, or `most`.

        Of a stop that is drawn the reasons say when the values were taken.
        """
        return case_explanation(result, self.differences(result.id), most, self._instants(result))

    def _instants(self, result: evaluation.CaseResult) -> dict[str, str]:
        """Return when, and at which wheelset, the value of each criterion was taken; {} where not drawn.

        The value of a repeated case is not that of the stop that is drawn.
        """
        trace = self.traces.get(result.id)
        if trace is None or result.met or result.repeats is not None:
            return {}
        from uictest.report.page.stop.marks import taken_at

        taken = {verdict.id: taken_at(verdict, trace) for verdict in result.criteria}
        return {name: each.text for name, each in taken.items() if each is not None}

    @property
    def allows_something(self) -> bool:
        """Whether a case misses what it may, by name, under another controller than its own."""
        return any(result.allowed for result in self.results)

    @property
    def tally(self) -> str:
        """The counts of the run."""
        of_cases = [run_tally(self.results, self.baseline)] if self.results or not self.series else []
        differing = len(self.baseline.series) if self.baseline else 0
        of_series = [series_views.series_tally(self.series)] if self.series else []
        beyond = [f"{differing} series different from the baseline"] if differing else []
        return "; ".join([*of_cases, *of_series, *beyond])

    @property
    def uictest_version(self) -> str:
        """The version of the package that made the run; empty where it is not known."""
        return self.manifest.versions.get("uictest", "")

    @property
    def controllers(self) -> str:
        """The controllers under test with their versions; empty where none is known."""
        return controllers_text(self.all_results, self.uictest_version)

    @property
    def ranked(self) -> list[evaluation.CaseResult]:
        """The cases, those not as expected or different from the baseline first, then by margin."""
        return sorted(worst_first(self.results), key=self.passes)

    @property
    def all_results(self) -> list[evaluation.CaseResult]:
        """Every case, those of series too."""
        return [*self.results, *(each.case for result in self.series for each in result.cases)]
